"""A child process may crash or hang."""

import contextlib
import multiprocessing
import os
import signal
import sys
import time

import pytest

from uplift.common.errors import OptionError
from uplift.extras.processes import ChildError, TiedProcesses, call_in_child


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


@pytest.fixture
def foreign():
    """A process that another part of the program starts."""
    spawn = multiprocessing.get_context("spawn")
    process = spawn.Process(target=time.sleep, args=(600,))
    yield process
    process.kill()
    process.join()


def test_only_own_processes_end_with_an_exception_and_the_environment_stays(foreign):
    before = dict(os.environ)
    with contextlib.suppress(KeyError), TiedProcesses(2) as pool:
        answers = [pool.submit(time.sleep, 600) for _ in range(2)]
        foreign.start()
        assert dict(os.environ) == before
        assert len(pool.children) == 2
        raise KeyError
    assert all(answer.done() for answer in answers)
    assert not any(child.is_alive() for child in pool.children)
    assert foreign.is_alive()


def test_more_processes_than_windows_can_wait_for_are_fewer(monkeypatch):
    monkeypatch.setattr(sys, "platform", "win32")
    with TiedProcesses(200) as pool:
        assert pool.children == []
