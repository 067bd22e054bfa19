"""Timings and their environment."""

import subprocess

import pytest

from uplift.lab import timing


def test_laps_are_long_enough_and_runs_are_limited(monkeypatch):
    calls: list[float] = []
    # a clock that only the calls move
    monkeypatch.setattr("time.process_time", lambda: sum(calls))
    found = timing.time_laps(lambda: calls.append(0.001), 0.01, 5)
    assert (found.runs, len(calls)) == (5, 2 + 5 * 10)
    assert found.median == pytest.approx(0.001)
    assert timing.time_laps(lambda: calls.append(1.0), 1e-4, 7).runs == timing.MIN_RUNS


def test_commit_states_changed_code_but_not_the_measurements_of_the_package(
    tmp_path, monkeypatch
):
    def git(*words):
        names = ("-c", "user.name=test", "-c", "user.email=test@example.org")
        subprocess.run(
            ["git", *names, *words], cwd=tmp_path, check=True, capture_output=True
        )

    code, chart = (
        tmp_path / "uplift" / "lab" / name
        for name in ("timing.py", "chart/measured.csv")
    )
    chart.parent.mkdir(parents=True)
    for file in (code, chart):
        file.write_text("first")
    monkeypatch.setattr(timing, "SOURCES", tmp_path / "uplift")
    monkeypatch.setattr(timing, "__file__", str(code))
    assert (
        timing.commit() == "unknown"
    )  # without git, and in a repository that does not track the code
    git("init", "-q")
    assert timing.commit() == "unknown"
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
