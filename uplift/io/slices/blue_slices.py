"""How a cube lies in an image: blue slices, red rising to the right, green rising upwards."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", bound=np.generic)


def planes(values: NDArray[Number], dim: int) -> NDArray[Number]:
    """Slices ``[blue, row, red]`` (dim, dim, dim, …) of values (dim³, …) per lattice point; a view.

    Image rows count downwards, so row 0 holds the highest green: ``row = dim − 1 − green``.
    """
    by_red = values.reshape(dim, dim, dim, *values.shape[1:])
    return by_red.swapaxes(0, 2)[:, ::-1]
