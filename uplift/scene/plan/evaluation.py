"""Colour errors of candidates on test colours, under the lights of the scene."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from uplift.colorimetry import Light, delta_e_2000, lab
from uplift.common.arrays import Array

TEXTURES, MATERIALS = "textures", "materials"
WORST_DELTA_E = 100.0
"""ΔE00 of colours that are not finite: the difference between black and white."""


@dataclass(frozen=True, eq=False)
class ColourGroup:
    """Test colours whose error is one statistic: linear RGB (n, 3), reference spectra (n, N), weights (n,) of sum 1."""

    name: str
    rgb: Array
    reflectances: Array
    weights: Array

    def subsample(self, count: int) -> "ColourGroup":
        """At most ``count`` colours, drawn at equal steps of the cumulative weight."""
        if len(self.rgb) <= count:
            return self
        drawn = np.searchsorted(np.cumsum(self.weights), (np.arange(count) + 0.5) / count)
        rows, repeats = np.unique(np.minimum(drawn, len(self.rgb) - 1), return_counts=True)
        return ColourGroup(self.name, self.rgb[rows], self.reflectances[rows], repeats / count)


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

    Arrays of all colours are those of the groups, one below the other. ``quantile`` is the share of the colours whose
    largest ΔE00 is the error of a group.
    """

    groups: tuple[ColourGroup, ...]
    lights: tuple[Light, ...]
    quantile: float

    @cached_property
    def rgb(self) -> Array:
        """Linear RGB of all groups, (n, 3)."""
        return np.concatenate([group.rgb for group in self.groups])

    @cached_property
    def reflectances(self) -> Array:
        """Reference spectra of all groups, (n, N)."""
        return np.concatenate([group.reflectances for group in self.groups])

    @cached_property
    def lab(self) -> list[Array]:
        """CIE L*a*b* (n, 3) of the reference spectra under each light."""
        return [lab(xyz, light.white) for xyz, light in zip(self.xyz(self.reflectances), self.lights, strict=True)]

    def xyz(self, reflectances: Array) -> Array:
        """XYZ (K, n, 3) of reflectances (n, N) on the grid of the lights, where white has Y = 1."""
        return np.stack([reflectances @ light.xyz.T for light in self.lights])

    def subsample(self, count: int) -> "EvaluationSet":
        """At most ``count`` colours of each group."""
        return replace(self, groups=tuple(group.subsample(count) for group in self.groups))

    def error(self, reflectances: Array) -> ErrorSummary:
        """Errors of reflectances (n, N) on the grid of the lights."""
        return self.error_of_xyz(self.xyz(reflectances))

    def error_of_xyz(self, xyz: Sequence[Array] | Array) -> ErrorSummary:
        """Errors of XYZ (n, 3) under each light, where white has Y = 1."""
        ends = np.cumsum([len(group.rgb) for group in self.groups])[:-1]
        parts = []
        for light, reference, values in zip(self.lights, self.lab, xyz, strict=True):
            difference = delta_e_2000(reference, lab(values, light.white))
            delta_e = np.where(np.isfinite(difference), difference, WORST_DELTA_E)
            for group, errors in zip(self.groups, np.split(delta_e, ends), strict=True):
                quantile = np.quantile(errors, self.quantile, weights=group.weights, method="inverted_cdf")
                mean, largest = float(errors @ group.weights), float(errors.max())
                parts.append(GroupError(group.name, light.name, mean, float(quantile), largest))
        return ErrorSummary(tuple(parts))
