"""A palette: lights, materials, and the colours that they shall make. What a spec says, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array


@dataclass(frozen=True, eq=False)
class SpectrumSpec:
    """A light or a material.

    Parameters
    ----------
    samples : (N,) its power or reflectance; None where it is to be designed.
    low, high : bounds of what is designed, infinite for none.
    """

    name: str
    samples: Array | None
    low: float = 0.0
    high: float = 1.0

    @property
    def designed(self) -> bool:
        return self.samples is None


@dataclass(frozen=True, eq=False)
class ColourGoal:
    """A material's colour under a light: linear ``rgb`` (3,), or one that all wishes of the group ``free`` share."""

    material: str
    light: str
    rgb: Array | None = None
    free: str | None = None
    weight: float = 1.0

    def __str__(self) -> str:
        return f"{self.material} under {self.light}"


@dataclass(frozen=True)
class MinDifference:
    """Two materials that shall differ under a light by at least so many ΔE00. Looked at, not designed for."""

    materials: tuple[str, str]
    light: str
    delta_e: float


@dataclass(frozen=True, eq=False)
class Palette:
    """Lights (columns), materials (rows) and wishes, with the weights of Bergner, 3.3.

    Parameters
    ----------
    free : for every free colour its lowest and highest linear RGB, (3,) each.
    smoothness : ω_D, of the second differences of what is designed.
    model_error : ω_F, of the difference between the colours of the factor model and of full spectra.
    count : coefficients of the factor model.
    """

    sensor: Sensor
    lights: tuple[SpectrumSpec, ...]
    materials: tuple[SpectrumSpec, ...]
    goals: tuple[ColourGoal, ...]
    free: Mapping[str, tuple[Array, Array]]
    min_differences: tuple[MinDifference, ...] = ()
    smoothness: float = 0.001
    model_error: float = 0.1
    count: int = 7

    def light(self, name: str) -> SpectrumSpec:
        return next(part for part in self.lights if part.name == name)

    def material(self, name: str) -> SpectrumSpec:
        return next(part for part in self.materials if part.name == name)
