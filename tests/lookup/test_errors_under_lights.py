"""Standard errors under any light: calibrated on materials that the cube
does not know.
"""

import dataclasses
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.conftest import ATLASES
from tests.helpers import raises, without_evidence
from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, lab
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import OptionError, UnknownNameError
from uplift.cube.file import read, write
from uplift.extras.looks.lab_errors import LIKELY, lab_errors
from uplift.extras.report.measures import check_calibration
from uplift.lookup.cube import Cube

LIGHTS = [observer.light(name) for name in ("FL2", "FL11", "LED-RGB1", "HP1")]
"""Two of them are not among the lights that entries are fitted to."""
SPLITS = 2


@pytest.fixture(scope="module", params=["rawtoaces", "cie2017"])
def halves(request, sensor):
    """Cubes of halves of an atlas, and the measured reflectances of the other halves,
    in both directions.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        atlas = read_atlas(ATLASES / f"{request.param}.txt")
        measured = resample(atlas, sensor.wavelengths).values
        rows = np.flatnonzero(in_unit_cube(sensor.rgb(measured)))
        parts = []
        for seed in range(SPLITS):
            split = np.array_split(np.random.default_rng(seed).permutation(rows), 2)
            for kept, other in (split, split[::-1]):
                half = Atlas(tuple(atlas.entries[row] for row in kept))
                parts.append(
                    (
                        uplift.build(half, dim=16, leave_out=[request.param]),
                        measured[other],
                    )
                )
    return parts


def calibration(halves, sensor, light):
    parts = []
    for cube, measured in halves:
        rgb = np.clip(sensor.rgb(measured), 0, 1)
        actual = delta_e_spectra(light, cube.reflectance(rgb), measured)
        stated = (cube.standard_error(rgb, light), cube.error_bound(rgb, light))
        parts.append((actual, np.transpose(stated)))
    return check_calibration(*map(np.concatenate, zip(*parts, strict=True)))


def test_other_halves_are_covered_under_every_light(halves, sensor):
    found = [calibration(halves, sensor, light) for light in LIGHTS]
    assert np.mean([each["within_error"] for each in found]) == pytest.approx(
        0.68, abs=0.05
    )
    assert np.mean([each["within_bound"] for each in found]) == pytest.approx(
        0.95, abs=0.03
    )
    for light, each in zip(LIGHTS, found, strict=True):
        assert each["within_error"] == pytest.approx(0.68, abs=0.12), light.name
        assert each["within_bound"] == pytest.approx(0.95, abs=0.06), light.name


def likely_share(halves, sensor, light):
    """Share of the other halves whose a* and b* lie in the likely region."""
    inside = []
    for cube, measured in halves:
        rgb = np.clip(sensor.rgb(measured), 0, 1)
        answered = lab(cube.reflectance(rgb) @ light.xyz.T, light.white)
        difference = (lab(measured @ light.xyz.T, light.white) - answered)[:, 1:]
        errors = lab_errors(cube.data, light)
        covariance = errors.covariance(rgb)[:, 1:, 1:]
        assert (np.linalg.eigvalsh(covariance) > 0).all()
        weighted = np.linalg.solve(covariance, difference[..., None])[..., 0]
        inside.append((difference * weighted).sum(axis=1) <= errors.likely_radius**2)
    return np.concatenate(inside).mean()


def test_the_likely_region_holds_95_percent_of_the_other_halves(halves, sensor):
    shares = [likely_share(halves, sensor, light) for light in LIGHTS]
    assert np.mean(shares) == pytest.approx(LIKELY, abs=0.03)
    assert min(shares) > 0.9


def test_an_entry_has_its_own_error(small_cube, sensor):
    data = small_cube.data
    light = observer.light("FL11")
    assert_allclose(
        small_cube.standard_error(data.atlas.rgb), data.atlas.error, atol=1e-12
    )
    own = delta_e_spectra(
        light, small_cube.reflectance(data.atlas.rgb), data.atlas.measured
    )
    assert_allclose(small_cube.standard_error(data.atlas.rgb, light), own, atol=1e-6)


def test_colours_far_from_all_entries_are_unlike_the_atlas(small_cube, plain_cube):
    assert not small_cube.unlike_atlas(small_cube.data.atlas.rgb).any()
    assert small_cube.unlike_atlas([[0, 1, 0], [0.2, 0.2, 0.2]]).tolist() == [
        True,
        False,
    ]
    assert plain_cube.unlike_atlas([[0, 1, 0], [0.2, 0.2, 0.2]]).tolist() == [
        True,
        False,
    ]
    assert without_evidence(plain_cube).unlike_atlas([0.2, 0.2, 0.2])


def test_a_cube_of_an_earlier_version_has_errors_under_its_own_light_only(
    small_cube, tmp_path
):
    atlas = dataclasses.replace(small_cube.data.atlas, measured=None, left_out=None)
    write(dataclasses.replace(small_cube.data, atlas=atlas), tmp_path / "old.uplift")
    old = Cube(read(tmp_path / "old.uplift"))
    assert old.data.atlas.left_out is None
    assert old.standard_error([0.2, 0.3, 0.4]) == small_cube.standard_error(
        [0.2, 0.3, 0.4]
    )
    unrecorded = Cube(dataclasses.replace(old.data, provenance={}))
    assert unrecorded.error_bound([0.7, 0.3, 0.9]) == 2 * unrecorded.standard_error(
        [0.7, 0.3, 0.9]
    )
    with raises(OptionError, "too-few-entries"):
        old.standard_error([0.2, 0.3, 0.4], "FL11")
    with raises(OptionError, "too-few-entries"):
        lab_errors(old.data, LIGHTS[0])


def test_bad_input(small_cube, plain_cube):
    with raises(UnknownNameError, "unknown-name"):
        small_cube.standard_error([0.2, 0.3, 0.4], "FL99")
    earlier = without_evidence(plain_cube)
    assert earlier.standard_error([0.2, 0.3, 0.4], "FL11") is None
    assert earlier.error_bound([0.2, 0.3, 0.4], "FL11") is None
