"""Times of builds, processes and `uplift.bulk`, for docs/speed.md."""

import shlex
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import MACBETH, UPLIFT, Row
from benchmarks.materials import MIXTURE, SENSOR, materials
from uplift.atlas import Atlas, Entry
from uplift.common.arrays import Array
from uplift.lab.timing import check_answer, time_call, time_command
from uplift.lookup import bulk

RUNS = 5
FEW_RUNS = 3
"""Runs of processes and large builds, which take long and vary little."""
FIRST_RUN = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
"""Variables with which a command finds no program that an earlier run compiled."""
DIMS = (16, 32, 64, 128)
LINES = (
    "python -c 'import numpy'",
    "uplift query '#cc3319' --format json",
    "uplift --help",
)
MIXTURES = (24, 396, 10_000)
"""Entries of atlases of mixtures of three shipped spectra."""
MIXTURE_DIM = 32
WAVELENGTHS = np.linspace(400, 700, 16)
COLOURS = 1_000_000
"""Colours of `uplift.bulk`."""
MAX_ERROR = 1e-6
"""Its largest permitted difference of reflectance."""


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
            timing = time_command(command, FEW_RUNS, variables=FIRST_RUN)
            yield {"what": line, "wall": timing.wall, "megabytes": timing.megabytes}


def builds() -> Iterator[Row]:
    """Yield the times of builds in this process, which has compiled."""
    for dim in DIMS:
        build = partial(uplift.build, MACBETH, dim=dim)
        if unfitted := build().data.points.counts()["unfitted"]:
            raise RuntimeError(f"{unfitted} nodes are unfitted: nothing to time")
        timing = time_call(build, FEW_RUNS)
        node = timing.cpu.scaled(1e6 / dim**3)
        yield {"dim": dim, "nodes": dim**3, "wall_s": timing.wall, "cpu_us": node}


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


def bulk_lookups() -> Row:
    """Return the CPU time of spectra of random colours by JAX on one thread."""
    cube = uplift.build(MACBETH, dim=32)
    rgb = np.random.default_rng(1).random((COLOURS, 3))
    sample = bulk.spectra(cube, WAVELENGTHS, threads=1)
    error = check_answer(sample(rgb), cube.reflectance(rgb, WAVELENGTHS), MAX_ERROR)
    cpu = time_call(partial(sample, rgb), RUNS).cpu
    return {"ns": cpu.scaled(1e9 / COLOURS), "error": error}


QUESTIONS = {
    "processes": processes,
    "builds": builds,
    "atlases": atlases,
    "bulk": bulk_lookups,
}
