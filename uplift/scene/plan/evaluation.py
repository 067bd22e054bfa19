"""What a candidate is asked, and how far its answers are off under the lights of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array

TEXTURES, MATERIALS = "textures", "materials"
WORST_DELTA_E = 100.0
"""The ΔE00 of what is no number: as far as black is from white."""


@dataclass(frozen=True, eq=False)
class Group:
    """n colours that are judged together: linear RGB (n, 3), reflectances (n, N) wanted, weights (n,) that sum to 1."""

    name: str
    rgb: Array
    wanted: Array
    weights: Array

    def thinned(self, most: int) -> Group:
        """``most`` colours at the most, each for as many others."""
        if len(self.rgb) <= most:
            return self
        drawn = np.searchsorted(np.cumsum(self.weights), (np.arange(most) + 0.5) / most)
        rows, times = np.unique(np.minimum(drawn, len(self.rgb) - 1), return_counts=True)
        return Group(self.name, self.rgb[rows], self.wanted[rows], times / most)


@dataclass(frozen=True)
class GroupError:
    """ΔE00 of a group under a light: mean, the quantile that counts, and the largest."""

    group: str
    light: str
    mean: float
    quantile: float
    largest: float


@dataclass(frozen=True)
class ErrorSummary:
    """How far a candidate is off: of every group under every light."""

    parts: tuple[GroupError, ...]

    @property
    def worst(self) -> GroupError:
        """The group and the light that decide."""
        return max(self.parts, key=lambda part: part.quantile)

    @property
    def quantile(self) -> float:
        return self.worst.quantile


@dataclass(frozen=True, eq=False)
class EvaluationSet:
    """Colours of all groups one below the other, and the lights to see them under.

    ``share`` is that of the colours whose largest ΔE00 is the error.
    """

    groups: tuple[Group, ...]
    lights: tuple[Light, ...]
    share: float

    @property
    def rgb(self) -> Array:
        """(n, 3)."""
        return np.concatenate([group.rgb for group in self.groups])

    @property
    def wanted(self) -> Array:
        """(n, N) reflectances."""
        return np.concatenate([group.wanted for group in self.groups])

    def thinned(self, most: int) -> EvaluationSet:
        """``most`` colours of each group at the most."""
        return replace(self, groups=tuple(group.thinned(most) for group in self.groups))

    def error(self, answered: Array) -> ErrorSummary:
        """Of reflectances (n, N) on the grid of the lights."""
        return self.seen([answered @ light.xyz.T for light in self.lights])

    def seen(self, xyz: Sequence[Array] | Array) -> ErrorSummary:
        """Of the XYZ (n, 3) under each light; white has Y = 1, whoever computes them."""
        ends = np.cumsum([len(group.rgb) for group in self.groups])[:-1]
        parts = [
            self._part(group, light, values)
            for light, apart in zip(self.lights, self.apart(xyz), strict=True)
            for group, values in zip(self.groups, np.split(apart, ends), strict=True)
        ]
        return ErrorSummary(tuple(parts))

    def apart(self, xyz: Sequence[Array] | Array) -> list[Array]:
        """ΔE00 (n,) under each light, of XYZ (n, 3) under each."""
        found = []
        for light, seen in zip(self.lights, xyz, strict=True):
            apart = delta_e_2000(*(lab(each, light.white) for each in (self.wanted @ light.xyz.T, seen)))
            found.append(np.where(np.isfinite(apart), apart, WORST_DELTA_E))
        return found

    def _part(self, group: Group, light: Light, values: Array) -> GroupError:
        counts = np.quantile(values, self.share, weights=group.weights, method="inverted_cdf")
        mean = float(values @ group.weights)
        return GroupError(group.name, light.name, mean, float(counts), float(values.max()))
