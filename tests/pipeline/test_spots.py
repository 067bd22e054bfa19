"""No entry shows as a spot: the law of 8-bit ramps, on atlases that contradict
themselves.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import MACBETH, quiet_build
from tests.helpers import warns
from uplift.atlas import Atlas, Entry, read_atlas
from uplift.colorimetry import delta_e_spectra, observer
from uplift.pipeline.spots import LARGEST_STEP

LIGHTS = ("A", "FL2", "FL11", "LED-B3", "HP1")
REACH = 14
"""Codes of a ramp to each side of an entry."""
DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]])


def metamers(sensor, count=40, seed=3):
    """An atlas of greys and near-greys with random metameric differences."""
    random = np.random.default_rng(seed)
    wavelengths = sensor.wavelengths
    level = random.uniform(0.3, 0.6, (count, 1))
    tint = random.uniform(-0.04, 0.04, (count, 3)) @ sensor.matrix
    place = random.uniform(400, 700, (count, 1))
    waves = 0.2 * np.cos((wavelengths - place) / random.uniform(15, 40, (count, 1)))
    black = waves - waves @ np.linalg.pinv(sensor.matrix) @ sensor.matrix
    values = np.clip(level + tint + black, 0.01, 0.99)
    entries = [
        Entry(f"metamer {row}", wavelengths, spectrum)
        for row, spectrum in enumerate(values)
    ]
    return Atlas(tuple(entries))


def steepest(cube):
    """The largest ΔE00 by which a step of a code through an entry exceeds that under
    D65.
    """
    codes = np.round(cube.encode(cube.data.atlas.rgb))
    offsets = np.arange(-REACH, REACH + 1)[:, None] * DIRECTIONS[:, None]
    ramps = np.clip(codes[:, None, None] + offsets, 0, 255)
    spectra = cube.reflectance(cube.decode(ramps))
    before, after = spectra[:, :, :-1], spectra[:, :, 1:]
    steps = {
        name: delta_e_spectra(
            observer.light(name), before.reshape(-1, 81), after.reshape(-1, 81)
        )
        for name in ("D65", *LIGHTS)
    }
    return max((steps[name] - steps["D65"]).max() for name in LIGHTS)


@pytest.fixture(scope="module")
def contradictory(sensor):
    return metamers(sensor)


def test_no_light_steps_by_one_more_than_daylight(contradictory):
    with warns("entry-smoothed"):
        cube = quiet_build_with_warnings(contradictory)
    assert steepest(cube) <= 1
    shares = cube.data.provenance["smoothed"]
    assert 0 < len(shares) <= len(contradictory.entries)
    assert all(0 < share < 1 for share in shares.values())
