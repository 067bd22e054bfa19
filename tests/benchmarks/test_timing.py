"""Timings of processes, and of tasks in turn."""

import sys

import pytest

from benchmarks.timing import ratio, run_command, time_command, time_in_turn
from uplift.extras.timing import Run, TimingStats


def test_tasks_take_turns_and_are_compared_round_by_round():
    order: list[str] = []

    def task(name: str, seconds: float) -> Run:
        order.append(name)
        load = 1 + order.count(name)  # a machine that becomes slower
        return Run(1.0, seconds * load)

    found = time_in_turn(
        {"one": lambda: task("one", 2.0), "two": lambda: task("two", 6.0)}, 3
    )
    assert order == ["one", "two"] * 3
    assert found["two"].cpu == TimingStats(18.0, 12.0, 24.0, 3)
    assert ratio(found["two"], found["one"]) == TimingStats(3.0, 3.0, 3.0, 3)


def test_a_process_has_its_time_and_memory_and_its_failure_is_an_error(tmp_path):
    block = "import os; os.write(2, b'wrong'); bytearray(1 << 26); {}"
    done = time_command([sys.executable, "-c", block.format("")], 2)
    assert done.megabytes > 64
    assert done.wall.runs == 2
    assert done.cpu.min > 0
    with pytest.raises(RuntimeError, match="failed\nwrong"):
        run_command([sys.executable, "-c", block.format("exit(3)")])
