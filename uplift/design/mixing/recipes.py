"""From what is mixed to a mixture, by kind: pigments, dyes, filters or lights, in any number of proportions at once."""

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
from uplift.design.mixing.pigments import GRADING
from uplift.design.mixing.surface import NONE, Surface
from uplift.design.mixing.validation import amounts

COATS = ("pigment", "dye")
KINDS = (*COATS, "filter", "light")


@dataclass(frozen=True, eq=False)
class Ingredients:
    """``seen`` (n, N): pigments when they hide, dyes a unit thick on white; what filters let through, lights give.

    ``on_black`` (N,) of those pigments that are given a unit thick on white and on black instead.
    """

    seen: Array
    on_black: tuple[Array | None, ...]


@dataclass(frozen=True)
class Medium:
    """``thickness`` in units, None for the kind's own; the vehicle's ``surface``, that of air for none.

    ``grading`` of pigments' scattering, as `pigments` has it.
    """

    thickness: float | None = None
    surface: Surface = NONE
    grading: float = GRADING


def coat(kind: str, ingredients: Ingredients, parts: ArrayLike, medium: Medium) -> Coat:
    """A coat of ``parts`` (…, n) of pigments, hiding if no thickness is given, or of dyes, by default a unit thick.

    An `UpliftWarning` tells of colours darker than the surface. Raises `OptionError` for other kinds, and `ColourError`
    for pigments that cannot be.
    """
    if kind not in COATS:
        raise OptionError(f"{kind}s make no coat", hint=f"use {' or '.join(COATS)}")
    _warn_of_dark(ingredients, medium.surface)
    if kind == "dye":
        if any(one is not None for one in ingredients.on_black):
            raise OptionError("dyes have no colour on black", hint="give their colour on white alone")
        thickness = 1.0 if medium.thickness is None else medium.thickness
        return coats.of_dyes(ingredients.seen, parts, thickness, medium.surface)
    paints = [
        coats.paint(seen, on_black, surface=medium.surface, grading=medium.grading)
        for seen, on_black in zip(ingredients.seen, ingredients.on_black, strict=True)
    ]
    return coats.of_paints(coats.palette(paints), parts, medium.thickness, medium.surface)


def _warn_of_dark(ingredients: Ingredients, surface: Surface) -> None:
    """What is seen with less than the surface throws back cannot be beneath it."""
    given = [*ingredients.seen, *(one for one in ingredients.on_black if one is not None)]
    dark = sum(bool((surface.beneath(one) < -SLACK).any()) for one in given)
    if dark:
        told = (
            f"{dark} of {len(given)} colours are in part darker than the surface alone: taken for black there"
        )
        warnings.warn(told, UpliftWarning, stacklevel=3)


def mixed(kind: str, ingredients: Ingredients, parts: ArrayLike, medium: Medium, ground: ArrayLike) -> Array:
    """Spectra (…, N) of ``parts`` (…, n): coats on a ``ground`` (N,), thickness of filters, strength of lights.

    Raises `OptionError` for unknown kinds and for a medium that the kind has not; what is raised by `coat`.
    """
    if kind in COATS:
        return coat(kind, ingredients, parts, medium).over(ground)
    if kind not in KINDS:
        raise OptionError(f"unknown kind of mixture '{kind}'", hint=f"use one of {', '.join(KINDS)}")
    if medium != Medium() or any(one is not None for one in ingredients.on_black):
        raise OptionError(
            f"{kind}s have no thickness, surface, or colour on black",
            hint="leave them out: parts of filters are their thickness",
        )
    mix = filters.stacked if kind == "filter" else additive.lights
    return mix(ingredients.seen, parts)


def ramp(parts: ArrayLike, steps: int) -> Array:
    """(steps, n): from all of the first ingredient to all of the last, through those between; ``parts`` (n,).

    (0, 1) where there is only one. Raises `OptionError` for less than two steps.
    """
    if steps < 2:
        raise OptionError(f"a ramp of {steps} steps", hint="give 2 or more")
    ends = np.diag(amounts(parts))
    if len(ends) < 2:
        return np.empty((0, len(ends)))
    at, places = np.linspace(0, len(ends) - 1, steps), np.arange(len(ends))
    return np.stack([np.interp(at, places, column) for column in ends.T], axis=-1)
