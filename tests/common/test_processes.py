"""A child process may crash or hang; the limit of BLAS threads when several threads compute at once."""

import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np  # noqa: F401  loads its BLAS
import pytest
import scipy.linalg  # noqa: F401
from threadpoolctl import OpenBLASController, threadpool_info, threadpool_limits

from uplift.common.errors import OptionError
from uplift.common.machine import single_threaded_blas
from uplift.common.processes import ChildError, call_in_child


def raise_error(text):
    raise OptionError(text, code="a-code")


def print_and_warn():
    print("to standard output")
    os.write(2, b"to standard error")
    return os.getpid()


def test_a_result_comes_from_another_process_which_is_silent(capfd):
    assert call_in_child(print_and_warn, seconds=60) != os.getpid()
    assert capfd.readouterr() == ("", "")


def test_an_error_of_the_function_is_raised():
    with pytest.raises(OptionError) as caught:
        call_in_child(raise_error, "wrong", seconds=60)
    assert (caught.value.code, caught.value.problem) == ("a-code", "wrong")


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("number", [signal.SIGABRT, signal.SIGSEGV, signal.SIGKILL])
def test_a_crash_is_an_error(number):
    with pytest.raises(ChildError, match=f"crashed: signal {number:d}"):
        call_in_child(signal.raise_signal, number, seconds=60)


def test_an_exit_is_an_error():
    with pytest.raises(ChildError, match="crashed: exit code 3"):
        call_in_child(os._exit, 3, seconds=60)


def test_a_hang_ends():
    with pytest.raises(ChildError, match=r"no answer within 0\.2 s"):
        call_in_child(time.sleep, 600, seconds=0.2)


def blas_threads():
    return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


@pytest.fixture
def two_threads():
    """Two threads before each test, also on machines with one core."""
    with threadpool_limits(2, user_api="blas"):
        OpenBLASController.clear_controlling_thread()
        yield


def test_the_limit_holds_until_the_last_of_overlapping_threads_is_done(two_threads):
    first, second = single_threaded_blas(), single_threaded_blas()
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
