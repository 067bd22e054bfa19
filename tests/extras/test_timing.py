"""Timings and their environment."""

import sys

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


def test_tasks_take_turns_and_are_compared_round_by_round():
    order: list[str] = []

    def task(name: str, seconds: float) -> timing.Run:
        order.append(name)
        load = 1 + order.count(name)  # a machine that becomes slower
        return timing.Run(1.0, seconds * load)

    found = timing.time_in_turn(
        {"one": lambda: task("one", 2.0), "two": lambda: task("two", 6.0)}, 3
    )
    assert order == ["one", "two"] * 3
    assert found["two"].cpu == timing.TimingStats(18.0, 12.0, 24.0, 3)
    assert found["two"].ratio_to(found["one"]) == timing.TimingStats(3.0, 3.0, 3.0, 3)


def test_a_process_has_its_time_and_memory_and_its_failure_is_an_error(tmp_path):
    block = "import os; os.write(2, b'wrong'); bytearray(1 << 26); {}"
    done = timing.time_command([sys.executable, "-c", block.format("")], 2)
    assert done.megabytes > 64
    assert done.wall.runs == 2
    assert done.cpu.min > 0
    with pytest.raises(RuntimeError, match="failed\nwrong"):
        timing.run_command([sys.executable, "-c", block.format("exit(3)")])


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
