"""Throughput of lookups with numpy by mode and in bulk; results are checked before timing."""

from __future__ import annotations

import time
import warnings
from functools import partial
from typing import Any

import jax
import numpy as np

import uplift
from benchmarks.record import ROOT
from uplift.common.arrays import Array
from uplift.lab.timing import Spread, time_calls
from uplift.lookup import Cube, bulk

WAVELENGTHS = np.linspace(400, 700, 16)
BULK = 1_000_000
CHECKED = 5000
COLOURS = {"coefficients": 1_000_000, "spectra": 1_000_000, "moments": 200_000, "refined": 50_000}
"""Queries by what is looked up: fewer where lookups are slow."""
MAX_ERRORS = {"coefficients": 1e-6, "spectra": 1e-5, "moments": 2e-2, "refined": 1e-6}
"""Largest permitted errors, for float32 too."""


Timing = dict[str, Any]


def macbeth() -> Cube:
    """Build a cube of 32³ nodes with nine coefficients."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(ROOT / "atlases" / "macbeth.txt", dim=32)


def time_lookups(cube: Cube, runs: int) -> list[Timing]:
    """Time every mode with numpy in both types, on one thread and on two, and for colours near those of the atlas."""
    rng = np.random.default_rng(1)
    random = [
        _lookup(cube, what, rng.random((count, 3)), dtype, threads, runs)
        for what, count in COLOURS.items()
        for dtype in ("float64", "float32")
        for threads in (1, 2)
    ]
    near = [
        _lookup(cube, what, near_entries(cube, count, rng), "float64", 1, runs)
        | {"what": f"{what}, colours near entries"}
        for what, count in COLOURS.items()
    ]
    return random + near


def near_entries(cube: Cube, count: int, rng: np.random.Generator) -> Array:
    """Draw linear RGB (n, 3) around the colours of the atlas entries, most of them in entry boxes."""
    rgb = cube.data.atlas.rgb
    near = rgb[rng.integers(len(rgb), size=count)] + rng.normal(0, 1e-3, (count, 3))
    return np.asarray(np.clip(near, 0, 1))


def _lookup(cube: Cube, what: str, rgb: Array, dtype: str, threads: int, runs: int) -> Timing:
    options: dict[str, Any] = {"dtype": dtype, "threads": threads}
    if what == "coefficients":
        query = partial(cube.coefficients, rgb, **options)
        error = float(np.abs(query() - cube.coefficients(rgb)).max())
    else:
        query = partial(cube.reflectance, rgb, WAVELENGTHS, what, **options)
        back = cube.data.sensor.rgb(cube.reflectance(rgb[:CHECKED], None, what, **options))
        error = float(np.abs(back - rgb[:CHECKED]).max())
    _check(what, error, MAX_ERRORS[what])
    wall, cpu = time_calls(query, runs)
    size, width = np.dtype(dtype).itemsize, _width(cube, what)
    row = size * width if what == "spectra" else 8 * cube.data.model.count
    bytes_each = 24 + 8 * row + size * width
    return _timing(what, dtype, threads, len(rgb), bytes_each, wall, cpu, error)


def time_bulk(cube: Cube, runs: int) -> list[Timing]:
    """Time JAX: spectra and coefficients of random colours, and spectra of colours near those of the atlas."""
    rng = np.random.default_rng(1)
    random = rng.random((BULK, 3))
    painted = near_entries(cube, BULK, rng)
    return [
        _bulk(cube, "spectra", "spectra", random, 1, runs),
        _bulk(cube, "spectra", "spectra", random, 2, runs),
        _bulk(cube, "spectra, float32 queries", "spectra", random.astype(np.float32), 2, runs),
        _bulk(cube, "spectra, colours near entries", "spectra", painted, 2, runs),
        _bulk(cube, "coefficients", "coefficients", random, 2, runs),
    ]


def _bulk(cube: Cube, what: str, kind: str, rgb: np.ndarray[Any, Any], threads: int, runs: int) -> Timing:
    jax.clear_caches()
    begin = time.perf_counter()
    make = partial(bulk.spectra, cube, WAVELENGTHS) if kind == "spectra" else partial(bulk.coefficients, cube)
    sample = make(threads=threads)
    prepared = time.perf_counter()
    result = sample(rgb)
    answered = time.perf_counter()
    expected = cube.reflectance(rgb, WAVELENGTHS) if kind == "spectra" else cube.coefficients(rgb)
    error = float(np.abs(result - expected).max())
    _check(what, error, 1e-6)
    wall, cpu = time_calls(lambda: sample(rgb), runs)
    bytes_each = rgb.itemsize * 3 + 9 * 4 * _width(cube, kind)
    return _timing(what, rgb.dtype.name, threads, len(rgb), bytes_each, wall, cpu, error) | {
        "prepare_s": prepared - begin,
        "compile_s": max(answered - prepared - wall.median, 0),
    }


def _timing(
    what: str,
    dtype: str,
    threads: int,
    colours: int,
    bytes_each: int,
    wall: Spread,
    cpu: Spread,
    error: float,
) -> Timing:
    """Bytes of a colour are those of the query, of the rows read and of the result."""
    return {
        "what": what,
        "dtype": dtype,
        "threads": threads,
        "colours": colours,
        "bytes": bytes_each,
        "wall_s": wall,
        "million_per_s": colours / wall.median / 1e6,
        "cpu_us": cpu.median / colours * 1e6,
        "error": error,
    }


def _width(cube: Cube, what: str) -> int:
    return cube.data.model.count if what == "coefficients" else len(WAVELENGTHS)


def _check(what: str, error: float, limit: float) -> None:
    if not error <= limit:
        raise RuntimeError(f"{what}: error {error} exceeds {limit}: nothing to time")
