"""Palette: lights, materials, and the colours that materials must have under lights."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array

Fit = Literal["spectra", "factor-model"]
"""Colours that goals are about: of full spectra, or of the factor model."""


@dataclass(frozen=True, eq=False)
class SpectrumSpec:
    """A light or a material, given or to be designed.

    Parameters
    ----------
    name : str
        Its name.
    samples : ndarray, shape (N,), or None
        Power or reflectance; None if it is to be designed.
    low, high : float
        Bounds of a designed spectrum, infinite for none.
    """

    name: str
    samples: Array | None
    low: float = 0.0
    high: float = 1.0

    @property
    def designed(self) -> bool:
        """Whether the spectrum is to be designed."""
        return self.samples is None


@dataclass(frozen=True, eq=False)
class ColourGoal:
    """Colour of a material under a light.

    Parameters
    ----------
    material, light : str
        Their names.
    rgb : ndarray, shape (3,), optional
        Target in linear RGB.
    free : str, optional
        Name of a free colour instead, which all goals of this name share.
    weight : float
        Weight in the least-squares problem, 0 or more.
    """

    material: str
    light: str
    rgb: Array | None = None
    free: str | None = None
    weight: float = 1.0

    def __str__(self) -> str:
        return f"{self.material} under {self.light}"


@dataclass(frozen=True)
class MinDifference:
    """Least difference between two materials under a light. It is checked, not optimised.

    Parameters
    ----------
    materials : tuple of str
        Names of the two materials.
    light : str
        Name of the light.
    delta_e : float
        Least ΔE00.
    """

    materials: tuple[str, str]
    light: str
    delta_e: float


@dataclass(frozen=True, eq=False)
class Palette:
    """Lights, materials and goals, with the weights of Bergner, section 3.3.

    Parameters
    ----------
    sensor : Sensor
        Wavelengths, observer and RGB space.
    lights, materials : tuple of SpectrumSpec
        Columns and rows of the matrix.
    goals : tuple of ColourGoal
        At most one for each material under each light.
    free : mapping
        Lowest and highest linear RGB (3,) of every free colour.
    min_differences : tuple of MinDifference
        Differences to check.
    smoothness : float
        Weight ω_D of the second differences of designed spectra.
    model_error : float
        Weight ω_F of the difference between the colours of the factor model and of full spectra.
    count : int
        Number of coefficients of the factor model.
    fit : {"spectra", "factor-model"}
        Whether goals are met by full spectra (eq. 18) or by the factor model (eq. 19).
    sources : tuple of Path
        Files that the palette was read from.
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
    fit: Fit = "spectra"
    sources: tuple[Path, ...] = ()

    def light(self, name: str) -> SpectrumSpec:
        """Find a light.

        Parameters
        ----------
        name : str
            Its name, which must be one of the palette's.

        Returns
        -------
        SpectrumSpec
            The light.
        """
        return next(light for light in self.lights if light.name == name)

    def material(self, name: str) -> SpectrumSpec:
        """Find a material.

        Parameters
        ----------
        name : str
            Its name, which must be one of the palette's.

        Returns
        -------
        SpectrumSpec
            The material.
        """
        return next(material for material in self.materials if material.name == name)

    def cell(self, material: str, light: str) -> tuple[int, int]:
        """Find the cell of a material under a light in the matrix of a design.

        Parameters
        ----------
        material, light : str
            Their names, which must be of the palette.

        Returns
        -------
        tuple of int
            Row and column.
        """
        rows, columns = ([spec.name for spec in specs] for specs in (self.materials, self.lights))
        return rows.index(material), columns.index(light)
