"""Spectra of colours outside the RGB space of a cube (docs/mathematics.md, 9)."""

import numpy as np

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import format_rgb
from uplift.common.arrays import Array, Mask
from uplift.common.errors import ColourError
from uplift.cube import CubeData
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import coefficients
from uplift.lookup.refine import refine_to_rgb
from uplift.models import evaluate

MAPPING = "desaturate"
"""Gamut mapping to the colour from which the spectra of colours outside the RGB space start."""


def reflectance_outside(data: CubeData, rgb: Array, at: Array) -> Array:
    """Compute reflectances (n, N) at wavelengths (N,) in nm, of linear RGB (n, 3) that may lie outside [0, 1].

    A colour in the object-colour solid has spectra, whether or not its RGB lie in [0, 1]. The multipliers of the
    nearest colour that the cube holds, on the line of constant dominant wavelength, move to it by minimum-norm steps,
    which may fail close to the boundary of the solid. In the box of an entry outside [0, 1], so do those of the entry,
    and the two reflectances, of one colour, are mixed.
    """
    possible = data.solid.contains(rgb)
    if not possible.all():
        raise ColourError(
            f"no reflectance has the colour of XYZ {format_rgb(data.sensor.xyz(rgb[int(possible.argmin())]))}",
            code="colour-unrealisable",
            hint="reduce its luminance, where white has Y = 1, or its distance from white",
        )
    # Start from the nearest colour inside, and near an entry outside from its spectrum, unless that answers alone.
    hits, entries = data.outside_boxes.find(rgb), data.outside_spectra
    has_lattice = np.ones(len(rgb), dtype=bool)
    has_lattice[hits.rows[hits.lattice_weight == 0]] = False
    start = data.model.from_storage(coefficients(data, map_to_gamut(rgb[has_lattice], data.sensor, MAPPING).rgb))
    multipliers = refine_to_rgb(data, data.model, start, rgb[has_lattice])
    own = None
    if entries is not None and hits.rows.size:
        own = refine_to_rgb(data, entries.model, entries.multipliers[hits.entry], rgb[hits.rows])

    def spectra(wavelengths: Array) -> Array:
        found = np.zeros((len(rgb), len(wavelengths)))
        found[has_lattice] = evaluate(data.model, multipliers, wavelengths)
        if entries is not None and own is not None:  # t · answer + (1 − t) · entry
            weight = hits.lattice_weight[:, None]
            found[hits.rows] = weight * found[hits.rows] + (1 - weight) * evaluate(entries.model, own, wavelengths)
        return found

    reached = data.sensor.rgb(spectra(data.sensor.wavelengths))
    distance = np.abs(reached - rgb).max(axis=1)
    if (distance > data.threshold).any():
        raise ColourError(
            f"the model does not reach the colour of XYZ {format_rgb(data.sensor.xyz(rgb[int(distance.argmax())]))}",
            code="colour-unrealisable",
            hint="move it toward white, away from the limit of what reflectances can have",
        )
    return spectra(at)


def reflectance_anywhere(cube: Cube, rgb: Array, at: Array, mode: str, outside: Mask) -> Array:
    """Compute reflectances (n, N) at wavelengths (N,) in nm, of linear RGB (n, 3) that may be ``outside`` (n,)."""
    spectra = np.empty((len(rgb), len(at)))
    spectra[~outside] = cube.reflectance(rgb[~outside], at, mode)
    if outside.any():
        spectra[outside] = reflectance_outside(cube.data, rgb[outside], at)
    return spectra
