"""Nodes near entries keep gradients gentle."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tests.helpers import quiet_build
from uplift.colorimetry import observer
from uplift.fit.gradients import LARGEST_EXCESS, Steps, cells_near
from uplift.lattice.lattice import CORNERS
from uplift.lookup.cube import Cube
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
