"""The linear model (LM) of Peercy 1993, "Linear color representations for full speed spectral rendering".

Its basis is that of the scene itself: the first principal components, about the origin, of every product of the
scene's lights with its surfaces, and of the lights. A light is its n coordinates; a surface is an n × n matrix, what
it does to lights of that space. Whoever asks for spectra that the basis was not made from has to expect more error:
the prior knowledge for which Kment 2011, 5.4 leaves linear models out.
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

    @property
    def name(self) -> str:
        return f"LM{self.basis.shape[1]}"

    @property
    def family(self) -> str:
        return "linear model (PCA)"

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
    """``count`` components of a scene of lights (L, 401) and surfaces (E, 401); all lights count alike."""
    scatter = np.zeros((lights.shape[1],) * 2)
    for power in lights / (lights @ xyz_weights()[:, 1:2]):
        sent = np.concatenate([surfaces * power, power[None]])
        scatter += sent.T @ sent
    _, vectors = np.linalg.eigh(scatter)
    return LinearModel(vectors[:, ::-1][:, :count])
