"""Light paths that a factor model is fitted to: a light and up to three reflections."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array

MAX_REFLECTIONS = 3


@dataclass(frozen=True, eq=False)
class LightPaths:
    """Products of a light and reflectances.

    Parameters
    ----------
    factors : ndarray, shape (MAX_REFLECTIONS + 1, n, N)
        The light, then the reflectances; ones for paths of fewer reflections.
    """

    factors: Array

    @cached_property
    def signals(self) -> Array:
        """Colour signals (n, N): the power that reaches the eye."""
        return self.factors.prod(axis=0)


def make_light_paths(reflectances: Array, lights: Array) -> LightPaths:
    """Combine every light (L, N) with every reflectance (E, N), then with one and with two random others."""
    rng = np.random.default_rng(0)
    white = np.ones_like(reflectances)
    paths = []
    for light in lights:
        power = np.broadcast_to(light, reflectances.shape)
        others = [reflectances[rng.permutation(len(reflectances))] for _ in range(MAX_REFLECTIONS - 1)]
        surfaces = [reflectances, *others]
        for count in range(1, MAX_REFLECTIONS + 1):
            paths.append([power, *surfaces[:count], *[white] * (MAX_REFLECTIONS - count)])
    return LightPaths(np.concatenate(paths, axis=1))
