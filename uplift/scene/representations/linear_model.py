"""Linear model (LM) of Peercy 1993, "Linear color representations for full speed spectral rendering".

Its basis belongs to a scene: the first principal components, about the origin, of every product of its lights with its
surfaces, and of the lights. A light is n coordinates. A surface is the n × n matrix by which it acts on lights of that
space. Spectra that the basis was not made from have larger errors. Kment 2011, section 5.4, omits linear models because
they need this prior knowledge.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.representations.dense import xyz_weights
from uplift.scene.representations.samples import row_sizes


@dataclass(frozen=True, eq=False)
class LinearModel:
    """Coordinates in an orthonormal ``basis`` (401, n)."""

    basis: Array
    family = "linear model (PCA)"

    @property
    def name(self) -> str:
        return f"LM{self.basis.shape[1]}"

    def encode_light(self, power: Array) -> Array:
        return power @ self.basis

    def encode_surface(self, reflectance: Array) -> Array:
        return np.asarray(np.einsum("ik,ni,il->nkl", self.basis, reflectance, self.basis, optimize=True))

    def multiply(self, light: Array, surface: Array) -> Array:
        return np.asarray((surface @ light[:, :, None])[:, :, 0])

    def xyz(self, light: Array) -> Array:
        return light @ (self.basis.T @ xyz_weights())

    def storage(self, code: Array) -> Array:
        return row_sizes(code)


def linear_model(count: int, lights: Array, surfaces: Array) -> LinearModel:
    """Compute ``count`` components of a scene of lights (L, 401), normalised to equal Y, and surfaces (E, 401)."""
    scatter = np.zeros((lights.shape[1],) * 2)
    for power in lights / (lights @ xyz_weights()[:, 1:2]):
        radiance = np.concatenate([surfaces * power, power[None]])
        scatter += radiance.T @ radiance
    _, vectors = np.linalg.eigh(scatter)
    return LinearModel(vectors[:, ::-1][:, :count])
