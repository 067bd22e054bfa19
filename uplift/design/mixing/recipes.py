"""Mixtures by kind of component: pigments, dyes, filters or lights, for many proportions at once."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import SLACK
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UpliftWarning
from uplift.design.mixing import additive, coats, filters
from uplift.design.mixing.coats import Coat
from uplift.design.mixing.pigments import Pigment
from uplift.design.mixing.scattering import Scattering
from uplift.design.mixing.surface import NO_SURFACE, Surface
from uplift.design.mixing.validation import as_amounts

COATS = ("pigment", "dye")
KINDS = (*COATS, "filter", "light")


@dataclass(frozen=True, eq=False)
class Ingredients:
    """Spectra of the components of a mixture.

    Parameters
    ----------
    spectra : ndarray of shape (n, N)
        Reflectance of opaque pigments, reflectance of dyes one unit thick on white, transmittance of filters, or
        power of lights.
    on_black : tuple of n ndarray of shape (N,), or None
        Reflectance on black of the pigments that ``spectra`` gives on white, one unit thick. None for the others.
    """

    spectra: Array
    on_black: tuple[Array | None, ...]


@dataclass(frozen=True)
class Medium:
    """Properties of a coat.

    Parameters
    ----------
    thickness : float, optional
        Thickness in units, by default opaque for pigments and 1 for dyes.
    surface : Surface
        Surface of the vehicle.
    scattering : Scattering, optional
        S of pigments given by one colour, which need it; see `uplift.design.mixing.scattering`.
    """

    thickness: float | None = None
    surface: Surface = NO_SURFACE
    scattering: Scattering | None = None


def make_coat(kind: str, ingredients: Ingredients, parts: ArrayLike, medium: Medium) -> Coat:
    """Make a coat of pigments or dyes.

    Parameters
    ----------
    kind : {"pigment", "dye"}
        Kind of the components.
    ingredients : Ingredients
        Spectra of the components.
    parts : array_like of shape (..., n)
        Amounts of the components.
    medium : Medium
        Properties of the coat.

    Returns
    -------
    Coat
        The coat.

    Raises
    ------
    OptionError
        The kind makes no coat (code ``unknown-coat``), a dye has a colour on black (``dye-on-black``), or a pigment of
        one colour has no assumed scattering (``scattering-missing``).
    ColourError
        No paint has the reflectances of a pigment.

    Warns
    -----
    UpliftWarning
        Colours are darker than the surface alone (code ``darker-than-surface``).
    """
    if kind not in COATS:
        raise OptionError(f"a coat cannot be of kind '{kind}'", code="unknown-coat", hint=f"use {' or '.join(COATS)}")
    _warn_of_dark(ingredients, medium.surface)
    if kind == "dye":
        if any(one is not None for one in ingredients.on_black):
            raise OptionError(
                "dyes must not have a colour on black",
                code="dye-on-black",
                hint="pass their colour on white only",
            )
        thickness = 1.0 if medium.thickness is None else medium.thickness
        return coats.from_dyes(ingredients.spectra, parts, thickness, medium.surface)
    paints = [
        _pigment(spectrum, on_black, medium)
        for spectrum, on_black in zip(ingredients.spectra, ingredients.on_black, strict=True)
    ]
    return coats.from_pigments(coats.stack(paints), parts, medium.thickness, medium.surface)


def _pigment(spectrum: Array, on_black: Array | None, medium: Medium) -> Pigment:
    if on_black is not None:
        return coats.pigment_from_two_grounds(spectrum, on_black, medium.surface)
    if medium.scattering is None:
        raise OptionError(
            "one colour does not determine the scattering of a pigment",
            code="scattering-missing",
            hint="set the scattering of the medium, or give a colour on black",
        )
    return coats.pigment_from_reflectance(spectrum, medium.scattering, medium.surface)


def _warn_of_dark(ingredients: Ingredients, surface: Surface) -> None:
    spectra = [*ingredients.spectra, *(one for one in ingredients.on_black if one is not None)]
    dark = sum(bool((surface.remove(one) < -SLACK).any()) for one in spectra)
    if dark:
        problem = (
            f"{dark} of {len(spectra)} colours are partly darker than the surface alone; they are treated as "
            "black there"
        )
        warnings.warn(UpliftWarning(problem, code="darker-than-surface"), stacklevel=3)


def mix(kind: str, ingredients: Ingredients, parts: ArrayLike, medium: Medium, ground: ArrayLike) -> Array:
    """Mix components.

    Parameters
    ----------
    kind : {"pigment", "dye", "filter", "light"}
        Kind of the components.
    ingredients : Ingredients
        Spectra of the components.
    parts : array_like of shape (..., n)
        Amounts of pigments or dyes, thickness of filters, or strength of lights.
    medium : Medium
        Properties of a coat; the default for filters and lights.
    ground : array_like of shape (N,)
        Reflectance of the ground beneath a coat.

    Returns
    -------
    ndarray of shape (..., N)
        Spectra of the mixtures.

    Raises
    ------
    OptionError
        The kind is unknown (code ``unknown-mixture``), or filters or lights have a medium
        (``medium-not-applicable``).
    """
    if kind in COATS:
        return make_coat(kind, ingredients, parts, medium).over(ground)
    if kind not in KINDS:
        raise OptionError(
            f"unknown kind of mixture '{kind}'", code="unknown-mixture", hint=f"use one of {', '.join(KINDS)}"
        )
    if (medium.thickness, medium.surface) != (None, NO_SURFACE) or any(one is not None for one in ingredients.on_black):
        raise OptionError(
            f"{kind}s must not have a thickness, a surface or a colour on black",
            code="medium-not-applicable",
            hint="leave them out; parts of filters are their thickness",
        )
    function = filters.stack if kind == "filter" else additive.add_lights
    return function(ingredients.spectra, parts)


def ramp(parts: ArrayLike, steps: int) -> Array:
    """Return proportions from the first component alone, through the others, to the last alone.

    Parameters
    ----------
    parts : array_like of shape (n,)
        Amounts at which each component stands alone.
    steps : int
        Number of steps, at least 2.

    Returns
    -------
    ndarray of shape (steps, n)
        Parts of each step. The shape is (0, 1) for a single component.

    Raises
    ------
    OptionError
        There are fewer than two steps (code ``too-few-steps``).

    Examples
    --------
    >>> ramp([2, 1], 3).tolist()
    [[2.0, 0.0], [1.0, 0.5], [0.0, 1.0]]
    """
    if steps < 2:
        raise OptionError(f"a ramp must have at least 2 steps, got {steps}", code="too-few-steps", hint="use 2 or more")
    ends = np.diag(as_amounts(parts))
    if len(ends) < 2:
        return np.empty((0, len(ends)))
    positions, stops = np.linspace(0, len(ends) - 1, steps), np.arange(len(ends))
    return np.stack([np.interp(positions, stops, column) for column in ends.T], axis=-1)
