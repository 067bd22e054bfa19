"""The limit of BLAS threads when several threads compute at once."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np  # noqa: F401  loads its BLAS
import pytest
import scipy.linalg  # noqa: F401
from threadpoolctl import OpenBLASController, threadpool_info, threadpool_limits

from uplift.common.machine import single_threaded_blas


def blas_threads():
    return {
        each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"
    }


@pytest.fixture
def two_threads():
    """Two threads before each test, also on machines with one core."""
    with threadpool_limits(2, user_api="blas"):
        OpenBLASController.clear_controlling_thread()
        yield


def test_the_limit_holds_until_the_last_of_overlapping_threads_is_done(two_threads):
    first = single_threaded_blas()
    second = single_threaded_blas()
    with ThreadPoolExecutor(1) as one, ThreadPoolExecutor(1) as other:
        one.submit(first.__enter__).result()
        other.submit(second.__enter__).result()
        assert blas_threads() == {1}
        one.submit(first.__exit__, None, None, None).result()
        assert blas_threads() == {1}
        other.submit(second.__exit__, None, None, None).result()
        assert blas_threads() == {2}


def test_the_limit_ends_with_an_exception(two_threads):
    with pytest.raises(KeyError), single_threaded_blas():
        raise KeyError
    assert blas_threads() == {2}
