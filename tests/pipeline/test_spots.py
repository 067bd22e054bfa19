"""No entry shows as a spot: the law of 8-bit ramps, on an atlas of mixed materials."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.materials import MIXTURE, materials
from tests.helpers import quiet_build, warns
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.extras.report.comparison import delta_e_under
from uplift.extras.texture.scene_colours import ColourSet
from uplift.lookup.cube import Cube

STEEP = (152, 78, 119)
"""Codes in a cell of the mixed atlas that would be steep."""
RAMP_LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
CODES = 14
"""Codes of a ramp to each side of an entry."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])


def steepest(cube):
    """Largest ΔE00 (E,) by which a light's step of an 8-bit code exceeds that of
    daylight, on ramps through each entry.
    """
    spectra = cube.reflectance(ramps(cube, cube.data.atlas.rgb))
    before = spectra[:, :, :-1].reshape(-1, spectra.shape[-1])
    after = spectra[:, :, 1:].reshape(-1, spectra.shape[-1])
    daylight = delta_e_spectra(observer.light("D65"), before, after)
    lights = [observer.light(name) for name in RAMP_LIGHTS]
    excess = delta_e_under(lights, before, after).max(axis=1) - daylight
    return excess.reshape(len(spectra), -1).max(axis=1)


def ramps(cube, rgb):
    """Linear RGB (n, D, 2 CODES + 1, 3) of ramps through colours (n, 3)."""
    codes = np.round(cube.encode(rgb))
    offsets = np.arange(-CODES, CODES + 1)[:, None] * DIRECTIONS[:, None]
    return cube.decode(np.clip(codes[:, None, None] + offsets, 0, 255))


@pytest.fixture(scope="module")
def warned():
    """The cube of mixed materials, and the warnings of its build."""
    with warns("entry-crowded", "entry-smoothed") as found:
        cube = uplift.build("cie2017", dim=32)
    return cube, " ".join(map(str, found))


@pytest.fixture(scope="module")
def mixed(warned) -> Cube:
    return warned[0]


@pytest.fixture(scope="module")
def exact() -> Cube:
    return quiet_build("cie2017", dim=32, exact_entries=True)


def test_no_light_steps_by_one_more_than_daylight():
    cube = quiet_build(materials(MIXTURE).atlas, dim=32)
    assert steepest(cube).max() <= 1


def test_exact_entries_show_as_spots_and_others_do_not(mixed, exact):
    assert steepest(mixed).max() <= 1 < steepest(exact).max()


def test_entries_that_contradict_their_surroundings_are_named(warned, exact):
    """They keep a share of their spectra, and the table states what they miss."""
    mixed, warnings = warned
    shares = mixed.data.provenance["smoothed"]
    assert min(shares, key=shares.get) in warnings
    table = mixed.data.atlas
    smoothed = np.isin(table.names, list(shares))
    assert 0 < smoothed.sum() < len(table.names) / 4
    without = exact.data.atlas.error
    assert (table.error > without)[smoothed].mean() > 0.8
    assert_allclose(table.error[~smoothed], without[~smoothed], atol=1e-9)
    light = observer.light(mixed.data.error_illuminant)
    answers = mixed.reflectance(table.rgb)
    measured = delta_e_spectra(light, answers, table.measured)
    assert_allclose(table.error, measured, atol=1e-3)


def test_sparse_cubes_answer_as_whole_ones(mixed):
    """Also in a cell whose nodes have moved towards neighbours."""
    table = mixed.data.atlas
    smoothed = np.isin(table.names, list(mixed.data.provenance["smoothed"]))
    rgb = np.concatenate([table.rgb[smoothed][:3], mixed.decode([STEEP])])
    sparse = quiet_build("cie2017", dim=32, scene=ColourSet(rgb))
    assert_allclose(sparse.reflectance(rgb), mixed.reflectance(rgb), atol=1e-6)
