"""Seeds: nearest nodes and corners in any order of the atlas, starts between entries
and prior, and the size of lattice that an atlas needs.

Cells of the lattice of 6³ are 20 to 60 ΔE*ab long, so that corners are far from their
entries; those of 64³ are near.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_array_equal

import uplift
from tests.conftest import MACBETH
from tests.helpers import quiet_build
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.fit.base import learn_base
from uplift.fit.prior import Prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import (
    DIMS,
    seed,
)
from uplift.lattice.lattice import AXES, Lattice
from uplift.lookup.interpolate import lattice_spectra
from uplift.models.model import reflectance
from uplift.models.moments import Moments

LATTICE = Lattice(np.linspace(0, 1, 6))
atlases = arrays(
    float,
    st.tuples(st.integers(1, 12), st.just(3)),
    elements=st.floats(0, 1),
    unique=True,
)


@given(atlases)
def test_all_corners_of_the_cells_of_entries_are_seeds_once(rgb):
    corners = LATTICE.cell_corners(LATTICE.cell(rgb)[0])
    assert_array_equal(np.sort(seed(LATTICE, rgb).points), np.unique(corners))


def test_the_nearer_of_two_entries_owns_the_primary_point():
    rgb = np.array([[0.45, 0.4, 0.4], [0.41, 0.4, 0.4]])
    seeds = seed(LATTICE, rgb)
    assert seeds.crowded == (0,)
    assert seeds.entry[seeds.primary].tolist() == [1]


MODEL = Moments(5)
RGB = np.array([[0.33, 0.5, 0.71], [0.42, 0.42, 0.42]])
ENTRIES = np.random.default_rng(0).normal(size=(2, 5)) / 3


@pytest.fixture(scope="module")
def prior(sensor):
    return Prior(MODEL, sensor, learn_base(Problem(sensor, MODEL))[0])


def lattice_errors(data):
    """Largest ΔE00 between entries and the lattice at their colours, boxes left out."""
    at = data.sensor.wavelengths
    found = lattice_spectra(data.model, data.lattice, data.points, data.atlas.rgb, at)
    own = reflectance(data.model, data.atlas.coefficients, at)
    lights = map(observer.light, SCENE_LIGHTS)
    return np.max([delta_e_spectra(light, found, own) for light in lights], axis=0)


def test_the_smallest_lattice_that_keeps_all_entries_is_chosen():
    options = {"seed_corners": True, "exact_entries": True}
    chosen = quiet_build(MACBETH, dim="auto", **options).data
    assert lattice_errors(chosen).max() <= 0.5
    dim = DIMS[DIMS.index(chosen.lattice.dim) - 1]
    for axis in AXES:
        smaller = quiet_build(MACBETH, dim=dim, axis=axis, **options).data
        assert lattice_errors(smaller).max() > 0.5


def test_without_an_atlas_the_smallest_lattice_is_chosen():
    assert uplift.build(dim="auto").data.lattice.dim == DIMS[0]
