"""Stacked equations of a palette, M x ≈ y, where x holds free colours and spectra, and
their solution.

Colours are weighted by 1/√3 and smoothness by 1/(√rows ‖(−1, 2, −1)‖), so that weights
of 1 are comparable. Bergner, Möller & Drew 2004, sections 3.2–3.3, eq. 18–24; but
differences are scaled as for samples 10 nm apart, and none extends beyond the ends.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise, product, starmap

import numpy as np

from uplift.common.arrays import Array, Indices
from uplift.common.machine import single_threaded_blas
from uplift.extras.looks.bounded_least_squares import solve_bounded
from uplift.extras.papers.palette.colours import screen_matrix
from uplift.extras.papers.palette.factor import FactorModel
from uplift.extras.papers.palette.palette import Palette, SpectrumSpec

SPACING = 10.0  # sample distance in nm that the weights of the paper refer to

# positions in x by kind ("free", "light" or "material") and name
Unknowns = dict[tuple[str, str], slice]


@dataclass(frozen=True, eq=False)
class Rows:
    """Some equations: blocks (r, k) with their positions in x, and values (r,)."""

    blocks: tuple[tuple[slice, Array], ...]
    values: Array


@dataclass(frozen=True, eq=False)
class Equations:
    """Matrix (rows, n), values (rows,), and bounds low, high (n,) of x."""

    matrix: Array
    values: Array
    low: Array
    high: Array


def unknowns(palette: Palette) -> Unknowns:
    """Return the positions of all unknowns: first free colours, then designed spectra
    (eq. 24).
    """
    samples = len(palette.sensor.wavelengths)
    sizes = {("free", name): 3 for name in palette.free}
    sizes |= {("light", spec.name): samples for spec in palette.lights if spec.designed}
    sizes |= {
        ("material", spec.name): samples for spec in palette.materials if spec.designed
    }
    ends = np.cumsum([0, *sizes.values()])
    return dict(zip(sizes, starmap(slice, pairwise(ends.tolist())), strict=True))


def equations(palette: Palette, model: FactorModel) -> Equations:
    """Stack all criteria of non-zero weight (eq. 22), with the bounds of
    the unknowns.
    """
    where = unknowns(palette)
    rows = [
        *_colours(palette, model, where),
        *_smoothness(palette, where),
        *_model_error(palette, model, where),
    ]
    count = max((position.stop for position in where.values()), default=0)
    matrix = np.zeros((sum(len(block_rows.values) for block_rows in rows), count))
    values = (
        np.concatenate([block_rows.values for block_rows in rows])
        if rows
        else np.zeros(0)
    )
    top = 0
    for block_rows in rows:
        for position, block in block_rows.blocks:
            matrix[top : top + len(block_rows.values), position] = block
        top += len(block_rows.values)
    low = np.empty(count)
    high = np.empty(count)
    specs = {("light", spec.name): spec for spec in palette.lights}
    specs |= {("material", spec.name): spec for spec in palette.materials}
    for key, position in where.items():
        low[position], high[position] = (
            palette.free[key[1]]
            if key[0] == "free"
            else (specs[key].low, specs[key].high)
        )
    return Equations(matrix, values, low, high)


def solve(given: Equations) -> Array:
    """Minimise ‖M x − y‖ within the bounds, x (n,).

    Without bounds the pseudo-inverse gives the minimum of least norm. Independent
    blocks are solved one by one.
    """
    x = np.zeros(given.matrix.shape[1])
    for rows, columns in _independent_blocks(given.matrix):
        matrix = given.matrix[np.ix_(rows, columns)]
        values = given.values[rows]
        low = given.low[columns]
        high = given.high[columns]
        if len(values) and np.isfinite([low, high]).any():
            x[columns] = solve_bounded(matrix, values, low, high)
        else:
            with single_threaded_blas():
                x[columns] = np.linalg.lstsq(matrix, values, rcond=None)[0]
    return np.clip(x, given.low, given.high)


def _independent_blocks(matrix: Array) -> Iterator[tuple[Indices, Indices]]:
    """Rows and columns of each block of M that shares no entry with the others."""
    from scipy.sparse import block_array, csr_array
    from scipy.sparse.csgraph import connected_components

    entries = csr_array(matrix != 0)
    rows = matrix.shape[0]
    count, labels = connected_components(
        block_array([[None, entries], [entries.T, None]]), directed=False
    )
    for label in range(count):
        yield (
            np.flatnonzero(labels[:rows] == label),
            np.flatnonzero(labels[rows:] == label),
        )


def _colours(palette: Palette, model: FactorModel, where: Unknowns) -> Iterator[Rows]:
    """Target colours (eq. 18, or 19 in the factor model), and free ones, which are
    unknowns too (eq. 24).
    """
    for goal in palette.goals:
        material = palette.material(goal.material)
        light = palette.light(goal.light)
        weight = goal.weight / np.sqrt(3)
        blocks = []
        target = np.zeros(3) if goal.rgb is None else goal.rgb
        for key, by_spectra, by_model in _colour_maps(palette, model, material, light):
            block = by_model if palette.fit == "factor-model" else by_spectra
            if key in where:
                blocks.append((where[key], weight * block))
            elif material.samples is not None:
                target = target - block @ material.samples
        if goal.free is not None:
            blocks.append((where["free", goal.free], -weight * np.eye(3)))
        if goal.weight and blocks:
            yield Rows(tuple(blocks), weight * target)


def _smoothness(palette: Palette, where: Unknowns) -> Iterator[Rows]:
    """Second differences of every designed spectrum (eq. 21)."""
    if not palette.smoothness:
        return
    wavelengths = palette.sensor.wavelengths
    count = len(wavelengths) - 2
    differences = -np.diff(np.eye(len(wavelengths)), 2, axis=0) / (
        np.sqrt(count) * np.sqrt(6)
    )
    step = wavelengths[1] - wavelengths[0]
    block = palette.smoothness * (SPACING / step) ** 2 * differences
    for (kind, _), position in where.items():
        if kind != "free":
            yield Rows(((position, block),), np.zeros(count))


def _model_error(
    palette: Palette, model: FactorModel, where: Unknowns
) -> Iterator[Rows]:
    """Colours of the factor model less those of full spectra, for every product with a
    designed spectrum (eq. 20).
    """
    weight = palette.model_error / np.sqrt(3)
    for material, light in product(palette.materials, palette.lights) if weight else ():
        for key, by_spectra, by_model in _colour_maps(palette, model, material, light):
            if key in where:
                yield Rows(
                    ((where[key], weight * (by_spectra - by_model)),), np.zeros(3)
                )


def _colour_maps(
    palette: Palette, model: FactorModel, material: SpectrumSpec, light: SpectrumSpec
) -> Iterator[tuple[tuple[str, str], Array, Array]]:
    """Yield the kind and name of a spectrum, and the matrices (3, N) from it to its
    colour with the given other one.

    The first matrix is by full spectra, the second by the factor model. There are none
    if neither spectrum is given.
    """
    screen = screen_matrix(palette.sensor)
    if (power := light.samples) is not None:
        yield (
            ("material", material.name),
            screen * power,
            model.matrix * model.light(power) @ model.projection,
        )
    elif (values := material.samples) is not None:
        yield (
            ("light", light.name),
            screen * values,
            model.matrix * model.reflectance(values) @ model.light_projection,
        )
