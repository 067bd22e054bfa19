"""The limit of BLAS threads when several threads compute at once; forks."""

import os
from concurrent.futures import ThreadPoolExecutor

import numpy as np  # noqa: F401  loads its BLAS
import pytest
import scipy.linalg  # noqa: F401
from threadpoolctl import OpenBLASController, threadpool_info, threadpool_limits

from tests.helpers import run_python
from uplift.common.machine import single_threaded_blas

FORKED = """
import os, warnings
import uplift
from uplift import bulk
warnings.simplefilter("ignore")  # Python and JAX warn of forks
cube = uplift.load()
sample = bulk.spectra(cube, [500])
sample([0.5, 0.5, 0.5])
child = os.fork()
if child:
    os.waitpid(child, 0)
    print(sample([0.5, 0.5, 0.5]).shape)
else:
    try:
        cube.reflectance([0.5, 0.5, 0.5])
        uses = (
            lambda: uplift.build(dim=2),
            lambda: uplift.build("macbeth", dim=2),
            lambda: bulk.coefficients(cube),
            lambda: bulk.traceable(cube),
            lambda: sample([0.5, 0.5, 0.5]),
        )
        for use in uses:
            try:
                use()
            except uplift.UpliftError as error:
                print(error.code, flush=True)
    finally:
        os._exit(0)  # where JAX may crash
"""


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


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no forks on Windows")
def test_jax_is_refused_after_a_fork_in_place_of_a_hang():
    *codes, shape = run_python(FORKED, timeout=100).splitlines()
    assert codes == 5 * ["forked-process"]
    assert shape == "(1,)"
