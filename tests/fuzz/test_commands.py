"""Short fuzz campaigns of the command line, and the detection of what it must not do."""

from __future__ import annotations

import pytest

from tests.fuzz import campaign, places, same_file
from tests.fuzz.campaign import fuzz
from tests.fuzz.command_line import Outcome, check_csv, check_outcome
from tests.fuzz.run import COMMANDS
from uplift.common.errors import UpliftError

INPUTS = {
    "streams and places": 30,
    "hostile text": 200,
    "outputs that are inputs": 100,
    "unforeseen exceptions": 100,
}


@pytest.fixture(autouse=True)
def unlimited(monkeypatch):
    """Disable the limit of memory, which would remain in this process."""
    monkeypatch.setattr(campaign, "_limit_memory", lambda: None)


@pytest.mark.parametrize("name", COMMANDS)
def test_runs_succeed_or_fail_on_one_line(tmp_path, name):
    tally = fuzz(COMMANDS[name], 1, range(INPUTS[name]), tmp_path, tmp_path)
    assert not tally.failures
    assert min(tally.accepted, tally.rejected) > 0
    assert tally.accepted + tally.rejected == INPUTS[name]


def test_texts_that_are_not_escaped_are_found(tmp_path, monkeypatch):
    monkeypatch.setattr("uplift_cli.output.console.printable", str)
    monkeypatch.setattr("uplift_cli.output.tables.printable", str)
    monkeypatch.setattr("uplift.common.errors.printable", str)
    tally = fuzz(COMMANDS["hostile text"], 1, range(40), tmp_path, tmp_path)
    assert any("a control character" in failure for failure in tally.failures)


def test_inputs_that_are_replaced_are_found(tmp_path, monkeypatch):
    monkeypatch.setattr(same_file, "COMMANDS", same_file.QUICK)
    monkeypatch.setattr("uplift.common.files._check_existing", lambda *_: None)
    tally = fuzz(COMMANDS["outputs that are inputs"], 1, range(40), tmp_path, tmp_path)
    assert any("an input was replaced" in failure for failure in tally.failures)


def test_lost_output_is_found(tmp_path, monkeypatch):
    monkeypatch.setattr(places, "STREAMS", ("full",))
    monkeypatch.setattr(places, "COMMANDS", (("--help",),))
    monkeypatch.setattr("uplift_cli.main.finish_stdout", lambda: None)
    tally = fuzz(COMMANDS["streams and places"], 1, range(3), tmp_path, tmp_path)
    assert tally.failures


@pytest.mark.parametrize(
    "outcome",
    [
        Outcome(0, "a\x1b[2Jb\n", ""),
        Outcome(0, "", "warning: a\rb\n"),
        Outcome(2, "", "error: a\nb\n"),
        Outcome(2, "", ""),
        Outcome(70, "", "error: internal error\n"),
        Outcome(0, "", "one\nother\n"),
    ],
)
def test_bad_outcomes_are_failures(outcome):
    with pytest.raises(ValueError, match=r"control|line|exit code") as caught:
        check_outcome(outcome)
    assert not isinstance(caught.value, UpliftError)


def test_good_outcomes_are_accepted_or_rejected():
    check_outcome(Outcome(0, "a\nb\n", "warning: c\nwarning: d\n"))
    with pytest.raises(UpliftError):
        check_outcome(Outcome(2, "", '{"error": {}}\n'))


def test_formulas_are_failures():
    check_csv("'=1,-1.5,1e-9\n")
    with pytest.raises(ValueError, match="formula"):
        check_csv("a,=1\n")
