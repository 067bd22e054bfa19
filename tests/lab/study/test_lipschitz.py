"""Lipschitz constants of a cube: never exceeded, and attained."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from uplift.lab.study.lipschitz import _cuts, lipschitz_constants, spectral_norms
from uplift.lattice import CORNERS
from uplift.lookup.interpolate import lattice_spectra

RNG = np.random.default_rng(6)


@pytest.fixture(scope="module")
def steep(small_cube):
    return lipschitz_constants(small_cube.data)


def quotient(first, second, before, after):
    """Change of spectra (n, N), rms over wavelength, per unit of change of colours (n, 3)."""
    return np.sqrt(((after - before) ** 2).mean(axis=1)) / np.linalg.norm(second - first, axis=1)


def test_no_pair_of_colours_exceeds_the_constant(small_cube, steep):
    # As many colours in each cell of the axis, so that some are in the steepest.
    first = small_cube.decode(255 * RNG.random((3000, 3)))
    for size in (1.0, 1e-2, 1e-5):
        second = np.clip(first + size * RNG.normal(size=first.shape), 0, 1)
        quotients = quotient(first, second, small_cube.reflectance(first), small_cube.reflectance(second))
        assert quotients.max() <= steep.largest * (1 + 1e-6)
        assert quotients.max() > 0.1 * steep.largest or size == 1.0


def test_constant_is_attained_in_the_steepest_cell(small_cube, steep):
    data = small_cube.data
    nodes = data.lattice.nodes
    low = np.array(np.unravel_index(steep.cells.argmax(), steep.cells.shape))
    inward = 1 - 2 * CORNERS
    corners = nodes[low + CORNERS]
    sides = nodes[low + 1] - nodes[low]
    directions = RNG.normal(size=(400, 3))
    directions = np.concatenate([np.abs(directions), np.eye(3)])
    best = 0.0
    for corner, sign in zip(corners, inward, strict=True):
        for mirror in ((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)):
            step = 1e-4 * sides.min() * directions * mirror
            start = corner + sign * 1e-3 * sides
            before = lattice_spectra(data, start[None], data.sensor.wavelengths)
            after = lattice_spectra(data, start + step, data.sensor.wavelengths)
            best = max(best, quotient(start, start + step, before, after).max())
    assert best == pytest.approx(steep.cells.max(), rel=0.01)


def test_constant_of_a_box_is_attained(small_cube, steep):
    """Near the rays from the entry to all corners of the patches on its box, in random directions."""
    data = small_cube.data
    entry = steep.boxes.argmax()
    low, high = (face[entry] for face in data.entry_boxes.faces)
    middle = data.atlas.rgb[entry]
    cuts = [_cuts(data.lattice.nodes, low[axis], high[axis]) for axis in range(3)]
    corners = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    nearby = corners + 1e-3 * (high - low) * RNG.normal(size=(len(corners), 200, 3))
    first = (middle + 0.5 * (nearby - middle)).reshape(-1, 3)
    second = first + 1e-5 * (high - low).min() * RNG.normal(size=first.shape)
    quotients = quotient(first, second, small_cube.reflectance(first), small_cube.reflectance(second))
    assert 0.9 * steep.boxes[entry] < quotients.max() <= steep.boxes[entry] * (1 + 1e-4)


def test_constants_per_code_follow_the_transfer_curve(plain_cube):
    """The ratio lies between the slopes of the curve, and equals the last slope in the last cell."""
    data = plain_cube.data
    steep = lipschitz_constants(data)
    slope = np.diff(data.sensor.decoding)
    ratio = steep.codes / steep.cells
    assert ratio.min() >= slope.min() * (1 - 1e-9)
    assert ratio.max() <= slope.max() * (1 + 1e-9)
    assert ratio[-1, -1, -1] == pytest.approx(slope[-1], rel=1e-6)
    assert steep.boxes.size == 0
    assert steep.largest == steep.cells.max()


def test_spectral_norms_equal_numpy():
    columns = RNG.normal(size=(5, 3, 20))
    expected = [np.linalg.norm(one, 2) / np.sqrt(20) for one in columns]
    np.testing.assert_allclose(spectral_norms(columns), expected)


@pytest.mark.parametrize("axis", range(3))
def test_answers_agree_on_the_face_between_two_cells(small_cube, axis):
    data = small_cube.data
    low = RNG.integers(0, data.lattice.dim - 2, (200, 3))
    fraction = RNG.random((200, 3))
    spectra = uplift.models.reflectance(data.model, data.points.coefficients, data.sensor.wavelengths)

    def answer(low, fraction):
        points, weights = data.lattice.cell_corners(low, fraction)
        return np.einsum("nk,nkw->nw", weights, spectra[points])

    below, above = fraction.copy(), fraction.copy()
    below[:, axis], above[:, axis] = 1, 0
    np.testing.assert_allclose(answer(low, below), answer(low + np.eye(3, dtype=int)[axis], above), atol=1e-15)


def test_answers_agree_on_both_sides_of_the_face_of_a_box(small_cube, steep):
    """The answer within the box meets the lattice at the faces."""
    data = small_cube.data
    low, high = data.entry_boxes.faces
    entry = np.flatnonzero(data.atlas.half_width)
    middle = data.atlas.rgb[entry]
    for sign in (1, -1):
        face = np.where(sign > 0, high[entry], low[entry])
        inside = middle + 0.4 * (face - middle)
        inside[:, 0] = face[:, 0] - sign * 1e-9
        outside = inside.copy()
        outside[:, 0] = np.clip(face[:, 0] + sign * 1e-9, 0, 1)
        moved = np.abs(small_cube.reflectance(outside) - small_cube.reflectance(inside)).max()
        assert moved <= 2e-9 * steep.largest * np.sqrt(81)
