"""What a factor model is made from: lights that reflectances reflect once, twice and three times."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.common.arrays import Array

MOST = 3
"""Reflections on a way of light."""


@dataclass(frozen=True, eq=False)
class Bounces:
    """Ways of light, each a product of spectra.

    Parameters
    ----------
    factors : (MOST + 1, n, N) the light, then the reflectances it meets; ones where there are fewer.
    """

    factors: Array

    @cached_property
    def signals(self) -> Array:
        """(n, N) the power that reaches the eye: colour signals."""
        return self.factors.prod(axis=0)


def bounces(reflectances: Array, lights: Array) -> Bounces:
    """Every light (L, N) on every reflectance (E, N), then on one and on two more of them, drawn at random."""
    draw = np.random.default_rng(0)
    white = np.ones_like(reflectances)
    ways = []
    for light in lights:
        power = np.broadcast_to(light, reflectances.shape)
        met = [reflectances, *(reflectances[draw.permutation(len(reflectances))] for _ in range(MOST - 1))]
        ways += [[power, *met[:count], *[white] * (MOST - count)] for count in range(1, MOST + 1)]
    return Bounces(np.concatenate(ways, axis=1))
