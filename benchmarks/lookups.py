"""Colours per second of lookups, in numpy by mode and in bulk; the answer is checked before it is timed."""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import numpy as np

import uplift
from benchmarks.timing import ROOT
from uplift.lab.timing import Spread, timed
from uplift.lookup import Cube, bulk

WAVELENGTHS = np.linspace(400, 700, 16)
BULK = 1_000_000
CHECKED = 5000
COLOURS = {"coefficients": 1_000_000, "spectra": 1_000_000, "moments": 200_000, "refined": 50_000}
"""Blocks follow one another, so that more of the slower only take longer."""
WORST = {"coefficients": 1e-6, "spectra": 1e-5, "moments": 2e-2, "refined": 1e-6}
"""What is wrong, and not worth timing; for float32 too."""


@dataclass(frozen=True)
class LookupTiming:
    """Seconds for ``colours`` at once.

    ``bytes`` per colour are those of the question, of the rows read and of the answer. ``worst`` is max |linear RGB|
    of the round trip; ``apart``, where no spectrum comes back or as many, the largest difference from numpy in
    float64. ``prepare`` is what making the sampler takes, ``compile`` what a first run takes longer than the next.
    """

    what: str
    dtype: str
    threads: int
    colours: int
    bytes: int
    wall: Spread
    cpu: Spread
    worst: float | None = None
    apart: float | None = None
    prepare: float | None = None
    compile: float | None = None


def macbeth() -> Cube:
    """32³ points, 9 coefficients."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(ROOT / "atlases" / "macbeth.txt", dim=32)


def time_lookups(cube: Cube, runs: int) -> list[LookupTiming]:
    """numpy: every mode in both types, on one thread and on two."""
    return [
        _lookup(cube, what, dtype, threads, runs)
        for what in COLOURS
        for dtype in ("float64", "float32")
        for threads in (1, 2)
    ]


def _lookup(cube: Cube, what: str, dtype: str, threads: int, runs: int) -> LookupTiming:
    rgb = np.random.default_rng(1).random((COLOURS[what], 3))
    options: dict[str, Any] = {"dtype": dtype, "threads": threads}
    if what == "coefficients":
        ask = partial(cube.coefficients, rgb, **options)
        worst, apart = None, float(np.abs(ask() - cube.coefficients(rgb)).max())
    else:
        ask = partial(cube.reflectance, rgb, WAVELENGTHS, what, **options)
        back = cube.data.sensor.rgb(cube.reflectance(rgb[:CHECKED], None, what, **options))
        worst, apart = float(np.abs(back - rgb[:CHECKED]).max()), None
    _refuse(what, worst if apart is None else apart, WORST[what])
    wall, cpu = timed(ask, runs)
    size, width = np.dtype(dtype).itemsize, _width(cube, what)
    row = size * width if what == "spectra" else 8 * cube.data.model.count
    return LookupTiming(what, dtype, threads, len(rgb), 24 + 8 * row + size * width, wall, cpu, worst, apart)


def time_bulk(cube: Cube, runs: int) -> list[LookupTiming]:
    """JAX: spectra and coefficients of random colours, and spectra of colours like those of the atlas."""
    rng = np.random.default_rng(1)
    random, data = rng.random((BULK, 3)), cube.data
    near = data.atlas.rgb[rng.integers(len(data.atlas.rgb), size=BULK)] + rng.normal(0, 1e-3, (BULK, 3))
    painted = np.clip(near, 0, 1)
    return [
        _bulk(cube, "spectra", "spectra", random, 1, runs),
        _bulk(cube, "spectra", "spectra", random, 2, runs),
        _bulk(cube, "spectra, asked in float32", "spectra", random.astype(np.float32), 2, runs),
        _bulk(cube, "spectra, colours near entries", "spectra", painted, 2, runs),
        _bulk(cube, "coefficients", "coefficients", random, 2, runs),
    ]


def _bulk(
    cube: Cube, what: str, kind: str, rgb: np.ndarray[Any, Any], threads: int, runs: int
) -> LookupTiming:
    jax.clear_caches()
    begin = time.perf_counter()
    make = partial(bulk.spectra, cube, WAVELENGTHS) if kind == "spectra" else partial(bulk.coefficients, cube)
    sample = make(threads=threads)
    prepared = time.perf_counter()
    found = sample(rgb)
    answered = time.perf_counter()
    expected = cube.reflectance(rgb, WAVELENGTHS) if kind == "spectra" else cube.coefficients(rgb)
    apart = float(np.abs(found - expected).max())
    _refuse(what, apart, 1e-6)
    wall, cpu = timed(lambda: sample(rgb), runs)
    return LookupTiming(
        what,
        rgb.dtype.name,
        threads,
        len(rgb),
        rgb.itemsize * 3 + 9 * 4 * _width(cube, kind),
        wall,
        cpu,
        apart=apart,
        prepare=prepared - begin,
        compile=max(answered - prepared - wall.median, 0),
    )


def _width(cube: Cube, what: str) -> int:
    return cube.data.model.count if what == "coefficients" else len(WAVELENGTHS)


def _refuse(what: str, worst: float | None, limit: float) -> None:
    if worst is None or not worst <= limit:
        raise RuntimeError(f"{what}: a wrong answer ({worst}) is not worth timing")
