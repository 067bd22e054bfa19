"""Palette: lights, materials, and the colours that materials must have under lights."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.files.spec import SPEC, NotNegative

# Colours that goals are about: of full spectra (eq. 18), or of the factor model (eq.
# 19).
Fit = Literal["spectra", "factor-model"]


@dataclass(frozen=True, eq=False)
class SpectrumSpec:
    """A light or a material, given or to be designed."""

    name: str
    samples: Array | None  # (N,) power or reflectance; None if it is to be designed
    low: float = 0.0  # bounds of a designed spectrum, infinite for none
    high: float = 1.0

    @property
    def designed(self) -> bool:
        """Whether the spectrum is to be designed."""
        return self.samples is None


@dataclass(frozen=True, eq=False)
class ColourGoal:
    """Colour of a material under a light."""

    material: str
    light: str
    rgb: Array | None = None  # (3,) target in linear RGB
    # or the name of a free colour, which all goals of this name share
    free: str | None = None
    weight: float = 1.0  # 0 or more

    def __str__(self) -> str:
        return f"{self.material} under {self.light}"


@dataclass(frozen=True)
class MinDifference:
    """Least difference between two materials under a light. It is checked, not
    optimised.
    """

    __pydantic_config__ = SPEC

    materials: tuple[str, str]
    light: str
    delta_e: NotNegative  # ΔE00


@dataclass(frozen=True, eq=False)
class Palette:
    """Lights, materials and goals, with the weights of Bergner, section 3.3."""

    sensor: Sensor
    lights: tuple[SpectrumSpec, ...]  # columns of the matrix
    materials: tuple[SpectrumSpec, ...]  # its rows
    goals: tuple[ColourGoal, ...]  # at most one for each material under each light
    # lowest and highest linear RGB (3,) of every free colour
    free: Mapping[str, tuple[Array, Array]]
    min_differences: tuple[MinDifference, ...] = ()
    smoothness: float = 0.001  # ω_D, of the second differences of designed spectra
    # ω_F, of the colours of the factor model less those of full spectra
    model_error: float = 0.1
    count: int = 7  # coefficients of the factor model
    fit: Fit = "spectra"
    sources: tuple[Path, ...] = ()  # files that the palette was read from

    def light(self, name: str) -> SpectrumSpec:
        """Find a light by a name that is in the palette."""
        return next(light for light in self.lights if light.name == name)

    def material(self, name: str) -> SpectrumSpec:
        """Find a material by a name that is in the palette."""
        return next(material for material in self.materials if material.name == name)

    def cell(self, material: str, light: str) -> tuple[int, int]:
        """Return row and column of a material under a light in the matrix
        of a design.
        """
        rows = [spec.name for spec in self.materials]
        columns = [spec.name for spec in self.lights]
        return rows.index(material), columns.index(light)
