"""Representations by n numbers that are multiplied one by one: what differs is how they are taken and weighed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.models.matmul import matmul_rows


@dataclass(frozen=True, eq=False)
class SampleRepresentation:
    """Lights and surfaces alike are ``spectra @ encoder`` (401, n), a light's XYZ is ``code @ weights`` (n, 3)."""

    name: str
    family: str
    encoder: Array
    weights: Array

    def encode_light(self, power: Array) -> Array:
        return np.asarray(matmul_rows(power, self.encoder))

    def encode_surface(self, reflectance: Array) -> Array:
        return np.asarray(matmul_rows(reflectance, self.encoder))

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * surface

    def xyz(self, light: Array) -> Array:
        return light @ self.weights

    def storage(self, code: Array) -> Array:
        return row_sizes(code)


def row_sizes(code: Array) -> Array:
    """(n,) numbers in each row of a code that is one array."""
    return np.full(len(code), float(code[0].size))
