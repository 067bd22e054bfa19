"""Colour errors of candidates on test colours, under the lights of the scene."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry import Light, delta_e_2000, lab
from uplift.common.arrays import Array, Indices

TEXTURES, MATERIALS = "textures", "materials"
WORST_DELTA_E = 100.0
"""ΔE00 of colours that are not finite: the difference between black and white."""


@dataclass(frozen=True)
class GroupError:
    """ΔE00 of a group under one light: weighted mean, the quantile of the scene, and the largest."""

    group: str
    light: str
    mean: float
    quantile: float
    largest: float


@dataclass(frozen=True)
class ErrorSummary:
    """Errors of a candidate: one part for every group under every light."""

    parts: tuple[GroupError, ...]

    @property
    def worst(self) -> GroupError:
        """The part of the largest quantile, which decides."""
        return max(self.parts, key=lambda part: part.quantile)

    @property
    def quantile(self) -> float:
        """Quantile of the worst part, ΔE00."""
        return self.worst.quantile


@dataclass(frozen=True, eq=False)
class EvaluationSet:
    """Test colours with their reference spectra, and the lights to compare them under, on the grid of the spectra.

    Linear RGB (n, 3), reference spectra (n, N), and weights (n,) whose sum is 1 in each group, a slice of the rows with
    one statistic. ``quantile`` is the share of the colours whose largest ΔE00 is the error of a group.
    """

    rgb: Array
    reflectances: Array
    weights: Array
    groups: Mapping[str, slice]
    lights: tuple[Light, ...]
    quantile: float

    @cached_property
    def lab(self) -> list[Array]:
        """CIE L*a*b* (n, 3) of the reference spectra under each light."""
        return [lab(xyz, light.white) for xyz, light in zip(self.xyz(self.reflectances), self.lights, strict=True)]

    def xyz(self, reflectances: Array) -> Array:
        """XYZ (K, n, 3) of reflectances (n, N) on the grid of the lights, where white has Y = 1."""
        return np.stack([reflectances @ light.xyz.T for light in self.lights])

    def subsample(self, count: int) -> Indices:
        """Rows of at most ``count`` colours of each group, drawn at equal steps of the cumulative weight."""
        found = []
        for rows in self.groups.values():
            drawn, size = np.arange(rows.start, rows.stop), rows.stop - rows.start
            if size > count:
                steps = np.searchsorted(np.cumsum(self.weights[rows]), (np.arange(count) + 0.5) / count)
                drawn = drawn[np.unique(np.minimum(steps, size - 1))]
            found.append(drawn)
        return np.concatenate(found)

    def error(self, xyz: Sequence[Array] | Array) -> ErrorSummary:
        """Errors of XYZ (n, 3) under each light, where white has Y = 1."""
        parts = []
        for light, reference, values in zip(self.lights, self.lab, xyz, strict=True):
            difference = delta_e_2000(reference, lab(values, light.white))
            delta_e = np.where(np.isfinite(difference), difference, WORST_DELTA_E)
            for name, rows in self.groups.items():
                errors, weights = delta_e[rows], self.weights[rows]
                quantile = np.quantile(errors, self.quantile, weights=weights, method="inverted_cdf")
                mean, largest = float(errors @ weights), float(errors.max())
                parts.append(GroupError(name, light.name, mean, float(quantile), largest))
        return ErrorSummary(tuple(parts))
