"""Multipliers and spectra between lattice points, in four modes (docs/mathematics.md, 8). numpy alone.

spectra   the spectra of the nodes around, weighted: exact, as RGB is linear in the spectrum
moments   their coefficients, weighted: one reconstruction in place of eight
refined   ``moments``, then steps of least change to the very colour
nearest   the spectrum of the node of most weight: of another colour, as near as nodes are close

All of it in float64: on the way from moments to multipliers rounding grows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lattice import weighted_sum
from uplift.lookup.nodes import around
from uplift.lookup.refine import refine_to_rgb
from uplift.models import evaluate, reflectance


def coefficients(data: CubeData, rgb: Array) -> Array:
    """Coefficients (n, C) at linear RGB (n, 3) in [0, 1]: those of the nodes around, weighted."""
    return around(data, rgb).weighted_sum(data.points.coefficients, data.atlas.coefficients)


def standard_error(data: CubeData, rgb: Array) -> Array:
    """ΔE00 (n, 1) by which answers are expected to miss measurements, of a cube that can tell."""
    lattice = np.asarray(data.points.standard_error, dtype=float)
    return around(data, rgb).weighted_sum(lattice[:, None], data.atlas.error[:, None])


def spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as the weighted spectra of the nodes around."""
    nodes = around(data, rgb)
    points, point = np.unique(nodes.points, return_inverse=True)
    entries, entry = np.unique(nodes.entry, return_inverse=True)
    return replace(nodes, points=point.reshape(nodes.points.shape), entry=entry).weighted_sum(
        reflectance(data.model, data.points.coefficients[points], wavelengths),
        reflectance(data.model, data.atlas.coefficients[entries], wavelengths),
    )


def nearest(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the nearest node, lattice point or atlas entry."""
    return reflectance(
        data.model, around(data, rgb).nearest(data.points.coefficients, data.atlas.coefficients), wavelengths
    )


def lattice_spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) at linear RGB (n, 3) as the weighted spectra of the corners alone, entries aside."""
    points, weights = data.lattice.corners(rgb)
    used, place = np.unique(points, return_inverse=True)
    return weighted_sum(
        reflectance(data.model, data.points.coefficients[used], wavelengths),
        place.reshape(points.shape),
        weights,
    )


def moments(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the interpolated coefficients."""
    return reflectance(data.model, coefficients(data, rgb), wavelengths)


def refined(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the interpolated coefficients, moved to the colour asked for."""
    return evaluate(data.model, refined_multipliers(data, rgb), wavelengths)


def refined_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) that start at the interpolated coefficients and evaluate to ``rgb`` (n, 3)."""
    return refine_to_rgb(data, data.model.from_storage(coefficients(data, rgb)), rgb)


Mode = Callable[[CubeData, Array, Array], Array]

MODES: dict[str, Mode] = {"spectra": spectra, "moments": moments, "refined": refined, "nearest": nearest}
