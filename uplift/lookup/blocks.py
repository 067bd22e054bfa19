"""Arguments of queries as plain arrays, and functions of them applied in blocks of
bounded memory.
"""

import contextlib
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.sensor import (
    SLACK,
    Sensor,
    as_rgb,
    in_unit_cube,
    raise_out_of_gamut,
)
from uplift.common.arrays import Array, as_array, as_nm
from uplift.common.errors import ColourError, OptionError
from uplift.cube.data import CubeData

BLOCK = 4096
"""Rows per block: their temporary arrays fit into a core's cache."""

Function = Callable[[Array], NDArray[Any]]
"""From rows (k, K) to rows (k, N)."""


def blockwise(
    function: Function,
    rows: Array,
    width: int,
    dtype: DTypeLike = np.float64,
    threads: int = 1,
    block: int = BLOCK,
) -> NDArray[Any]:
    """Apply a function, from rows (k, K) to rows (k, width), to rows (…, K) block by
    block: (…, width).

    numpy releases the GIL, so threads run in parallel. The result does not depend on
    their number.
    """
    flat = rows.reshape(-1, rows.shape[-1])
    result = np.empty((len(flat), width), dtype=dtype)

    def work(start: int) -> None:
        result[start : start + block] = function(flat[start : start + block])

    starts = range(0, len(flat), block)
    if min(threads, len(starts)) < 2:
        deque(map(work, starts), maxlen=0)
    else:
        from concurrent.futures import ThreadPoolExecutor  # slow to import

        with ThreadPoolExecutor(threads) as pool:
            deque(pool.map(work, starts), maxlen=0)
    return result.reshape(*rows.shape[:-1], width)


def as_colours(rgb: ArrayLike, sensor: Sensor) -> Array:
    """Convert to linear RGB (…, 3), float64, clipped where rounding moved it outside
    [0, 1].

    `ColourError` quotes the first colour outside.
    """
    array = np.asarray(as_rgb(rgb), dtype=float)
    # Faster than a test of each colour; NaN fails both comparisons.
    if array.size and not (array.min() >= -SLACK and array.max() <= 1 + SLACK):
        raise_out_of_gamut(array[~in_unit_cube(array)])
    return np.clip(array, 0, 1)


def as_wavelengths(wavelengths: ArrayLike | None, default: Array) -> Array:
    """Convert to wavelengths (N,) as `uplift.common.arrays.as_nm`, None to the
    default.
    """
    return default if wavelengths is None else as_nm(wavelengths)


def as_float_type(dtype: DTypeLike) -> np.dtype[Any]:
    """Convert to float64 or float32; `OptionError` for other types."""
    with contextlib.suppress(TypeError):
        if np.dtype(dtype) in (np.float64, np.float32):
            return np.dtype(dtype)
    raise OptionError(f"dtype must be float64 or float32, got {dtype!r}")


def as_whole_number(value: int, name: str, least: int = 1) -> int:
    """Convert to a whole number from ``least``; `OptionError` for anything else."""
    is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not is_whole or value < least:
        raise OptionError(f"{name} must be a whole number from {least}, got {value!r}")
    return int(value)


def as_thread_count(threads: int) -> int:
    """Convert to a number of threads; `OptionError` for anything else."""
    return as_whole_number(threads, "threads")


def as_coefficient_count(count: int | None, data: CubeData) -> int:
    """Return the number of coefficients of nodes, the default, or of entries;
    `OptionError` for other numbers.
    """
    counts = (data.model.count, data.atlas.spectra.model.count)
    if count is None:
        return counts[0]
    if isinstance(count, bool) or count not in counts:
        numbers = " or ".join(map(str, sorted(set(counts))))
        raise OptionError(f"count must be {numbers} for this cube, got {count!r}")
    return int(count)


def decode_codes(sensor: Sensor, codes: ArrayLike) -> Array:
    """Convert 8-bit codes (…) to linear values by the encoding of a sensor;
    `ColourError` outside 0 to 255.
    """
    error = partial(ColourError, code="invalid-codes")
    array = as_array(codes, error)
    outside = array[~((array >= 0) & (array <= 255))]
    if outside.size:
        problem = f"8-bit codes must be in [0, 255], got {outside[0]:g}"
        raise error(problem, hint="pass linear RGB to the query without decoding it")
    return sensor.decode(array)
