"""What may be asked: colours, wavelengths, types, checked once and made into plain arrays."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.colorimetry.gamut import as_rgb, raise_out_of_gamut
from uplift.colorimetry.sensor import SLACK, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import ColourError, OptionError, UpliftError

TYPES = (np.dtype(np.float64), np.dtype(np.float32))


def colours(rgb: ArrayLike, sensor: Sensor) -> Array:
    """Linear RGB (…, 3), clipped where rounding took it outside [0, 1]. Raises `ColourError`."""
    return within(as_rgb(rgb), sensor)


def within(rgb: NDArray[Any], sensor: Sensor) -> Array:
    """Linear RGB (…, 3) in [0, 1], float64. Raises `ColourError`, quoting the first that lies outside."""
    array = np.asarray(rgb, dtype=float)
    # Much quicker than asking for each; NaN fails both comparisons.
    if array.size and not (array.min() >= -SLACK and array.max() <= 1 + SLACK):
        raise_out_of_gamut(array[~sensor.contains(array)])
    return np.clip(array, 0, 1)


def wavelengths_asked(wavelengths: ArrayLike) -> Array:
    """Wavelengths (N,) nm. Raises `OptionError` for what are no positive numbers."""
    problem = "wavelengths must be a list of positive numbers in nm"
    array = np.atleast_1d(floats(wavelengths, problem, OptionError))
    if array.ndim != 1 or not array.size or not (np.isfinite(array) & (array > 0)).all():
        raise OptionError(problem)
    return array


def float_type(dtype: DTypeLike) -> np.dtype[Any]:
    """float64 or float32. Raises `OptionError` for other types."""
    for known in TYPES:
        if _same(dtype, known):
            return known
    raise OptionError(f"answers are float64 or float32, not {dtype!r}")


def thread_count(threads: int) -> int:
    """A whole number from 1. Raises `OptionError` for anything else."""
    if isinstance(threads, bool) or not isinstance(threads, int | np.integer) or threads < 1:
        raise OptionError(f"{threads!r} is no number of threads", hint="use 1 or more")
    return int(threads)


def floats(values: Any, problem: str, kind: type[UpliftError] = ColourError) -> Array:
    """``values`` as an array of float64. Raises ``kind``."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise kind(problem) from error


def _same(dtype: DTypeLike, known: np.dtype[Any]) -> bool:
    try:
        return np.dtype(dtype) == known
    except TypeError:
        return False
