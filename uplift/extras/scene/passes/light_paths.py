"""Paths of light over one to four surfaces, and their colours: what the decoding of
passes is fitted to, and judged by.

A path multiplies the spectrum of a light by one to four reflectances. Its colour is
the sum over wavelengths; its numbers in K bands are products of the numbers of the
light and the surfaces, as an RGB renderer computes them.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import (
    delta_e_2000,
    delta_e_2000_form,
    lab,
    lab_jacobian,
)
from uplift.common.arrays import Array, Indices

MAX_BOUNCES = 4


@dataclass(frozen=True, eq=False)
class LightPaths:
    """n paths over materials under L lights.

    ``powers`` (L, 81) are those of the lights, of Y = 1. ``surfaces`` (M + 1, 81) are
    reflectances, the last of them the perfect reflector,
    which fills the rows of ``index`` (n, 4) that have fewer bounces. ``bounces`` (n,)
    are 0 to 4; a path of none is light that arrives directly.
    """

    surfaces: Array
    index: Indices
    bounces: Indices
    powers: Array

    @cached_property
    def reflected(self) -> Array:
        """Products (n, 81) of the reflectances of each path."""
        return self.surfaces[self.index].prod(axis=1)

    @cached_property
    def xyz(self) -> Array:
        """XYZ (L, n, 3), where the perfect reflector has Y = 1."""
        return self.reflected @ (
            self.powers[:, :, None] * observer.matching_functions()
        )

    @cached_property
    def whites(self) -> Array:
        """XYZ (L, 1, 3) of the perfect reflector."""
        return (self.powers @ observer.matching_functions())[:, None]

    @cached_property
    def lab(self) -> Array:
        """CIE L*a*b* (L, n, 3), relative to the white of each light."""
        return lab(self.xyz, self.whites)

    def numbers(self, weights: Array) -> Array:
        """Numbers (n, K) of the paths under a light of ones, for weights (K, 81)."""
        textures = np.clip(self.surfaces @ weights.T, 0, 1)
        return textures[self.index].prod(axis=1)

    def errors(self, xyz: Array) -> Array:
        """ΔE00 (L, n) of other XYZ (L, n, 3) of the paths."""
        return delta_e_2000(self.lab, lab(xyz, self.whites))

    def decoding_errors(self, weights: Array, lights: Array, to_xyz: Array) -> Array:
        """ΔE00 (L, n) of bands of weights (K, 81) and lights of numbers (L, K), decoded
        by a matrix (3, K) for all lights, or by matrices (L, 3, K).
        """
        lit = self.numbers(weights) * lights[:, None]
        return self.errors(lit @ to_xyz.mT)

    def by_bounce(self, errors: Array) -> Array:
        """Mean errors (L, 4) of one to four bounces, of errors (L, n) of paths."""
        means = [
            errors[:, self.bounces == count].mean(axis=1)
            for count in range(1, MAX_BOUNCES + 1)
        ]
        return np.stack(means, axis=1)

    @cached_property
    def metric(self) -> Array:
        """Forms G (L, n, 3, 3): dᵀ G d ≈ ΔE00² for a small difference d of XYZ."""
        slopes = lab_jacobian(self.xyz, self.whites)
        return slopes.mT @ delta_e_2000_form(self.lab) @ slopes


def draw_paths(
    materials: Array,
    powers: Array,
    count: int,
    seed: int,
    *,
    direct: int = 0,
) -> LightPaths:
    """Draw ``count`` paths of each number of bounces over materials (M, 81), all with
    equal probability, and ``direct`` paths without a surface, under lights of powers
    (L, 81).
    """
    perfect = np.ones((1, materials.shape[1]))
    rng = np.random.default_rng(seed)
    last = len(materials)
    rows = [np.full((direct, MAX_BOUNCES), last)]
    for bounces in range(1, MAX_BOUNCES + 1):
        drawn = rng.integers(0, last, (count, MAX_BOUNCES))
        drawn[:, bounces:] = last
        rows.append(drawn)
    numbers = np.arange(MAX_BOUNCES + 1)
    counts = [direct, *[count] * MAX_BOUNCES]
    return LightPaths(
        np.concatenate([materials, perfect]),
        np.concatenate(rows),
        np.repeat(numbers, counts),
        powers,
    )
