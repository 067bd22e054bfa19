"""A short run of what `make nightly` does at length, and that it would tell a failure."""

from __future__ import annotations

import signal

import numpy as np
import pytest

from tests.fuzz import attack as attacks
from tests.fuzz.attack import attack
from tests.fuzz.run import TARGETS
from tests.fuzz.target import Target
from uplift.common.errors import UpliftError

INPUTS = 150


@pytest.fixture
def unlimited(monkeypatch):
    """The limit of memory would stay with this process."""
    monkeypatch.setattr(attacks, "_limit_memory", lambda: None)


def attacked(use, folder, inputs=3):
    target = Target("example", lambda random, path: path.write_bytes(random.bytes(4)), use)
    return attack(target, 0, range(inputs), folder, folder)


@pytest.mark.usefixtures("unlimited")
@pytest.mark.parametrize("name", TARGETS)
def test_whatever_is_read_is_taken_or_refused(tmp_path, name):
    tally = attack(TARGETS[name], 1, range(INPUTS), tmp_path, tmp_path)
    assert not tally.failures
    assert tally.taken + tally.refused == tally.inputs == INPUTS
    assert min(tally.taken, tally.refused) > INPUTS / 50  # neither too wild nor too tame


@pytest.mark.usefixtures("unlimited")
def test_inputs_can_be_made_again(tmp_path):
    target = TARGETS["cube, right digest"]
    for path in (tmp_path / "a", tmp_path / "b"):
        target.write(np.random.default_rng([1, 7]), path)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.usefixtures("unlimited")
def test_another_error_is_a_failure_and_its_input_is_kept(tmp_path):
    def use(path):
        raise KeyError("oh")

    assert list(attacked(use, tmp_path).failures.values()) == [3]
    assert (tmp_path / "example-0-0").read_bytes() == np.random.default_rng([0, 0]).bytes(4)


@pytest.mark.usefixtures("unlimited")
def test_a_warning_is_a_failure(tmp_path):
    (failure,) = attacked(lambda path: np.float64(1) / np.float64(0), tmp_path).failures
    assert failure.startswith("RuntimeWarning")


@pytest.mark.usefixtures("unlimited")
def test_a_hang_is_a_failure_even_where_every_exception_is_caught(tmp_path, monkeypatch):
    monkeypatch.setattr(attacks, "SECONDS", 0.05)

    def use(path):
        try:
            while True:
                pass
        except Exception as error:
            raise UpliftError("slow") from error

    (failure,) = attacked(use, tmp_path, 1).failures
    assert failure.startswith("HangError")
    assert signal.getitimer(signal.ITIMER_PROF) == (0, 0)


@pytest.mark.usefixtures("unlimited")
def test_a_message_of_several_lines_is_a_failure(tmp_path):
    def use(path):
        raise UpliftError("one\nother")

    assert attacked(use, tmp_path, 1).failures == {"a message of several lines": 1}
