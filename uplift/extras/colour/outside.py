"""Spectra of colours outside the RGB space of a cube (docs/mathematics.md, 8), and the
errors of its entries there.
"""

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Light, format_rgb
from uplift.common.arrays import Array, Mask
from uplift.common.errors import ColourError
from uplift.cube.data import CubeData
from uplift.lookup.interpolate import MODES, coefficients
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate

MAPPING = "desaturate"
"""Gamut mapping to the colour from which the spectra of colours outside the RGB space
start.
"""


def reflectance_outside(data: CubeData, rgb: Array, at: Array) -> Array:
    """Compute reflectances (n, N) at wavelengths (N,) in nm, of linear RGB (n, 3) that
    may lie outside [0, 1].

    A colour in the object-colour solid has spectra, whether or not its RGB lie in [0,
    1]. The multipliers of the nearest colour that the cube holds, on the line of
    constant dominant wavelength, move to it by minimum-norm steps, which may fail close
    to the boundary of the solid. In the box of an entry outside [0, 1], so do those of
    the entry, and the two reflectances, of one colour, are mixed.
    """
    possible = data.solid.contains(rgb)
    if not possible.all():
        hint = "reduce its luminance, where white has Y = 1, or its distance from white"
        xyz = data.sensor.xyz(rgb[int(possible.argmin())])
        problem = f"no reflectance has the colour of XYZ {format_rgb(xyz)}"
        raise ColourError(problem, code="colour-unrealisable", hint=hint)
    # Start from the nearest colour inside, and near an entry outside from its spectrum,
    # unless that answers alone. A cube without entries outside has no boxes there, and
    # no hits.
    hits = data.outside_boxes.find(rgb)
    entries = (data.atlas.outside or data.atlas).spectra
    has_lattice = ~np.isin(np.arange(len(rgb)), hits.rows[hits.lattice_weight == 0])
    start = data.model.from_storage(
        coefficients(data, map_to_gamut(rgb[has_lattice], data.sensor, MAPPING).rgb)
    )
    multipliers = refine_to_rgb(data, data.model, start, rgb[has_lattice])
    nearby = entries.multipliers[hits.entry]
    entry_multipliers = refine_to_rgb(data, entries.model, nearby, rgb[hits.rows])

    def spectra(wavelengths: Array) -> Array:
        lattice = np.zeros((len(rgb), len(wavelengths)))
        lattice[has_lattice] = evaluate(data.model, multipliers, wavelengths)
        return hits.mix(
            lattice, evaluate(entries.model, entry_multipliers, wavelengths)
        )

    reached = data.sensor.rgb(spectra(data.sensor.wavelengths))
    distance = np.abs(reached - rgb).max(axis=1)
    if (distance > data.threshold).any():
        hint = "move it toward white, away from the limit of what reflectances can have"
        xyz = data.sensor.xyz(rgb[int(distance.argmax())])
        problem = f"the model does not reach the colour of XYZ {format_rgb(xyz)}"
        raise ColourError(problem, code="colour-unrealisable", hint=hint)
    return spectra(at)


def reflectance_anywhere(
    data: CubeData, rgb: Array, at: Array, mode: str, outside: Mask
) -> Array:
    """Compute reflectances (n, N) at wavelengths (N,) in nm, of linear RGB (n, 3) that
    may be ``outside`` (n,).
    """
    spectra = np.empty((len(rgb), len(at)))
    spectra[~outside] = MODES[mode](data, np.clip(rgb[~outside], 0, 1), at)
    if outside.any():
        spectra[outside] = reflectance_outside(data, rgb[outside], at)
    return spectra


def outside_errors(data: CubeData, light: Light | None) -> Array:
    """ΔE00 (O,) between stored and measured spectrum of the entries outside the RGB
    space, NaN if it is not known.
    """
    table = data.atlas.outside
    if table is None:
        return np.zeros(0)
    if light is None or light.name == data.error_illuminant:
        return table.error
    if table.measured is None:
        return np.full(len(table.names), np.nan)
    stored = table.spectra.reflectance(
        np.arange(len(table.names)), data.sensor.wavelengths
    )
    return delta_e_spectra(light, stored, table.measured)
