"""Timings and their environment."""

import pytest

from tests.helpers import output_of
from uplift.extras import timing


def test_laps_are_long_enough(monkeypatch):
    calls: list[float] = []
    # a clock that only the calls move
    monkeypatch.setattr("time.process_time", lambda: sum(calls))
    found = timing.time_short_call(lambda: calls.append(0.001), 0.01, 5)
    assert (found.cpu.runs, len(calls)) == (5, 2 + 5 * 10)
    assert found.cpu.median == pytest.approx(0.001)


def test_commit_states_changed_code_but_not_the_measurements_of_the_package(
    tmp_path, monkeypatch
):
    def git(*words):
        output_of("git", *words, cwd=tmp_path)

    code = tmp_path / "uplift" / "lab" / "timing.py"
    chart = tmp_path / "uplift" / "lab" / "chart" / "measured.csv"
    chart.parent.mkdir(parents=True)
    for file in (code, chart):
        file.write_text("first")
    monkeypatch.setattr(timing, "SOURCES", tmp_path / "uplift")
    monkeypatch.setattr(timing, "__file__", str(code))
    git("init", "-q")
    git("config", "user.name", "test")
    git("config", "user.email", "test@example.org")
    assert timing.commit() == "unknown"  # not tracked
    git("add", ".")
    git("commit", "-q", "-m", "first")
    first = timing.commit()
    assert len(first) == 12
    chart.write_text("measured again")
    assert timing.commit() == first
    git("commit", "-q", "-a", "-m", "measurements only")
    assert timing.commit() == first
    code.write_text("changed")
    assert timing.commit() == first + " with changes"
