"""Spectra of colours outside the RGB space of a cube that reflectances can have.

A colour in the object-colour solid has spectra, whether or not its RGB lie in [0, 1]. The multipliers of the nearest
colour that the cube holds, on the line of constant dominant wavelength, move to it by minimum-norm steps.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut import as_rgb, map_to_gamut
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array
from uplift.common.errors import ColourError
from uplift.cube import CubeData
from uplift.lookup.interpolate import coefficients
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate

MAPPING = "desaturate"
"""Gamut mapping to the colour that the steps start from."""


def reflectance_outside(data: CubeData, rgb: Array, at: Array) -> Array:
    """Compute reflectances (n, N) at wavelengths (N,) in nm, of linear RGB (n, 3) that may lie outside [0, 1].

    Raises
    ------
    ColourError
        No reflectance has a colour (``colour-unrealisable``), or the steps do not reach it
        (``colour-not-reached``), which is possible close to the boundary of the solid.
    """
    possible = solid(data.sensor.matrix).contains(rgb)
    if not possible.all():
        raise ColourError(
            f"no reflectance has the colour of XYZ {_format(data, rgb[int(possible.argmin())])}",
            code="colour-unrealisable",
            hint="reduce its luminance, where white has Y = 1, or its distance from white",
        )
    start = data.model.from_storage(coefficients(data, map_to_gamut(rgb, data.sensor, MAPPING).rgb))
    multipliers = refine_to_rgb(data, data.model, start, rgb)
    reached = data.sensor.rgb(evaluate(data.model, multipliers, data.sensor.wavelengths))
    distance = np.abs(reached - rgb).max(axis=1)
    if (distance > data.threshold).any():
        raise ColourError(
            f"the model does not reach the colour of XYZ {_format(data, rgb[int(distance.argmax())])}",
            code="colour-not-reached",
            hint="move it toward white, away from the limit of what reflectances can have",
        )
    return evaluate(data.model, multipliers, at)


def xyz_to_rgb(data: CubeData, xyz: ArrayLike) -> Array:
    """Convert XYZ (n, 3) under the illuminant of a cube, with Y = 1 for white, to linear RGB. Raises `ColourError`."""
    data.sensor.require_xyz()
    values = as_rgb(xyz).astype(float)
    if not np.isfinite(values).all():
        raise ColourError("XYZ must be finite", code="rgb-not-finite", hint="fix its source")
    return np.asarray(values @ data.sensor.xyz_to_rgb.T)


def _format(data: CubeData, rgb: Array) -> str:
    return "(" + ", ".join(f"{value:.4g}" for value in data.sensor.xyz(rgb)) + ")"
