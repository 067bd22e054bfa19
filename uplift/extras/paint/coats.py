"""Mixtures by kind of component, and coats of paint or dye on any ground: a uniform
colour or the pixels of an image.

All reflectances include the surface. A coat of thickness 0 therefore leaves its ground
unchanged. Grounds darker than the surface alone are treated as black beneath it.

Dyes absorb and do not scatter (Fishkin 1983, eq. 9.3–9.7). Of the light that enters, 1
− ρ, the i-th pass contributes (1 − ρ) (1 − ρ_i) (T² R_g)^i ρ_i^(i−1), so that a dye on
a ground R_g in optical contact has

    R = ρ + (1 − ρ) (1 − ρ_i) T² R_g / (1 − ρ_i T² R_g),

which is Saunderson's correction (eq. 10.10) of T² R_g, or Kubelka and Munk's result
without scattering. The thesis prints, with ρ_i = ρ, (1 − ρ)² / (ρ (1 − ρ T² R_g)): its
sum starts at 1, but the term i = 0 was not subtracted.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import SLACK
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning, warn
from uplift.common.text import pluralise
from uplift.extras.paint import optics, pigments
from uplift.extras.paint.duntley import Flux, duntley_layer
from uplift.extras.paint.optics import Layer, Surface
from uplift.extras.paint.pigments import Pigment, Scattering

COATS = ("pigment", "measured", "dye", "duntley")
KINDS = (*COATS, "filter", "light")
# smallest transmittance that the absorption of a dye is derived from; it diverges at 0
DARKEST = 1e-6
MAX_THICKNESS = 1e9  # as it is multiplied with other numbers


@dataclass(frozen=True, eq=False)
class Coat:
    """A layer of paint or dye beneath the surface of its vehicle."""

    layer: Layer
    surface: Surface = optics.NO_SURFACE

    def over(self, ground: ArrayLike) -> Array:
        """Return the reflectance (..., N) on a ground (..., N), both
        surface included.
        """
        beneath = _beneath(self.surface, ground)
        return self.surface.apply(
            self.layer.over(beneath), self.layer.diffuse.over(beneath)
        )


@dataclass(frozen=True, eq=False)
class Ingredients:
    """Spectra of the components of a mixture.

    Parameters
    ----------
    spectra : ndarray of shape (n, N)
        Reflectance of opaque pigments, reflectance of dyes one unit thick on white,
        transmittance of filters, or power of lights. Of measured paints K and S,
        (n, 2, N), and of paints by Duntley's theory their constants, (n, 6, N).
    on_black : tuple of ndarray of shape (N,) or None, one for each component, optional
        Reflectance on black of the pigments that ``spectra`` gives on white, one unit
        thick. None for the others.
    """

    spectra: Array
    on_black: tuple[Array | None, ...] = ()

    @property
    def measured_on_black(self) -> list[Array]:
        """The spectra (N,) on black that are given."""
        return [colour for colour in self.on_black if colour is not None]


@dataclass(frozen=True)
class Medium:
    """Properties of a coat.

    Parameters
    ----------
    thickness : float, optional
        Thickness in units, by default opaque for pigments and 1 for dyes and Duntley's
        paints.
    surface : Surface
        Surface of the vehicle.
    scattering : callable, optional
        S of pigments that are given by one colour, which need it; see `dispersive`.
    plate : bool
        Whether dyes are in a free plate with a surface on both sides, and the ground is
        behind a gap of air.
    """

    thickness: float | None = None
    surface: Surface = optics.NO_SURFACE
    scattering: Scattering | None = None
    plate: bool = False


def make_coat(
    kind: str, ingredients: Ingredients, parts: ArrayLike, medium: Medium
) -> Coat:
    """Make a coat of pigments or dyes.

    Parameters
    ----------
    kind : {"pigment", "measured", "dye", "duntley"}
        Kind of the components.
    ingredients : Ingredients
        The n components. A warning states how many are darker than the surface alone at
        some wavelengths.
    parts : array_like of shape (..., n)
        Amounts of the components.
    medium : Medium
        Thickness, surface and scattering.

    Returns
    -------
    Coat
        The coat; ``coat.over(ground)`` is its reflectance on a ground.

    Raises
    ------
    OptionError
        An argument is invalid, a dye has a colour on black, a plate has no dye, or the
        scattering of a pigment is missing.
    ColourError
        No pigment has the given reflectances on white and on black.
    """
    if kind not in COATS:
        raise OptionError(
            f"a coat cannot be of kind '{kind}'", hint=f"use {' or '.join(COATS)}"
        )
    check_thickness(medium.thickness)
    if medium.plate and kind != "dye":
        raise OptionError(
            f"a plate must be of kind 'dye', got '{kind}'",
            hint="what scatters has no free plate",
        )
    thickness = 1.0 if medium.thickness is None else medium.thickness
    if kind == "duntley":
        return _duntley_coat(ingredients, parts, thickness, medium.surface)
    if kind == "measured":
        pigments = Pigment(ingredients.spectra[:, 0], ingredients.spectra[:, 1])
        return coat_of_pigments(pigments, parts, medium)
    surface = medium.surface
    spectra = [*ingredients.spectra, *ingredients.measured_on_black]
    dark = sum(bool((surface.remove(colour) < -SLACK).any()) for colour in spectra)
    if dark:
        problem = (
            f"{dark} of {pluralise(len(spectra), 'colour')} partly darker than the "
            "surface alone: black there"
        )
        warn(UpliftWarning(problem))
    if kind == "dye":
        return _dye_coat(ingredients, parts, thickness, medium)
    return _pigment_coat(ingredients, parts, medium)


def check_thickness(thickness: float | None) -> None:
    """Raise `OptionError` for an impossible thickness; None is opaque."""
    if thickness is not None and not 0 <= thickness <= MAX_THICKNESS:
        problem = f"thickness must be in [0, {MAX_THICKNESS:g}], got {thickness}"
        raise OptionError(problem, hint="1 is the unit")


def _duntley_coat(
    ingredients: Ingredients, parts: ArrayLike, thickness: float, surface: Surface
) -> Coat:
    constants = ingredients.spectra
    mixed = optics.weighted_sum(
        constants.reshape(len(constants), -1), optics.as_shares(parts)
    )
    fluxes = np.moveaxis(mixed.reshape(*mixed.shape[:-1], 6, -1), -2, 0)
    layer = duntley_layer(Flux(*fluxes[:3]), Flux(*fluxes[3:]), thickness)
    return Coat(layer, surface)


def _dye_coat(
    ingredients: Ingredients, parts: ArrayLike, thickness: float, medium: Medium
) -> Coat:
    if ingredients.measured_on_black:
        raise OptionError(
            "dyes must not have a colour on black",
            hint="pass their colour on white only",
        )
    surface = medium.surface
    absorption = optics.weighted_sum(
        dye_absorption(ingredients.spectra, surface), optics.as_shares(parts)
    )
    transmittance = dye_transmittance(absorption, thickness)
    if medium.plate:
        return Coat(optics.plate(transmittance, surface.outside))
    return Coat(Layer(np.zeros_like(transmittance), transmittance), surface)


def _pigment_coat(ingredients: Ingredients, parts: ArrayLike, medium: Medium) -> Coat:
    on_black = ingredients.on_black or (None,) * len(ingredients.spectra)
    paints = [
        _pigment(*colours, medium)
        for colours in zip(ingredients.spectra, on_black, strict=True)
    ]
    stacked = Pigment(
        np.stack([paint.absorption for paint in paints]),
        np.stack([paint.scattering for paint in paints]),
    )
    return coat_of_pigments(stacked, parts, medium)


def coat_of_pigments(pigments: Pigment, parts: ArrayLike, medium: Medium) -> Coat:
    """Make a coat of pigments with known K and S (n, N), mixed by parts (..., n)."""
    check_thickness(medium.thickness)
    mixture = pigments.mix(parts)
    if medium.thickness is not None:
        return Coat(mixture.layer(medium.thickness), medium.surface)
    reflectance = mixture.opaque_reflectance()
    return Coat(Layer(reflectance, np.zeros_like(reflectance)), medium.surface)


def mix(
    kind: str,
    ingredients: Ingredients,
    parts: ArrayLike,
    medium: Medium,
    ground: ArrayLike,
) -> Array:
    """Mix components.

    Parameters
    ----------
    kind : {"pigment", "measured", "dye", "duntley", "filter", "light"}
        Kind of the components.
    ingredients : Ingredients
        The n components.
    parts : array_like of shape (..., n)
        Amounts; for filters their thickness.
    medium : Medium
        Thickness, surface and scattering of pigments and dyes.
    ground : array_like of shape (N,)
        Reflectance of the ground below pigments and dyes.

    Returns
    -------
    ndarray of shape (..., N)
        Reflectance, transmittance of filters or power of lights.

    Raises
    ------
    OptionError, ColourError
        As `make_coat`, or the medium does not apply to the kind.
    """
    if kind in COATS:
        return make_coat(kind, ingredients, parts, medium).over(ground)
    if kind not in KINDS:
        raise OptionError(
            f"unknown kind of mixture '{kind}'", hint=f"use one of {', '.join(KINDS)}"
        )
    usual = (None, optics.NO_SURFACE, False)
    if (
        medium.thickness,
        medium.surface,
        medium.plate,
    ) != usual or ingredients.measured_on_black:
        problem = (
            f"{kind}s must not have a thickness, a surface, a plate or a colour on "
            "black"
        )
        raise OptionError(
            problem, hint="leave them out; parts of filters are their thickness"
        )
    return (optics.stack_filters if kind == "filter" else optics.add_lights)(
        ingredients.spectra, parts
    )


def ramp(parts: ArrayLike, steps: int) -> Array:
    """Return proportions (steps, n) from the first component alone, through the others,
    to the last alone.

    ``parts`` (n,) are the amounts at which each component stands alone. The shape is
    (0, 1) for a single component.

    >>> ramp([2, 1], 3).tolist()
    [[2.0, 0.0], [1.0, 0.5], [0.0, 1.0]]
    """
    if steps < 2:
        raise OptionError(
            f"a ramp must have at least 2 steps, got {steps}", hint="use 2 or more"
        )
    ends = np.diag(optics.as_amounts(parts))
    if len(ends) < 2:
        return np.empty((0, len(ends)))
    positions = np.linspace(0, len(ends) - 1, steps)
    stops = np.arange(len(ends))
    return np.stack([np.interp(positions, stops, column) for column in ends.T], axis=-1)


def dye_transmittance(absorption: ArrayLike, thickness: float) -> Array:
    """Return T = exp(−K X) of absorption (..., N) (Beer, eq. 9.5). A concentration
    multiplies the thickness.
    """
    return np.exp(-thickness * np.asarray(absorption, dtype=float))


def dye_absorption(
    reflectance: ArrayLike, surface: Surface = optics.NO_SURFACE
) -> Array:
    """Return the absorption (..., N) of a dye, one unit thick, from its reflectance on
    perfect white (eq. 9.7, 9.5).
    """
    transmittance = np.sqrt(_beneath(surface, reflectance))
    return -np.log(np.clip(transmittance, DARKEST, 1))


def _pigment(spectrum: Array, on_black: Array | None, medium: Medium) -> Pigment:
    internal = _beneath(medium.surface, spectrum)
    if on_black is not None:
        return pigments.from_black_and_white(
            _beneath(medium.surface, on_black), internal
        )
    if medium.scattering is None:
        problem = "one colour does not determine the scattering of a pigment"
        raise OptionError(
            problem, hint="set the scattering of the medium, or give a colour on black"
        )
    return pigments.from_opaque(internal, medium.scattering)


def _beneath(surface: Surface, reflectance: ArrayLike) -> Array:
    return np.clip(surface.remove(reflectance), 0, 1)
