"""Picture in the coefficients of a factor model, and the lights to put on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.palette.design import Design
from uplift.design.palette.matrix import matrix

MAX_MATERIALS = 255
"""Materials that 8-bit labels distinguish, as 0 means none."""


@dataclass(frozen=True, eq=False)
class Lights:
    """The lights of a palette.

    Parameters
    ----------
    names : tuple of str
        Names of the L lights.
    power : ndarray, shape (L, N)
        Spectral powers; a flat power of 1 has luminance 1.
    coefficients : ndarray, shape (L, m)
        Coefficients of the factor model.
    white : ndarray, shape (L, 3)
        Linear sRGB of the perfect reflector, by full spectra.
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
    names : tuple of str
        Names of the n materials.
    coefficients : ndarray, shape (n, m)
        Coefficients of the factor model.
    colours : ndarray, shape (n, L, 3)
        Linear sRGB under each light, by full spectra.
    """

    names: tuple[str, ...]
    coefficients: Array
    colours: Array


@dataclass(frozen=True, eq=False)
class Relighting:
    """A picture rendered without light, which is applied last.

    Parameters
    ----------
    title : str
        Title of the page.
    weights : ndarray, shape (H, W, n)
        Amount of each material in each pixel, including shading; 0 or more.
    materials : Materials
        The materials.
    lights : Lights
        The lights.
    to_rgb : ndarray, shape (3, m)
        From coefficients to linear sRGB.
    wavelengths : ndarray, shape (N,)
        Wavelengths of the powers in nm.

    References
    ----------
    S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, sections 2.2.2 and 5.1.
    """

    title: str
    weights: NDArray[np.float32]
    materials: Materials
    lights: Lights
    to_rgb: Array
    wavelengths: Array

    @property
    def pixels(self) -> NDArray[np.float32]:
        """Coefficients of the pixels, (H, W, m)."""
        return self.weights @ self.materials.coefficients.astype(np.float32)

    @property
    def labels(self) -> NDArray[np.uint8]:
        """Predominant material of each pixel (H, W), counted from 1; 0 for none."""
        return np.where(self.weights.any(axis=-1), 1 + self.weights.argmax(axis=-1), 0).astype(np.uint8)

    def rgb(self, mix: ArrayLike) -> Array:
        """Light the picture.

        Parameters
        ----------
        mix : array_like, shape (L,)
            Weights of the lights.

        Returns
        -------
        ndarray, shape (H, W, 3)
            Linear sRGB, not clipped.
        """
        light = np.asarray(mix, dtype=float) @ self.lights.coefficients
        return self.pixels @ (self.to_rgb * light).T


def relighting(title: str, design: Design, weights: NDArray[np.float32]) -> Relighting:
    """Prepare a picture of a palette's materials to be lit by its lights.

    Parameters
    ----------
    title : str
        Title of the page.
    design : Design
        The design of the palette.
    weights : ndarray, shape (H, W, n)
        Amount of each material in each pixel.

    Returns
    -------
    Relighting
        The picture with lights and materials.

    Raises
    ------
    OptionError
        If there are more than 255 materials.
    """
    palette, model, colours = design.palette, design.model, matrix(design)
    if len(palette.materials) > MAX_MATERIALS:
        raise OptionError(
            f"a picture must have at most {MAX_MATERIALS} materials, got {len(palette.materials)}",
            code="too-many-materials",
        )
    materials = tuple(material.name for material in palette.materials)
    lights = tuple(light.name for light in palette.lights)
    return Relighting(
        title=title,
        weights=weights,
        materials=Materials(materials, model.reflectance(design.reflectances), colours.obtained),
        lights=Lights(lights, design.powers, model.light(design.powers), colours.whites),
        to_rgb=model.matrix,
        wavelengths=model.wavelengths,
    )
