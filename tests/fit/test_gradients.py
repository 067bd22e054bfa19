"""Nodes near entries keep gradients gentle: fast steps, compared with plain ones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import quiet_build
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, lab
from uplift.fit.gradients import DIRECTIONS, LARGEST_EXCESS, Steps, cells_near
from uplift.lattice.lattice import CORNERS
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import lattice_spectra
from uplift.models.model import reflectance
from uplift.pipeline.spots import SPIKY

ATLAS = "cie2017"
LIGHTS = tuple(map(observer.light, ("D65", "A", "FL11", SPIKY)))


@pytest.fixture(scope="module")
def steep() -> Cube:
    return quiet_build(ATLAS, dim=32, exact_entries=True)


@pytest.fixture(scope="module")
def gentle() -> Cube:
    return quiet_build(ATLAS, dim=32)


def steps_of(cube):
    """The steps of a cube, its cells near entries, and the colours of their corners."""
    data = cube.data
    lattice = data.lattice
    steps = Steps(lattice, data.sensor, LIGHTS)
    cells = np.flatnonzero(cells_near(lattice, data.sensor, data.atlas.rgb))
    coefficients = data.points.coefficients
    spectra = reflectance(data.model, coefficients, data.sensor.wavelengths)
    corners = cells[:, None] + lattice.index(CORNERS)
    return steps, cells, steps.colours(spectra)[corners]


def plain_excess(cube, cell):
    """The largest excess of a step in a cell, one step after another."""
    lattice = cube.data.lattice
    low = lattice.position(cell)
    codes = cube.encode(lattice.nodes)
    largest = -np.inf
    for corner in CORNERS:
        for direction in DIRECTIONS:
            first = codes[low + corner] - direction * corner
            rgb = cube.decode(np.array([first, first + direction]))
            spectra = lattice_spectra(
                cube.data.model,
                cube.data.lattice,
                cube.data.points,
                rgb,
                cube.data.sensor.wavelengths,
            )
            by_light = [delta_e_spectra(light, *spectra) for light in LIGHTS]
            largest = max(largest, max(by_light[1:]) - by_light[0])
    return largest


def test_steps_are_those_of_gradients(steep):
    steps, cells, colours = steps_of(steep)
    rows = np.random.default_rng(1).choice(len(cells), 12, replace=False)
    excess = steps.excess(cells[rows], colours[rows])
    plain = [plain_excess(steep, cell) for cell in cells[rows]]
    assert_allclose(excess, plain, atol=1e-3)


def test_no_steep_cell_is_overlooked(steep):
    steps, cells, colours = steps_of(steep)
    excess = steps.excess(cells, colours)
    may = steps.may_exceed(cells, lab(colours, np.ones(3)).transpose(3, 2, 1, 0))
    assert (excess > LARGEST_EXCESS).any()
    assert may[excess > LARGEST_EXCESS].all()
    assert may.mean() < 0.1


def test_gradients_near_entries_are_gentle(steep, gentle):
    steps, cells, colours = steps_of(gentle)
    assert steps.excess(cells, colours).max() <= LARGEST_EXCESS
    before, after = steep.data.points, gentle.data.points
    moved = (before.coefficients != after.coefficients).any(axis=1)
    assert 0 < moved.sum() <= gentle.data.provenance["softened"] < 100
    assert_array_equal(before.rgb[~moved], after.rgb[~moved])
    assert after.distance.max() <= gentle.data.threshold


@pytest.mark.parametrize(
    "options",
    [
        {"exact_entries": True},
        {"seed_corners": True},
        {"neutral": "flat"},
        {"space": "ACEScg"},
        {"atlas": "macbeth"},
    ],
)
def test_other_cubes_stay_as_fitted(options):
    atlas = options.pop("atlas", ATLAS)
    cube = quiet_build(atlas, dim=16, **options)
    assert cube.data.provenance["softened"] == 0
