"""Times of processes as a user starts them: cold, warm and without the compilation cache."""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from benchmarks.record import ROOT
from benchmarks.timing import process
from uplift.lab.timing import Spread, spread

UPLIFT = str(Path(sys.executable).parent / "uplift")
MACBETH = str(ROOT / "atlases" / "macbeth.txt")


@dataclass(frozen=True)
class ProcessTiming:
    """Wall seconds and peak memory in MB of a command."""

    what: str
    wall: Spread
    megabytes: float


def time_processes(runs: int) -> list[ProcessTiming]:
    with tempfile.TemporaryDirectory() as folder:
        return [*_builds(folder, runs), *_starts(runs)]


def _builds(folder: str, runs: int) -> list[ProcessTiming]:
    def build(dim: int) -> list[str]:
        return [
            UPLIFT,
            "build",
            "--atlas",
            MACBETH,
            "--dim",
            str(dim),
            "-o",
            f"{folder}/{dim}.uplift",
            "--force",
            "-q",
        ]

    timings = [
        ProcessTiming(
            "uplift build --dim 32, compilation cache disabled",
            *process(build(32), runs, {"JAX_ENABLE_COMPILATION_CACHE": "false"}),
        )
    ]
    for dim in (16, 32, 64, 128):
        cold = [
            process(build(dim), 1, {"JAX_COMPILATION_CACHE_DIR": f"{folder}/cache-{dim}-{run}"})
            for run in range(runs if dim < 128 else 1)
        ]
        warm_cache = {"JAX_COMPILATION_CACHE_DIR": f"{folder}/cache-{dim}-0"}
        timings.append(_joined(f"uplift build --dim {dim}, first run", cold))
        timings.append(
            ProcessTiming(
                f"uplift build --dim {dim}, compiled before",
                *process(build(dim), runs if dim < 128 else 1, warm_cache),
            )
        )
    return timings


def _joined(what: str, parts: list[tuple[Spread, float]]) -> ProcessTiming:
    return ProcessTiming(what, spread([wall.median for wall, _ in parts]), max(peak for _, peak in parts))


def _starts(runs: int) -> list[ProcessTiming]:
    commands = {
        "python -c 'import numpy'": [sys.executable, "-c", "import numpy"],
        "uplift query '#cc3319' --format json": [UPLIFT, "query", "#cc3319", "--format", "json"],
        "uplift --help": [UPLIFT, "--help"],
    }
    return [ProcessTiming(what, *process(command, 2 * runs)) for what, command in commands.items()]
