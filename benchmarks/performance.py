"""Times of builds and processes, for docs/speed.md."""

import shlex
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import MACBETH, UPLIFT, Row
from benchmarks.materials import MIXTURE, SENSOR, materials
from benchmarks.timing import time_call, time_command
from uplift.atlas.atlas import Atlas, Entry
from uplift.common.arrays import Array

RUNS = 3
"""Runs of processes and builds, which take long and vary little."""
FIRST_RUN = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
"""Variables with which a command finds no program that an earlier run compiled."""
DIMS = (16, 32, 64, 128)
LINES = (
    "python -c 'import numpy'",
    "uplift query '#cc3319' --format json",
)
MIXTURES = (24, 396, 10_000)
"""Entries of atlases of mixtures of three shipped spectra."""
MIXTURE_DIM = 32


def processes() -> Iterator[Row]:
    """Yield the wall seconds and the peak memory in MB of commands as users start
    them.
    """
    with tempfile.TemporaryDirectory() as folder:
        build = [UPLIFT, "build", "-q", "--force", "--atlas", str(MACBETH)]
        build += ["-o", f"{folder}/cube.uplift", "--dim"]
        jobs = [(f"uplift build --dim {dim}", [*build, str(dim)]) for dim in DIMS]
        for line in LINES:
            program, *words = shlex.split(line)
            jobs.append((line, [str(Path(UPLIFT).with_name(program)), *words]))
        for line, command in jobs:
            timing = time_command(command, RUNS, variables=FIRST_RUN)
            yield {"what": line, "wall": timing.wall, "megabytes": timing.megabytes}


def builds() -> Iterator[Row]:
    """Yield the times of builds in this process, which has compiled."""
    for dim in DIMS:
        build = partial(uplift.build, MACBETH, dim=dim)
        if unfitted := build().data.points.counts()["unfitted"]:
            raise RuntimeError(f"{unfitted} nodes are unfitted: nothing to time")
        yield {"dim": dim, "wall_s": time_call(build, RUNS).wall}


def mixtures(count: int) -> Array:
    """Return reflectances (n, N) of mixtures of three shipped spectra."""
    random = np.random.default_rng(1)
    known = materials(MIXTURE).measured
    parts = random.dirichlet(np.full(3, 0.6), count)
    chosen = known[random.integers(len(known), size=(count, 3))]
    return np.einsum("np,npw->nw", parts, chosen)


def atlases() -> Iterator[Row]:
    """Yield the CPU seconds of builds by the number of entries."""
    uplift.build(MACBETH, dim=MIXTURE_DIM)  # compile before timing
    for count in MIXTURES:
        entries = tuple(
            Entry(str(number), SENSOR.wavelengths, spectrum)
            for number, spectrum in enumerate(mixtures(count))
        )
        timing = time_call(partial(uplift.build, Atlas(entries), dim=MIXTURE_DIM), 1)
        yield {"entries": count, "cpu_s": timing.cpu.median}


QUESTIONS = {"processes": processes, "builds": builds, "atlases": atlases}
