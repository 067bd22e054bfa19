"""Types of arrays and paths in signatures; blocks of rows, and distances between
points.
"""

from collections.abc import Iterator
from functools import reduce
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import (
    StrPath as StrPath,
)  # defined without numpy, which takes long to import

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Floats = NDArray[np.float32]
Indices = NDArray[np.int64]
Mask = NDArray[np.bool_]
Values = NDArray[Any]
"""Array of numbers of any type, mostly float64 or float32."""


def as_floats(values: Any) -> Any:
    """Return an array of JAX as it is, and anything else as an array of numpy."""
    if hasattr(values, "__array_namespace__") and not isinstance(values, np.ndarray):
        return values
    return np.asarray(values, dtype=float)


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
