"""Colours that a cube does not hold: outside its RGB space (docs/mathematics.md, 8), or
not in its scene.
"""

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import format_rgb
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import ColourError
from uplift.cube.data import CubeData, common_sensor
from uplift.cube.file import digest
from uplift.lattice.point_table import Status
from uplift.lookup.blocks import blockwise
from uplift.lookup.interpolate import MODES, coefficients, refined
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate, reflectance

MAPPING = "desaturate"
"""Gamut mapping to the colour from which the spectra of colours outside the RGB space
start.
"""
MIN_REFLECTANCE = 1e-6
"""Reflectances are clipped to this distance from 0 and 1, so that the linear part of
the model is finite.
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
        raise ColourError(
            (
                "no reflectance has the colour of XYZ "
                f"{format_rgb(data.sensor.xyz(rgb[int(possible.argmin())]))}"
            ),
            code="colour-unrealisable",
            hint=(
                "reduce its luminance, where white has Y = 1, or its distance from "
                "white"
            ),
        )
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
        raise ColourError(
            (
                "the model does not reach the colour of XYZ "
                f"{format_rgb(data.sensor.xyz(rgb[int(distance.argmax())]))}"
            ),
            code="colour-unrealisable",
            hint=(
                "move it toward white, away from the limit of what reflectances can "
                "have"
            ),
        )
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


def fill_missing(
    data: CubeData, points: Indices, other: CubeData, threads: int = 1
) -> CubeData:
    """Return the cube with absent nodes ``points`` (k,) fitted to the answers of
    another cube of the same RGB space.

    Their standard error is the largest of the cube, as their distance from measurements
    is unknown.
    """
    common_sensor([data, other])
    target = data.lattice.target(points)
    table = data.points
    multipliers = blockwise(
        partial(_fit_to_other, data, other), target, data.model.count, threads=threads
    )
    stored = data.model.to_storage(multipliers)
    for values in (stored.astype(table.coefficients.dtype), stored):
        rgb = data.sensor.rgb(reflectance(data.model, values, data.sensor.wavelengths))
        distance = np.abs(target - rgb).max(axis=1)
        if (distance <= data.threshold).all():
            break  # single precision is accurate enough
    rows: dict[str, NDArray[Any]] = {
        "coefficients": values,
        "rgb": rgb,
        "distance": distance,
    }
    rows["status"] = np.where(
        distance > data.threshold, Status.UNFITTED, Status.REGULAR
    )
    if table.standard_error is not None:
        rows["standard_error"] = np.full(len(points), table.standard_error.max())
    provenance = {
        **data.provenance,
        "filled": {"points": len(points), "cube": digest(other)},
    }
    return replace(data, provenance=provenance, points=table.filled(points, rows))


def _fit_to_other(data: CubeData, other: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) of the cube's model: close to the spectra of ``other``, with
    exactly the colours (n, 3).
    """
    spectra = refined(other, rgb, data.sensor.wavelengths)
    # min |B p − S⁻¹(g)|, and from this p by steps to the exact colour
    linear = data.model.from_reflectance(
        np.clip(spectra, MIN_REFLECTANCE, 1 - MIN_REFLECTANCE)
    )
    start = np.linalg.lstsq(
        data.model.basis(data.sensor.wavelengths), linear.T, rcond=None
    )[0].T
    return refine_to_rgb(data, data.model, np.ascontiguousarray(start), rgb)
