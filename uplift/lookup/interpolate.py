"""Interpolation of coefficients and spectra between nodes, in four modes
(docs/mathematics.md, 8). Needs numpy only.

spectra   weighted spectra of the nodes; exact colours, as RGB is linear in the spectrum
moments   weighted coefficients; one reconstruction instead of four
refined   ``moments``, then minimum-norm steps to the exact colour (section 5)
nearest   the spectrum of the node of largest weight, of another colour

Where nodes have not their own colours, answers of all modes but ``nearest`` are then
moved to theirs (section 9).

In the box of an entry all modes but ``nearest`` mix the answer of the lattice, where
the ray from the entry through the colour leaves the box, with the spectrum of the
entry. Spectra mix exactly; lattice and entry may have different numbers of
coefficients.

All of it in float64: the conversion from moments to multipliers amplifies rounding
errors.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from uplift.colorimetry.sensor import format_rgb
from uplift.common.arrays import Array, Mask
from uplift.common.errors import ColourError
from uplift.cube.data import CubeData
from uplift.lattice.entry_boxes import Nodes
from uplift.lattice.lattice import Lattice, weighted_sum
from uplift.lattice.point_table import PointTable
from uplift.lookup.refine import refine_to_rgb, with_colours
from uplift.models.model import Model, evaluate, reflectance

Mode = Callable[..., Array]
"""From a cube, linear RGB (n, 3) and wavelengths (N,) in nm to reflectance (n, N)."""


def around(data: CubeData, rgb: Array) -> Nodes:
    """Return the nodes around linear RGB (n, 3) in [0, 1]; `ColourError` if a sparse
    cube lacks one of them.
    """
    nodes = data.entry_boxes.nodes(rgb)
    if data.is_sparse:
        require_covered(data.points.holds(nodes.points), rgb)
    return nodes


def require_covered(covered: Mask, rgb: Array) -> None:
    """Raise `ColourError` for the first colour (n, 3) that is not covered (n,)."""
    if not covered.all():
        raise ColourError(
            (
                "the cube answers the colours of its scene only, got linear RGB "
                f"{format_rgb(rgb[int(covered.argmin())])}"
            ),
            code="colour-not-in-scene",
            hint=(
                "build the cube with this colour in its scene, or fill it with "
                "Cube.fill_missing"
            ),
        )


def exact(
    mix: Mode,
    share_of: Callable[[CubeData, Array], Array | Mask],
    data: CubeData,
    rgb: Array,
    wavelengths: Array,
) -> Array:
    """Reflectance (n, N) of a mixture, moved by a share to exact colours where nodes
    have not their own.
    """
    mixed = mix(data, rgb, wavelengths)
    if data.inexact_cells is None:
        return mixed
    share = share_of(data, rgb)
    rows = np.flatnonzero(share)
    if rows.size:
        weight = share[rows, None]
        at_sensor = mix(data, rgb[rows], data.sensor.wavelengths)
        moved = with_colours(data, mixed[rows], at_sensor, rgb[rows], wavelengths)
        mixed[rows] = (1 - weight) * mixed[rows] + weight * moved
    return mixed


def mixed_spectra(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) as weighted spectra Σ w · g of the nodes, whose colours are Σ
    w · RGB.
    """
    nodes = around(data, rgb)
    # Each node is evaluated once, although neighbouring colours share nodes.
    points, row = np.unique(nodes.points, return_inverse=True)
    values = evaluate(data.model, data.smoothed_multipliers(points), wavelengths)
    # g = Σ w g_i has the colour W g = Σ w W g_i = Σ w r_i = x, as the weights
    # reproduce x.
    lattice = weighted_sum(values, row.reshape(nodes.points.shape), nodes.weights)
    return _mix_entries(data, nodes, lattice, wavelengths)


def is_inexact(data: CubeData, rgb: Array) -> Mask:
    """Whether the nodes around linear RGB (n, 3) in [0, 1] do not all have their own
    colours.

    A wide-gamut lattice has corners of colours that no reflectance has, and stores
    other colours there. Mixtures of such corners miss the requested colour, although
    most colours of their cells are realisable.
    """
    if data.inexact_cells is None:
        return np.zeros(len(rgb), dtype=bool)
    return data.inexact_cells[data.entry_boxes.cell(rgb)]


