"""Numbers as text of a page: half precision or bytes, deflated, in base64."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray


def packed(values: NDArray[Any]) -> str:
    """The bytes of an array, those of equal significance together, which takes a third off half-precision numbers."""
    planes = np.ascontiguousarray(values).reshape(-1).view(np.uint8).reshape(-1, values.itemsize)
    return base64.b64encode(zlib.compress(planes.T.tobytes(), 9)).decode("ascii")


def halves(values: NDArray[Any]) -> NDArray[np.float16]:
    """Values in half precision, little-endian; eleven bits are a twentieth of an 8-bit code."""
    return values.astype("<f2")
