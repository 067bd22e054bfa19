"""Short fuzz campaigns of all readers, and the detection of failures."""

from __future__ import annotations

import signal

import numpy as np
import pytest

from tests.fuzz import campaign
from tests.fuzz.campaign import fuzz
from tests.fuzz.run import TARGETS
from tests.fuzz.target import Target
from uplift.common.errors import UpliftError

INPUTS = 150


@pytest.fixture
def unlimited(monkeypatch):
    """Disable the limit of memory, which would remain in this process."""
    monkeypatch.setattr(campaign, "_limit_memory", lambda: None)


def fuzz_with(use, folder, inputs=3):
    target = Target("example", lambda random, path: path.write_bytes(random.bytes(4)), use)
    return fuzz(target, 0, range(inputs), folder, folder)


@pytest.mark.usefixtures("unlimited")
@pytest.mark.parametrize("name", TARGETS)
def test_inputs_are_accepted_or_rejected(tmp_path, name):
    tally = fuzz(TARGETS[name], 1, range(INPUTS), tmp_path, tmp_path)
    assert not tally.failures
    assert tally.accepted + tally.rejected == tally.inputs == INPUTS
    assert min(tally.accepted, tally.rejected) > INPUTS / 50  # mutations are neither too strong nor too weak


@pytest.mark.usefixtures("unlimited")
def test_inputs_are_reproducible(tmp_path):
    target = TARGETS["cube, valid digest"]
    for path in (tmp_path / "a", tmp_path / "b"):
        target.generate(np.random.default_rng([1, 7]), path)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.usefixtures("unlimited")
def test_other_exceptions_are_failures_and_their_inputs_are_kept(tmp_path):
    def use(path):
        raise KeyError("oh")

    assert list(fuzz_with(use, tmp_path).failures.values()) == [3]
    assert (tmp_path / "example-0-0").read_bytes() == np.random.default_rng([0, 0]).bytes(4)


@pytest.mark.usefixtures("unlimited")
def test_warnings_are_failures(tmp_path):
    (failure,) = fuzz_with(lambda path: np.float64(1) / np.float64(0), tmp_path).failures
    assert failure.startswith("RuntimeWarning")


@pytest.mark.usefixtures("unlimited")
def test_hangs_are_failures_even_if_exceptions_are_caught(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, "SECONDS", 0.05)

    def use(path):
        try:
            while True:
                pass
        except Exception as error:
            raise UpliftError("slow") from error

    (failure,) = fuzz_with(use, tmp_path, 1).failures
    assert failure.startswith("HangError")
    assert signal.getitimer(signal.ITIMER_PROF) == (0, 0)


class UnsafeError(UpliftError):
    """An error whose text is not made safe."""

    def __str__(self) -> str:
        return self.problem


@pytest.mark.usefixtures("unlimited")
@pytest.mark.parametrize("text", ["one\nother", "\x1b]0;title\x07", "\u202e"])
def test_messages_of_several_lines_or_with_control_characters_are_failures(tmp_path, text):
    def use(path):
        raise UnsafeError(text)

    (failure,) = fuzz_with(use, tmp_path, 1).failures
    assert "control characters" in failure
