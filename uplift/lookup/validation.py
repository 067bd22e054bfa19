"""Validate the arguments of queries, and convert them to plain arrays."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.gamut import as_rgb, raise_out_of_gamut
from uplift.colorimetry.sensor import SLACK, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError
from uplift.cube import CubeData

FLOAT_TYPES = (np.dtype(np.float64), np.dtype(np.float32))


def as_colours(rgb: ArrayLike, sensor: Sensor) -> Array:
    """Convert to linear RGB (…, 3), clipped where rounding moved it outside [0, 1]; `ColourError` for others."""
    return clip_rounding(as_rgb(rgb), sensor)


def clip_rounding(rgb: NDArray[Any], sensor: Sensor) -> Array:
    """Clip linear RGB (…, 3) to [0, 1], as float64; `ColourError` quotes the first colour outside."""
    array = np.asarray(rgb, dtype=float)
    # Faster than a test of each colour; NaN fails both comparisons.
    if array.size and not (array.min() >= -SLACK and array.max() <= 1 + SLACK):
        raise_out_of_gamut(array[~sensor.contains(array)])
    return np.clip(array, 0, 1)


def as_wavelengths(wavelengths: ArrayLike) -> Array:
    """Convert to wavelengths (N,) in nm; `OptionError` if they are not positive numbers."""
    with contextlib.suppress(TypeError, ValueError):
        array = np.atleast_1d(np.asarray(wavelengths, dtype=float))
        if array.ndim == 1 and array.size and (np.isfinite(array) & (array > 0)).all():
            return array
    raise OptionError("wavelengths must be a list of positive numbers in nm", code="invalid-wavelengths")


def as_float_type(dtype: DTypeLike) -> np.dtype[Any]:
    """Convert to float64 or float32; `OptionError` for other types."""
    with contextlib.suppress(TypeError):
        if np.dtype(dtype) in FLOAT_TYPES:
            return np.dtype(dtype)
    raise OptionError(f"dtype must be float64 or float32, got {dtype!r}")


def as_thread_count(threads: int) -> int:
    """Convert to a whole number from 1; `OptionError` for anything else."""
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise OptionError(f"threads must be a whole number from 1, got {threads!r}")
    return int(threads)


def as_coefficient_count(count: int | None, data: CubeData) -> int:
    """Return the number of coefficients of nodes, the default, or of entries; `OptionError` for other numbers."""
    counts = (data.model.count, data.entry_spectra.model.count)
    if count is None:
        return counts[0]
    if isinstance(count, bool) or count not in counts:
        numbers = " or ".join(str(each) for each in sorted(set(counts)))
        raise OptionError(f"count must be {numbers} for this cube, got {count!r}")
    return int(count)


def decode_codes(sensor: Sensor, codes: ArrayLike) -> Array:
    """Convert 8-bit codes (…) to linear values by the encoding of a sensor; `ColourError` outside 0 to 255."""
    try:
        array = np.asarray(codes, dtype=float)
    except (TypeError, ValueError) as error:
        raise ColourError("8-bit codes must be numbers", code="invalid-codes") from error
    outside = array[~((array >= 0) & (array <= 255))]
    if outside.size:
        raise ColourError(
            f"8-bit codes must be in [0, 255], got {outside[0]:g}",
            code="invalid-codes",
            hint="pass linear RGB to the query without decoding it",
        )
    return sensor.decode(array)
