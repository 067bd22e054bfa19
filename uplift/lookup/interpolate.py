"""Interpolate coefficients and spectra between nodes, in four modes (docs/mathematics.md, 8). Needs numpy only.

spectra   weighted spectra of the surrounding nodes; exact colours, as RGB is linear in the spectrum, and by steps where
          nodes are unrealisable (`uplift.lookup.exact`)
moments   weighted coefficients; one reconstruction instead of eight
refined   ``moments``, then minimum-norm steps to the exact colour
nearest   the spectrum of the node of largest weight, of another colour

In the box of an entry all modes but ``nearest`` mix the answer of the lattice, where the ray leaves the box, with the
spectrum of the entry. Spectra mix exactly; lattice and entry may have different numbers of coefficients.

All of it in float64: the conversion from moments to multipliers amplifies rounding errors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData
from uplift.lattice import weighted_sum
from uplift.lookup.exact import inexact_rows, with_colours
from uplift.lookup.nodes import Nodes, around
from uplift.lookup.refine import refine_to_rgb
from uplift.models import evaluate, reflectance


def coefficients(data: CubeData, rgb: Array) -> Array:
    """Weighted coefficients (n, C) of the nodes around linear RGB (n, 3) in [0, 1]."""
    return around(data, rgb).weighted_sum(data.points.coefficients, data.atlas.coefficients)


def extended_coefficients(data: CubeData, rgb: Array) -> Array:
    """Weighted coefficients (n, K) of the nodes' spectra, as many as the entries have."""
    nodes, points = _unique_points(around(data, rgb))
    lattice = extend_coefficients(data, data.points.coefficients[points])
    return nodes.weighted_sum(lattice, data.entry_spectra.coefficients)


def extend_coefficients(data: CubeData, coefficients: Array) -> Array:
    """Coefficients (m, K) in the model of the entries of the lattice spectra with coefficients (m, C)."""
    multipliers = data.model.from_storage(coefficients)
    extended = data.entry_spectra.model.to_storage(_append_zeros(data, multipliers))
    extended[:, : data.model.count] = coefficients
    return extended


def node_errors(data: CubeData, rgb: Array) -> Array:
    """Standard errors and error bounds (n, 2) from those of the nodes, for a cube that has them."""
    nodes, factors = around(data, rgb), np.array([1, data.error_bound_factor])
    errors = np.asarray(data.points.standard_error, dtype=float)[:, None]
    entries = np.repeat(data.atlas.error[:, None], 2, axis=1)
    entries[data.atlas.measured_count :] *= factors  # errors of looks are expected ones
    lattice = weighted_sum(errors, nodes.points, nodes.weights) * factors
    return nodes.mix(lattice, entries[nodes.entry])


def spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra of the nodes, moved to exact colours where nodes have not their own."""
    mixed = _mixed_spectra(data, rgb, wavelengths)
    rows = inexact_rows(data, rgb)
    if rows.size:
        at_sensor = _mixed_spectra(data, rgb[rows], data.sensor.wavelengths)
        mixed[rows] = with_colours(data, mixed[rows], at_sensor, rgb[rows], wavelengths)
    return mixed


def _mixed_spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra of the nodes."""
    nodes, points = _unique_points(around(data, rgb))
    values = reflectance(data.model, data.points.coefficients[points], wavelengths)
    return _mix_entries(data, nodes, weighted_sum(values, nodes.points, nodes.weights), wavelengths)


def nearest(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the nearest node, lattice point or atlas entry."""
    points, rows, entry = around(data, rgb).nearest()
    values = reflectance(data.model, data.points.coefficients[points], wavelengths)
    if rows.size:
        values[rows] = data.entry_spectra.reflectance(entry, wavelengths)
    return values


def lattice_spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra of the lattice alone, without entry boxes."""
    corners, weights = data.lattice.corners(rgb)
    points, row = np.unique(corners, return_inverse=True)
    values = reflectance(data.model, data.points.coefficients[points], wavelengths)
    return weighted_sum(values, row.reshape(corners.shape), weights)


def moments(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients of the lattice, mixed with entries."""
    nodes = around(data, rgb)
    lattice = reflectance(data.model, _lattice_coefficients(data, nodes), wavelengths)
    return _mix_entries(data, nodes, lattice, wavelengths)


def refined(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients of the lattice and of entries, moved to exact colours."""
    nodes = around(data, rgb)
    lattice = evaluate(data.model, _exact_lattice(data, nodes, rgb), wavelengths)
    if not nodes.rows.size:
        return lattice
    return nodes.mix(lattice, evaluate(data.entry_spectra.model, _exact_entries(data, nodes), wavelengths))


def refined_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) that start from the weighted coefficients and have exactly the colours (n, 3)."""
    return refine_to_rgb(data, data.model, data.model.from_storage(coefficients(data, rgb)), rgb)


def extended_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, K), as many as the entries have, with exactly the colours (n, 3).

    Outside entry boxes they have the spectra of mode ``refined``, inside the same coefficients.
    """
    nodes, model = around(data, rgb), data.entry_spectra.model
    extended = _append_zeros(data, _exact_lattice(data, nodes, rgb))
    if not nodes.rows.size:
        return extended
    inside = replace(nodes, rows=np.arange(len(nodes.rows)))
    mixed = inside.mix(model.to_storage(extended[nodes.rows]), model.to_storage(_exact_entries(data, nodes)))
    extended[nodes.rows] = refine_to_rgb(data, model, model.from_storage(mixed), rgb[nodes.rows])
    return extended


def _exact_lattice(data: CubeData, nodes: Nodes, rgb: Array) -> Array:
    """Multipliers (n, C) of the lattice that have exactly its share of the colours (n, 3)."""
    start = data.model.from_storage(_lattice_coefficients(data, nodes))
    return refine_to_rgb(data, data.model, start, nodes.lattice_rgb(rgb))


def _exact_entries(data: CubeData, nodes: Nodes) -> Array:
    """Multipliers (k, K) of the entry of each colour in a box, that have exactly the colour of the entry."""
    spectra, (entries, row) = data.entry_spectra, np.unique(nodes.entry, return_inverse=True)
    return refine_to_rgb(data, spectra.model, spectra.multipliers[entries], data.atlas.rgb[entries])[row]


def _append_zeros(data: CubeData, multipliers: Array) -> Array:
    """Multipliers (m, K) in the model of the entries of the spectra with multipliers (m, C)."""
    return np.pad(multipliers, ((0, 0), (0, data.entry_spectra.model.count - data.model.count)))


def _lattice_coefficients(data: CubeData, nodes: Nodes) -> Array:
    return weighted_sum(data.points.coefficients, nodes.points, nodes.weights)


def _unique_points(nodes: Nodes) -> tuple[Nodes, Indices]:
    """The nodes with rows of the returned lattice points (m,) in place of point numbers."""
    points, row = np.unique(nodes.points, return_inverse=True)
    return replace(nodes, points=row.reshape(nodes.points.shape)), points


def _mix_entries(data: CubeData, nodes: Nodes, lattice: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the lattice, mixed with the spectra of entries in their boxes."""
    if not nodes.rows.size:
        return lattice
    entries, row = np.unique(nodes.entry, return_inverse=True)
    return nodes.mix(lattice, data.entry_spectra.reflectance(entries, wavelengths)[row])


Mode = Callable[[CubeData, Array, Array], Array]

MODES: dict[str, Mode] = {"spectra": spectra, "moments": moments, "refined": refined, "nearest": nearest}
