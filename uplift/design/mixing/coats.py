"""A coat of paint or dye under its surface, ready to be laid on any ground: a colour, or a painting.

Reflectances are as they are seen, surface included: a coat of no thickness leaves its ground as it was. A ground darker
than the surface alone is taken for black beneath it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.design.mixing import dyes, kubelka_munk
from uplift.design.mixing.layers import Layer
from uplift.design.mixing.pigments import GRADING, Pigment, of_hiding, on_two_grounds
from uplift.design.mixing.surface import NONE, Surface
from uplift.design.mixing.validation import length


@dataclass(frozen=True, eq=False)
class Coat:
    """A layer (…, N) beneath a surface."""

    layer: Layer
    surface: Surface = NONE

    def over(self, ground: ArrayLike) -> Array:
        """Reflectance (…, N) on a ground (…, N), both as seen."""
        return self.surface.seen(self.layer.over(_beneath(self.surface, ground)))


def of_dyes(spectra: ArrayLike, parts: ArrayLike, thickness: float = 1.0, surface: Surface = NONE) -> Coat:
    """``parts`` (…, n) of dyes that on white, one unit thick, are seen with reflectances (n, N)."""
    mixture = dyes.mixed(dyes.of_reflectance(spectra, surface), parts)
    through = dyes.transmittance(mixture, thickness=thickness)
    return Coat(Layer(np.zeros_like(through), through), surface)


def of_paints(
    paints: Pigment, parts: ArrayLike, thickness: float | None = None, surface: Surface = NONE
) -> Coat:
    """``parts`` (…, n) of paints (n, N), ``thickness`` units thick, or thick enough to hide what is beneath."""
    mixture = paints.mixed(parts)
    if thickness is None:
        hiding = kubelka_munk.hiding(mixture)
        return Coat(Layer(hiding, np.zeros_like(hiding)), surface)
    return Coat(kubelka_munk.layer(mixture, length(thickness)), surface)


def paint(
    seen: ArrayLike,
    on_black: ArrayLike | None = None,
    *,
    surface: Surface = NONE,
    grading: float = GRADING,
) -> Pigment:
    """A paint from the reflectance (N,) it is ``seen`` with: hiding, or a unit thick on white and on black.

    Raises `ColourError` where no paint has both; what is raised by `pigments.of_hiding`.
    """
    white = _beneath(surface, seen)
    if on_black is None:
        return of_hiding(white, grading)
    return on_two_grounds(_beneath(surface, on_black), white)


def palette(paints: Sequence[Pigment]) -> Pigment:
    """Paints (N,) side by side, as (n, N)."""
    return Pigment(np.stack([one.absorption for one in paints]), np.stack([one.scattering for one in paints]))


def _beneath(surface: Surface, seen: ArrayLike) -> Array:
    return np.clip(surface.beneath(seen), 0, 1)
