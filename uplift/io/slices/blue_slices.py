"""Arrangement of a cube in an image: slices of constant blue, red to the right, green upwards."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", bound=np.generic)


def blue_slices(values: NDArray[Number], dim: int) -> NDArray[Number]:
    """Arrange the values of nodes as slices.

    Image rows count downwards, so row 0 has the highest green: ``row = dim − 1 − green``.

    Parameters
    ----------
    values : ndarray of shape (dim³, ...)
        Values of the nodes.
    dim : int
        Nodes along each axis.

    Returns
    -------
    ndarray of shape (dim, dim, dim, ...)
        View with axes blue, row, red.
    """
    by_red = values.reshape(dim, dim, dim, *values.shape[1:])
    return by_red.swapaxes(0, 2)[:, ::-1]
