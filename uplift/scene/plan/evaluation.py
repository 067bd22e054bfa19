"""Colour errors of a candidate on test colours, under the lights of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array

TEXTURES, MATERIALS = "textures", "materials"
WORST_DELTA_E = 100.0
"""ΔE00 of colours that are not finite: the difference between black and white."""


@dataclass(frozen=True, eq=False)
class ColourGroup:
    """Test colours whose error is one statistic.

    Parameters
    ----------
    name : str
        `TEXTURES` or `MATERIALS`.
    rgb : ndarray, shape (n, 3)
        Linear RGB.
    reflectances : ndarray, shape (n, N)
        Reference spectra.
    weights : ndarray, shape (n,)
        Weights, which sum to 1.
    """

    name: str
    rgb: Array
    reflectances: Array
    weights: Array

    def subsample(self, count: int) -> ColourGroup:
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
    """Test colours with their reference spectra, and the lights to compare them under.

    Parameters
    ----------
    groups : tuple of ColourGroup
        Arrays of all colours are those of the groups, one below the other.
    lights : tuple of Light
        Lights on the grid of the reference spectra.
    quantile : float
        Share of the colours whose largest ΔE00 is the error of a group.
    """

    groups: tuple[ColourGroup, ...]
    lights: tuple[Light, ...]
    quantile: float

    @property
    def rgb(self) -> Array:
        """Linear RGB of all groups, (n, 3)."""
        return np.concatenate([group.rgb for group in self.groups])

    @property
    def reflectances(self) -> Array:
        """Reference spectra of all groups, (n, N)."""
        return np.concatenate([group.reflectances for group in self.groups])

    def subsample(self, count: int) -> EvaluationSet:
        """At most ``count`` colours of each group."""
        return replace(self, groups=tuple(group.subsample(count) for group in self.groups))

    def error(self, reflectances: Array) -> ErrorSummary:
        """Errors of reflectances (n, N) on the grid of the lights."""
        return self.error_of_xyz([reflectances @ light.xyz.T for light in self.lights])

    def error_of_xyz(self, xyz: Sequence[Array] | Array) -> ErrorSummary:
        """Errors of XYZ (n, 3) under each light, where white has Y = 1."""
        ends = np.cumsum([len(group.rgb) for group in self.groups])[:-1]
        parts = [
            self._group_error(group, light, values)
            for light, delta_e in zip(self.lights, self.delta_e(xyz), strict=True)
            for group, values in zip(self.groups, np.split(delta_e, ends), strict=True)
        ]
        return ErrorSummary(tuple(parts))

    def delta_e(self, xyz: Sequence[Array] | Array) -> list[Array]:
        """ΔE00 (n,) under each light to XYZ (n, 3)."""
        return [self._delta_e(light, values) for light, values in zip(self.lights, xyz, strict=True)]

    def _delta_e(self, light: Light, xyz: Array) -> Array:
        reference = self.reflectances @ light.xyz.T
        delta_e = delta_e_2000(lab(reference, light.white), lab(xyz, light.white))
        return np.where(np.isfinite(delta_e), delta_e, WORST_DELTA_E)

    def _group_error(self, group: ColourGroup, light: Light, delta_e: Array) -> GroupError:
        quantile = np.quantile(delta_e, self.quantile, weights=group.weights, method="inverted_cdf")
        mean = float(delta_e @ group.weights)
        return GroupError(group.name, light.name, mean, float(quantile), float(delta_e.max()))
