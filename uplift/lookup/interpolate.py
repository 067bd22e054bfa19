"""Interpolate coefficients and spectra between nodes, in four modes (docs/mathematics.md, 8). Needs numpy only.

spectra   weighted spectra of the surrounding nodes; exact colours, as RGB is linear in the spectrum
moments   weighted coefficients; one reconstruction instead of eight
refined   ``moments``, then minimum-norm steps to the exact colour
nearest   the spectrum of the node of largest weight, of another colour

All of it in float64: the conversion from moments to multipliers amplifies rounding errors.
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
    """Weighted coefficients (n, C) of the nodes around linear RGB (n, 3) in [0, 1]."""
    return around(data, rgb).weighted_sum(data.points.coefficients, data.atlas.coefficients)


def standard_error(data: CubeData, rgb: Array) -> Array:
    """Expected ΔE00 (n, 1) between answers and measurements, for a cube with standard errors."""
    lattice = np.asarray(data.points.standard_error, dtype=float)
    return around(data, rgb).weighted_sum(lattice[:, None], data.atlas.error[:, None])


def spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra of the nodes."""
    nodes = around(data, rgb)
    points, point = np.unique(nodes.points, return_inverse=True)
    entries, entry = np.unique(nodes.entry, return_inverse=True)
    return replace(nodes, points=point.reshape(nodes.points.shape), entry=entry).weighted_sum(
        reflectance(data.model, data.points.coefficients[points], wavelengths),
        reflectance(data.model, data.atlas.coefficients[entries], wavelengths),
    )


def nearest(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the nearest node, lattice point or atlas entry."""
    found = around(data, rgb).nearest(data.points.coefficients, data.atlas.coefficients)
    return reflectance(data.model, found, wavelengths)


def lattice_spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra of the lattice alone, without entry boxes."""
    corners, weights = data.lattice.corners(rgb)
    points, row = np.unique(corners, return_inverse=True)
    values = reflectance(data.model, data.points.coefficients[points], wavelengths)
    return weighted_sum(values, row.reshape(corners.shape), weights)


def moments(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients."""
    return reflectance(data.model, coefficients(data, rgb), wavelengths)


def refined(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients, moved to the exact colour."""
    return evaluate(data.model, refined_multipliers(data, rgb), wavelengths)


def refined_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) that start from the weighted coefficients and have exactly the colours (n, 3)."""
    return refine_to_rgb(data, data.model.from_storage(coefficients(data, rgb)), rgb)


Mode = Callable[[CubeData, Array, Array], Array]

MODES: dict[str, Mode] = {"spectra": spectra, "moments": moments, "refined": refined, "nearest": nearest}
