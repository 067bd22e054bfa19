"""Timings of processes, of calls, and of tasks in turn, for questions of pages."""

import os
import subprocess
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from uplift.extras.timing import (
    RUNS,
    Run,
    Timing,
    TimingStats,
    git,
    run_call,
    timing_stats,
)

_TIMED_CHILD = """
import os, sys, time

silence = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
begin = time.perf_counter()
child = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ, file_actions=silence)
_, status, usage = os.wait4(child, 0)
wall = time.perf_counter() - begin
print(wall, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)  # kB on Linux
sys.exit(os.waitstatus_to_exitcode(status))
"""
"""A small process that times a command: a child of this one would count the memory that
this one has when it starts it.
"""


def run_command(
    command: Sequence[str | Path],
    *,
    variables: Mapping[str, str] | None = None,
    folder: Path | None = None,
) -> Run:
    """Time a process and those that it waits for. Raises `RuntimeError` if it fails."""
    done = subprocess.run(
        [sys.executable, "-S", "-c", _TIMED_CHILD, *command],
        env=os.environ | (variables or {}),
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode:
        words = " ".join(map(str, command))
        raise RuntimeError(f"{words} failed\n{done.stderr}")
    return Run(*map(float, done.stdout.split()))


def time_in_turn(
    tasks: Mapping[str, Callable[[], Run]], runs: int = RUNS
) -> dict[str, Timing]:
    """Time tasks, `run_call` or `run_command` of something, in turn: round by round,
    so that all of them share the load of the machine.
    """
    found: dict[str, list[Run]] = {name: [] for name in tasks}
    for _ in range(runs):
        for name, task in tasks.items():
            found[name].append(task())
    return {name: Timing(tuple(of_task)) for name, of_task in found.items()}


def time_call(function: Callable[[], object], runs: int = RUNS) -> Timing:
    """Time calls. The caller has called the function, which warms it up, and has
    checked the answer.
    """
    return Timing(tuple(run_call(function) for _ in range(runs)))


def time_command(
    command: Sequence[str | Path],
    runs: int = RUNS,
    *,
    variables: Mapping[str, str] | None = None,
) -> Timing:
    """Time a process several times."""
    timed = (run_command(command, variables=variables) for _ in range(runs))
    return Timing(tuple(timed))


def ratio(timing: Timing, other: Timing) -> TimingStats:
    """CPU seconds relative to those of another, run by run: load of the machine
    that lasts longer than a run cancels if they were timed in turn.
    """
    pairs = zip(timing.runs, other.runs, strict=True)
    return timing_stats([run.cpu / reference.cpu for run, reference in pairs])


def commit_time(text: str) -> float:
    """Return the time of a commit, as of `commit`, in seconds; 0 if it is unknown."""
    return float(git("log", "-1", "--format=%ct", text.partition(" ")[0], "--") or 0)