def fading_share(data: CubeData, rgb: Array) -> Array:
    """Return the share (n,) by which weighted coefficients at linear RGB (n, 3) are
    moved.

    Weighted coefficients miss their colour in all cells. The share is 1 in cells with a
    node that has not its own colour, and falls to 0 across the cells around them, so
    that answers are continuous.
    """
    if data.inexact_corners is None:
        return np.zeros(len(rgb))
    nodes = around(data, rgb)
    return np.minimum(
        (data.inexact_corners[nodes.points] * nodes.weights).sum(axis=1), 1
    )


def mixed_moments(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients of the lattice, mixed with
    entries.
    """
    nodes = around(data, rgb)
    weighted = weighted_sum(data.points.coefficients, nodes.points, nodes.weights)
    lattice = reflectance(data.model, weighted, wavelengths)
    return _mix_entries(data, nodes, lattice, wavelengths)


def mixed_refined(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the weighted coefficients of the lattice and of entries,
    moved to their colours.
    """
    nodes = around(data, rgb)
    lattice = evaluate(data.model, _exact_lattice(data, nodes, rgb), wavelengths)
    multipliers = _exact_entries(data, nodes)
    entries = evaluate(data.atlas.spectra.model, multipliers, wavelengths)
    return nodes.hits.mix(lattice, entries)


def nearest(data: CubeData, rgb: Array, wavelengths: Array) -> Array:
    """Reflectance (n, N) of the node, or atlas entry, of largest weight."""
    points, rows, entry = around(data, rgb).nearest()
    values = reflectance(data.model, data.points.coefficients[points], wavelengths)
    if rows.size:
        values[rows] = data.atlas.spectra.reflectance(entry, wavelengths)
    return values


def lattice_spectra(
    model: Model, lattice: Lattice, points: PointTable, rgb: Array, wavelengths: Array
) -> Array:
    """Reflectance (n, N) as weighted spectra of a lattice alone, without entry
    boxes.
    """
    corners, weights = lattice.corners(rgb)
    nodes, row = np.unique(corners, return_inverse=True)
    values = reflectance(model, points.coefficients[nodes], wavelengths)
    return weighted_sum(values, row.reshape(corners.shape), weights)


spectra = partial(exact, mixed_spectra, is_inexact)
moments = partial(exact, mixed_moments, fading_share)
refined = partial(exact, mixed_refined, is_inexact)
MODES: dict[str, Mode] = {
    "spectra": spectra,
    "moments": moments,
    "refined": refined,
    "nearest": nearest,
}


def coefficients(data: CubeData, rgb: Array) -> Array:
    """Weighted coefficients (n, C) of the nodes around linear RGB (n, 3) in [0, 1], as
    `exact_coefficients`.
    """
    weighted = weighted_coefficients(data, rgb)
    return exact_coefficients(data, data.model, rgb, weighted, refined_multipliers)


def extended_coefficients(data: CubeData, rgb: Array) -> Array:
    """Weighted coefficients (n, K) of the nodes' spectra, as many as the entries have,
    as `exact_coefficients`.
    """
    nodes = around(data, rgb)
    points, row = np.unique(nodes.points, return_inverse=True)
    lattice = in_entry_model(data, data.points.coefficients[points])
    nodes = replace(nodes, points=row.reshape(nodes.points.shape))
    weighted = nodes.weighted_sum(lattice, data.atlas.spectra.coefficients)
    return exact_coefficients(
        data, data.atlas.spectra.model, rgb, weighted, extended_multipliers
    )


def exact_coefficients(
    data: CubeData,
    model: Model,
    rgb: Array,
    weighted: Array,
    multipliers: Callable[[CubeData, Array], Array],
) -> Array:
    """Move coefficients (n, K), where nodes have not their own colours, to those of
    exact ``multipliers``.
    """
    share = fading_share(data, rgb)
    rows = np.flatnonzero(share)
    if rows.size:
        weight = share[rows, None]
        moved = model.to_storage(multipliers(data, rgb[rows]))
        weighted[rows] = (1 - weight) * weighted[rows] + weight * moved
    return weighted


def weighted_coefficients(data: CubeData, rgb: Array) -> Array:
    """Weighted coefficients (n, C) of the nodes around linear RGB (n, 3) in [0, 1]."""
    return around(data, rgb).weighted_sum(
        data.points.coefficients, data.atlas.coefficients
    )


def in_entry_model(data: CubeData, coefficients: Array) -> Array:
    """Coefficients (m, K) in the model of the entries of the lattice spectra with
    coefficients (m, C).

    Multipliers followed by zeros are those of the same spectrum, which has more
    moments.
    """
    # B p is the same with zeros for further multipliers; the moments c_j = (1/π) ∫ g
    # cos jφ dφ of g follow for any j.
    multipliers = _append_zeros(data, data.model.from_storage(coefficients))
    extended = data.atlas.spectra.model.to_storage(multipliers)
    extended[:, : data.model.count] = coefficients
    return extended


def refined_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, C) that start from the weighted coefficients and have exactly the
    colours (n, 3).
    """
    start = data.model.from_storage(weighted_coefficients(data, rgb))
    return refine_to_rgb(data, data.model, start, rgb)


def extended_multipliers(data: CubeData, rgb: Array) -> Array:
    """Multipliers (n, K), as many as the entries have, with exactly the colours (n, 3).

    Outside entry boxes they have the spectra of mode ``refined``, inside the same
    coefficients.
    """
    nodes = around(data, rgb)
    model = data.atlas.spectra.model
    extended = _append_zeros(data, _exact_lattice(data, nodes, rgb))
    rows = nodes.hits.rows
    lattice = model.to_storage(extended[rows])
    entries = model.to_storage(_exact_entries(data, nodes))
    mixed = nodes.hits._replace(rows=np.arange(len(rows))).mix(lattice, entries)
    start = model.from_storage(mixed)
    extended[rows] = refine_to_rgb(data, model, start, rgb[rows])
    return extended


def node_errors(data: CubeData, rgb: Array) -> Array:
    """Standard errors and error bounds (n, 2) from those of the nodes, for a cube that
    has them.
    """
    nodes = around(data, rgb)
    factors = np.array([1, data.error_bound_factor])
    errors = np.asarray(data.points.standard_error, dtype=float)[:, None]
    entries = np.repeat(data.atlas.error[:, None], 2, axis=1)
    entries[data.atlas.measured_count :] *= factors  # errors of looks are expected ones
    lattice = weighted_sum(errors, nodes.points, nodes.weights) * factors
    return nodes.hits.mix(lattice, entries[nodes.hits.entry])


def _exact_lattice(data: CubeData, nodes: Nodes, rgb: Array) -> Array:
    """Multipliers (n, C) of the lattice that have exactly its share of the colours (n,
    3).
    """
    # The mean moments nearly have the mean colour: a step or two of Δx = A⁺ (t − r)
    # suffice (5).
    weighted = weighted_sum(data.points.coefficients, nodes.points, nodes.weights)
    start = data.model.from_storage(weighted)
    return refine_to_rgb(data, data.model, start, nodes.lattice_rgb(rgb))


def _exact_entries(data: CubeData, nodes: Nodes) -> Array:
    """Multipliers (k, K) of the entry of each colour in a box, that have exactly the
    colour of the entry.
    """
    entries, row = np.unique(nodes.hits.entry, return_inverse=True)
    spectra = data.atlas.spectra
    start = spectra.multipliers[entries]
    exact = refine_to_rgb(data, spectra.model, start, data.atlas.rgb[entries])
    return exact[row]


def _append_zeros(data: CubeData, multipliers: Array) -> Array:
    """Multipliers (m, K) in the model of the entries of the spectra with multipliers
    (m, C).
    """
    added = data.atlas.spectra.model.count - data.model.count
    return np.pad(multipliers, ((0, 0), (0, added)))


def _mix_entries(
    data: CubeData, nodes: Nodes, lattice: Array, wavelengths: Array
) -> Array:
    """Reflectance (n, N) of the lattice, mixed with the spectra of entries in their
    boxes.
    """
    if not nodes.hits.rows.size:
        return lattice
    entries, row = np.unique(nodes.hits.entry, return_inverse=True)
    values = data.atlas.spectra.reflectance(entries, wavelengths)
    return nodes.hits.mix(lattice, values[row])
