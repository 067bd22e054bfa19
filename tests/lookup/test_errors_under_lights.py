"""Standard errors under any light: calibrated on materials that the cube
does not know.
"""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import ATLASES
from tests.helpers import quiet_build, raises, without_evidence
from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, lab
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError, UnknownNameError
from uplift.extras.looks.lab_errors import LIKELY, lab_errors
from uplift.lookup.cube import Cube

LIGHTS = [observer.light(name) for name in ("FL2", "FL11", "LED-RGB1", "HP1")]
"""Two of them are not among the lights that entries are fitted to."""
SHARES = (0.68, 0.95, LIKELY)
"""Within the standard error, the bound, and the likely region of a* and b*."""


@pytest.fixture(scope="module", params=["rawtoaces", "cie2017"])
def halves(request, sensor):
    """Cubes of each half of an atlas, and linear RGB and spectra of the other half."""
    atlas = read_atlas(ATLASES / f"{request.param}.txt")
    measured = resample(atlas, sensor.wavelengths).values
    rows = np.flatnonzero(in_unit_cube(sensor.rgb(measured)))
    split = np.array_split(np.random.default_rng(0).permutation(rows), 2)
    parts = []
    for kept, other in (split, split[::-1]):
        half = Atlas(tuple(atlas.entries[row] for row in kept))
        cube = quiet_build(half, dim=12, leave_out=[request.param])
        rgb = np.clip(sensor.rgb(measured[other]), 0, 1)
        parts.append((cube, rgb, measured[other]))
    return parts


def covered(halves, light):
    """Shares (3) of the other halves."""
    within = []
    for cube, rgb, measured in halves:
        found = cube.reflectance(rgb)
        missed = delta_e_spectra(light, found, measured)
        lab_measured, lab_found = (
            lab(spectra @ light.xyz.T, light.white) for spectra in (measured, found)
        )
        difference = (lab_measured - lab_found)[:, 1:, None]
        errors = lab_errors(cube.data, light)
        covariance = errors.covariance(rgb)[:, 1:, 1:]
        assert (np.linalg.eigvalsh(covariance) > 0).all()
        squares = difference.mT @ np.linalg.solve(covariance, difference)
        within.append(
            [
                missed <= cube.standard_error(rgb, light),
                missed <= cube.error_bound(rgb, light),
                squares.ravel() <= errors.likely_radius**2,
            ]
        )
    return np.concatenate(within, axis=1).mean(axis=1)


def test_other_halves_are_covered_under_every_light(halves):
    off = np.array([covered(halves, light) for light in LIGHTS]) - SHARES
    assert (np.abs(off.mean(axis=0)) <= (0.05, 0.03, 0.03)).all()
    assert (np.abs(off).max(axis=0) <= (0.12, 0.06, 0.06)).all()


def test_an_entry_has_its_own_error(small_cube):
    table = small_cube.data.atlas
    assert_allclose(small_cube.standard_error(table.rgb), table.error, atol=1e-12)
    light = observer.light("FL11")
    own = delta_e_spectra(light, small_cube.reflectance(table.rgb), table.measured)
    assert_allclose(small_cube.standard_error(table.rgb, light), own, atol=1e-6)


def test_colours_far_from_all_entries_are_unlike_the_atlas(small_cube, plain_cube):
    assert not small_cube.unlike_atlas(small_cube.data.atlas.rgb).any()
    for cube in (small_cube, plain_cube):
        far = cube.unlike_atlas([[0, 1, 0], [0.2, 0.2, 0.2]])
        assert far.tolist() == [True, False]
    assert without_evidence(plain_cube).unlike_atlas([0.2, 0.2, 0.2])


def test_cubes_without_evidence_have_errors_under_their_own_light_or_none(
    small_cube, plain_cube
):
    rgb = [0.2, 0.3, 0.4]
    with raises(UnknownNameError, "unknown-name"):
        small_cube.standard_error(rgb, "FL99")
    atlas = replace(small_cube.data.atlas, measured=None, left_out=None)
    old = Cube(replace(small_cube.data, atlas=atlas, provenance={}))
    assert old.standard_error(rgb) == small_cube.standard_error(rgb)
    assert old.error_bound(rgb) == 2 * old.standard_error(rgb)
    with raises(OptionError, "too-few-entries"):
        old.standard_error(rgb, "FL11")
    with raises(OptionError, "too-few-entries"):
        lab_errors(old.data, LIGHTS[0])
    none = without_evidence(plain_cube)
    assert none.standard_error(rgb, "FL11") is none.error_bound(rgb, "FL11") is None
