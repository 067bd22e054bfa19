"""No entry shows as a spot: the law of 8-bit ramps, on an atlas of mixed materials."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import MACBETH
from tests.helpers import quiet_build, warns
from uplift.colorimetry import delta_e_spectra, observer
from uplift.extras.texture.scene_colours import ColourSet
from uplift.lookup import Cube

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
CODES = 14
"""Codes of a ramp to each side of an entry."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])


def steepest(cube: Cube) -> float:
    """The largest ΔE00 by which a light's step of a code through an entry exceeds that
    of daylight.
    """
    codes = np.round(cube.encode(cube.data.atlas.rgb))
    offsets = np.arange(-CODES, CODES + 1)[:, None] * DIRECTIONS[:, None]
    ramps = np.clip(codes[:, None, None] + offsets, 0, 255)
    spectra = cube.reflectance(cube.decode(ramps))
    before = spectra[:, :, :-1].reshape(-1, spectra.shape[-1])
    after = spectra[:, :, 1:].reshape(-1, spectra.shape[-1])
    daylight = delta_e_spectra(observer.light("D65"), before, after)
    lights = map(observer.light, LIGHTS)
    steps = [delta_e_spectra(light, before, after) for light in lights]
    return float((np.max(steps, axis=0) - daylight).max())


@pytest.fixture(scope="module")
def mixed() -> Cube:
    return quiet_build("cie2017", dim=32)


def test_no_light_steps_by_one_more_than_daylight(mixed):
    assert steepest(mixed) <= 1
    assert steepest(quiet_build("cie2017", dim=32, exact_entries=True)) > 1


def test_entries_that_contradict_their_surroundings_are_named(mixed):
    """They keep a share of their spectra, and the table states what they miss."""
    with warns("entry-crowded", "entry-smoothed") as found:
        again = uplift.build("cie2017", dim=32)
    shares = again.data.provenance["smoothed"]
    assert shares == mixed.data.provenance["smoothed"]
    assert min(shares, key=shares.get) in " ".join(map(str, found))
    table = mixed.data.atlas
    smoothed = np.isin(table.names, list(shares))
    assert 0 < smoothed.sum() < len(table.names) / 4
    assert table.error[smoothed].min() > table.error[~smoothed].max()
    light = observer.light(mixed.data.error_illuminant)
    answers = mixed.reflectance(table.rgb)
    measured = delta_e_spectra(light, answers, table.measured)
    assert_allclose(table.error, measured, atol=1e-3)


def test_entries_that_agree_are_exact(macbeth_cube):
    assert macbeth_cube.data.provenance["smoothed"] == {}
    exact = quiet_build(MACBETH, dim=32, debug=True, exact_entries=True)
    rgb = macbeth_cube.data.atlas.rgb
    assert_allclose(macbeth_cube.reflectance(rgb), exact.reflectance(rgb), atol=1e-12)


def test_sparse_cubes_answer_as_whole_ones(mixed):
    table = mixed.data.atlas
    smoothed = np.isin(table.names, list(mixed.data.provenance["smoothed"]))
    rgb = table.rgb[smoothed][:3]
    sparse = quiet_build("cie2017", dim=32, scene=ColourSet(rgb))
    assert_allclose(sparse.reflectance(rgb), mixed.reflectance(rgb), atol=1e-6)
