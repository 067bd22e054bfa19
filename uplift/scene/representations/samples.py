"""Base of representations by n samples that are multiplied one by one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.models.matmul import matmul_rows


@dataclass(frozen=True, eq=False)
class SampleRepresentation:
    """Linear encoding, the same for lights and surfaces.

    Parameters
    ----------
    name, family : str
        See `Representation`.
    encoder : ndarray, shape (401, n)
        ``spectra @ encoder`` is the code.
    weights : ndarray, shape (n, 3)
        ``code @ weights`` is the XYZ of a light.
    """

    name: str
    family: str
    encoder: Array
    weights: Array

    def encode_light(self, power: Array) -> Array:
        return np.asarray(matmul_rows(power, self.encoder))

    def encode_surface(self, reflectance: Array) -> Array:
        return self.encode_light(reflectance)

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * surface

    def xyz(self, light: Array) -> Array:
        return light @ self.weights

    def storage(self, code: Array) -> Array:
        return row_sizes(code)


def row_sizes(code: Array) -> Array:
    """Numbers per row (n,) of a code that is a single array."""
    return np.full(len(code), float(code[0].size))
