"""Progress off terminals: a line now and then on standard error."""

from __future__ import annotations

import time

import pytest
from uplift_cli.output import progress as module
from uplift_cli.output.progress import build_progress, progress_bar, spinner, stage_spinner

from uplift.common.progress import Progress

EVENT = Progress("fit", 3, 8)


@pytest.fixture
def clock(monkeypatch):
    """Seconds that pass between two looks at the clock."""
    now = [0.0]

    def look():
        now[0] += 4
        return now[0]

    monkeypatch.setattr(module.time, "monotonic", look)
    monkeypatch.setattr(module, "INTERVAL", 10.0)


def test_a_line_appears_when_ten_seconds_have_passed(clock, capsys):
    with progress_bar("rows") as report:
        for _ in range(6):
            report(EVENT)
    assert capsys.readouterr().err.splitlines() == ["rows: 3 of 8"] * 2


def test_stages_name_themselves(clock, capsys):
    for context in (build_progress(quiet=False, verbose=False), stage_spinner()):
        with context as report:
            for _ in range(3):
                report(EVENT)
        assert capsys.readouterr().err == "fitting: 3 of 8\n"


def test_short_and_quiet_work_prints_nothing(capsys, clock):
    with progress_bar("rows") as report:
        report(EVENT)
    for context in (build_progress(quiet=True, verbose=False), progress_bar("rows", quiet=True)):
        with context as report:
            for _ in range(9):
                report(EVENT)
    assert capsys.readouterr().err == ""


def test_work_without_events_prints_the_time(monkeypatch, capsys):
    monkeypatch.setattr(module, "INTERVAL", 0.02)
    with spinner("fitting"):
        time.sleep(0.1)
    lines = capsys.readouterr().err.splitlines()
    assert lines
    assert all(line == "fitting: 0 s" for line in lines)


@pytest.mark.parametrize(("term", "has_lines"), [("xterm", False), ("dumb", True), ("unknown", True)])
def test_terminals_that_cannot_move_the_cursor_have_lines(clock, capsys, monkeypatch, term, has_lines):
    monkeypatch.setattr(module.sys.stderr, "isatty", lambda: True, raising=False)
    monkeypatch.setenv("TERM", term)
    with progress_bar("rows") as report:
        for _ in range(3):
            report(EVENT)
    assert (capsys.readouterr().err == "rows: 3 of 8\n") == has_lines
