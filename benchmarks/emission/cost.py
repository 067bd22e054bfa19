"""Time and size of emission tables: builds, files, lookups relative to reflectances."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks.emission.left_out import drop_discs
from uplift.common.arrays import Array
from uplift.lab.timing import spread
from uplift.lights.prior import relit_delta_e

REFERENCE = {"knots": 192, "rings": 64}
"""Table whose interpolation counts as exact."""
WAVELENGTHS = (np.linspace(400, 700, 16), None)
"""Wavelengths of lookups: few, and those of the tables."""


def sizes(
    options: tuple[dict[str, int], ...],
    runs: int,
    power: Array,
    reflectances: Array,
    folder: Path,
    reference: dict[str, int],
) -> Iterator[dict[str, Any]]:
    """Yield seconds, bytes and interpolation error by size.

    The error is the mean ΔE00 of surfaces (P, N) lit by lights of the chromaticities of lamps (L, N), without discs:
    mean over lamps, and largest.
    """
    fine = drop_discs(uplift.build_emission(**reference))
    radiometry = fine.data.cmfs
    expected = fine.spectrum(fine.rgb(power))
    for size in options:
        seconds = []
        for _ in range(runs + 1):  # the first one compiles
            begin = time.perf_counter()
            table = uplift.build_emission(**size)
            seconds.append(time.perf_counter() - begin)
        file = folder / "table.uplift"
        table.save(file, force=True)
        answers = drop_discs(table).spectrum(table.rgb(power))
        error = relit_delta_e(expected, answers, reflectances, radiometry).mean(axis=1)
        yield {
            **size,
            "bytes": file.stat().st_size,
            "build_s": spread(seconds[1:]),
            "mean": float(error.mean()),
            "worst": float(error.max()),
        }


def lookups(count: int, runs: int) -> Iterator[dict[str, Any]]:
    """Yield nanoseconds per colour of lights and of reflectances, in turn, and their ratio, by type.

    The order changes from run to run, and the ratio is that of the times of one run.
    """
    rgb = np.random.default_rng(1).random((count, 3))
    table, cube = uplift.load_emission(), uplift.load()
    for at, dtype in itertools.product(WAVELENGTHS, ("float64", "float32")):
        queries = {
            "light": partial(table.spectrum, rgb, at, dtype=dtype),
            "reflectance": partial(cube.reflectance, rgb, at, dtype=dtype),
        }
        for query in queries.values():
            query()
        found: dict[str, list[float]] = {what: [] for what in queries}
        for run in range(runs):
            for what in sorted(queries, reverse=bool(run % 2)):
                begin = time.perf_counter()
                queries[what]()
                found[what].append((time.perf_counter() - begin) * 1e9 / count)
        yield {
            "type": dtype,
            "wavelengths": len(table.wavelengths if at is None else at),
            "colours": count,
            **{what: spread(times) for what, times in found.items()},
            "ratio": spread([light / other for light, other in zip(*found.values(), strict=True)]),
        }
