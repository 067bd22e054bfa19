"""What the page holds: a picture in the coefficients of a factor model, and the lights to put on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.palette.design import Design
from uplift.design.palette.matrix import matrix

MOST = 255
"""Materials that labels tell apart."""


@dataclass(frozen=True, eq=False)
class Lights:
    """The lights of a palette.

    Parameters
    ----------
    names : one a light, L of them.
    power : (L, N) spectral power; a flat one of 1 has luminance 1.
    coefficients : (L, m) of the factor model.
    white : (L, 3) linear sRGB of the perfect reflector, by whole spectra.
    """

    names: tuple[str, ...]
    power: Array
    coefficients: Array
    white: Array


@dataclass(frozen=True, eq=False)
class Materials:
    """The materials of a palette.

    Parameters
    ----------
    names : one a material, n of them.
    coefficients : (n, m) of the factor model.
    colours : (n, L, 3) linear sRGB under each light, by whole spectra.
    """

    names: tuple[str, ...]
    coefficients: Array
    colours: Array


@dataclass(frozen=True, eq=False)
class Relighting:
    """A picture rendered without light, which comes last (Bergner, Möller & Drew 2004, 2.2.2 and 5.1).

    Parameters
    ----------
    title : the palette's name.
    weights : (H, W, n) how much of each material a pixel shows, its shading included, from 0.
    to_rgb : (3, m) from coefficients to linear sRGB.
    wavelengths : (N,) nm of the lights' power.
    """

    title: str
    weights: NDArray[np.float32]
    materials: Materials
    lights: Lights
    to_rgb: Array
    wavelengths: Array

    @property
    def pixels(self) -> NDArray[np.float32]:
        """(H, W, m) coefficients."""
        return self.weights @ self.materials.coefficients.astype(np.float32)

    @property
    def labels(self) -> NDArray[np.uint8]:
        """(H, W) the material that a pixel shows most of, counted from 1; 0 where it shows none."""
        return np.where(self.weights.any(axis=-1), 1 + self.weights.argmax(axis=-1), 0).astype(np.uint8)

    def rgb(self, mix: ArrayLike) -> Array:
        """(H, W, 3) linear sRGB under ``mix`` (L,) of the lights, what the screen cannot show included."""
        light = np.asarray(mix, dtype=float) @ self.lights.coefficients
        return self.pixels @ (self.to_rgb * light).T


def relighting(title: str, found: Design, weights: NDArray[np.float32]) -> Relighting:
    """A picture of a palette's materials, to be lit by its lights; ``weights`` (H, W, n) are as in `Relighting`.

    Raises `OptionError` for more materials than labels can tell apart.
    """
    palette, model, colours = found.palette, found.model, matrix(found)
    if len(palette.materials) > MOST:
        raise OptionError(f"{len(palette.materials)} materials in a picture", hint=f"show {MOST} at most")
    lights, materials = (tuple(part.name for part in parts) for parts in (palette.lights, palette.materials))
    return Relighting(
        title=title,
        weights=weights,
        materials=Materials(materials, model.reflectance(found.reflectances), colours.obtained),
        lights=Lights(lights, found.powers, model.light(found.powers), colours.whites),
        to_rgb=model.matrix,
        wavelengths=model.wavelengths,
    )
