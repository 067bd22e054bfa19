"""Types of arrays and paths in signatures; blocks of rows, and distances between
points.
"""

import sys
from collections.abc import Callable, Iterator
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from uplift.common.errors import (
    OptionError,
    UpliftError,
)
from uplift.common.errors import (
    StrPath as StrPath,
)  # defined without numpy, which takes long to import
from uplift.common.text import format_value

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Floats = NDArray[np.float32]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Values = NDArray[Any]
"""Array of numbers of any type, mostly float64 or float32."""
SHORTEST = 100.0
"""Shortest wavelength in nm: smaller numbers are in micrometres or metres."""
LONGEST = 5000.0
"""Longest wavelength in nm of spectra that are requested."""


def as_array(
    values: Any,
    error: Callable[..., UpliftError] = OptionError,
    dtype: DTypeLike = float,
) -> Values:
    """Convert to an array of numpy; ``error`` for anything but numbers, masked values
    (``masked-values``) and numbers that JAX traces (``traced-values``).
    """
    # An array has a mask only if the module is loaded, which takes time.
    masked = sys.modules.get("numpy.ma")
    if masked is not None:
        rows = values if isinstance(values, list | tuple) else [values]
        if any(map(masked.is_masked, rows)):
            problem = "masked values are not numbers"
            hint = "fill them, or leave them out"
            raise error(problem, code="masked-values", hint=hint)
    try:
        if np.iscomplexobj(values):
            raise ValueError("imaginary parts would be dropped")
        return np.asarray(values, dtype=dtype)
    except (TypeError, ValueError) as cause:
        if type(cause).__module__.startswith("jax"):
            problem = "numbers that JAX traces have no values"
            hint = (
                "prepare the cube by uplift.bulk.traceable, and call "
                "uplift.bulk.evaluate in the function that is traced"
            )
            raise error(problem, code="traced-values", hint=hint) from cause
        raise error(f"numbers are required, got {format_value(values)}") from cause


def as_nm(wavelengths: ArrayLike) -> Array:
    """Convert to wavelengths (N,) in nm; `OptionError` outside `SHORTEST` to
    `LONGEST`.
    """
    array = np.atleast_1d(as_array(wavelengths))
    limits = f"wavelengths must be a list of numbers in [{SHORTEST:g}, {LONGEST:g}] nm"
    if array.ndim != 1 or not array.size:
        raise OptionError(f"{limits}, got the shape {array.shape}")
    outside = array[~((array >= SHORTEST) & (array <= LONGEST))]
    if outside.size:
        hint = "multiply micrometres by 1000, divide ångströms by 10"
        raise OptionError(f"{limits}, got {outside[0]:g}", hint=hint)
    return array


def as_floats(values: Any) -> Any:
    """Return an array of JAX as it is, and anything else as an array of numpy."""
    if hasattr(values, "__array_namespace__") and not isinstance(values, np.ndarray):
        return values
    return as_array(values)


def blocks(count: int, size: int) -> Iterator[slice]:
    """Yield the slices of blocks of at most ``size`` of ``count`` rows, in order."""
    for first in range(0, count, size):
        yield slice(first, min(first + size, count))


def largest(rows: Array) -> Array:
    """Largest element (n,) of each row (n, K), K > 0, by columns: numpy is slow along
    short axes.
    """
    return np.asarray(reduce(np.maximum, rows.T))


def distances(first: Array, second: Array) -> Array:
    """Compute the Euclidean distances (n, m) of points (n, K) and (m, K), by
    components, as products would cancel.
    """
    squares = np.zeros((len(first), len(second)))
    for one, other in zip(first.T, second.T, strict=True):
        squares += np.subtract.outer(one, other) ** 2
    return np.sqrt(squares, out=squares)
