"""L*a*b*, ΔE00 and dominant wavelength compared with published pairs and with
colour-science.
"""

from pathlib import Path

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_2000_terms, lab, lab_to_xyz
from uplift.extras.colour.dominant import dominant_wavelengths

PAIRS = np.loadtxt(
    Path(__file__).parents[1] / "reference" / "ciede2000_sharma2005.csv",
    delimiter=",",
    comments=("#", "L1"),
)


def test_published_pairs_of_sharma_2005():
    assert len(PAIRS) == 34
    for first, second in ((PAIRS[:, :3], PAIRS[:, 3:6]), (PAIRS[:, 3:6], PAIRS[:, :3])):
        assert_allclose(delta_e_2000(first, second), PAIRS[:, 6], atol=5.1e-5)


def test_the_norm_of_three_terms_is_delta_e_2000():
    rng = np.random.default_rng(5)
    pairs = rng.uniform([0, -100, -100], [100, 100, 100], (2, 2000, 3))
    pairs[:, :9, 1:] = 0
    terms = delta_e_2000_terms(*pairs)
    assert_allclose(np.linalg.norm(terms, axis=-1), delta_e_2000(*pairs), rtol=1e-9)


@pytest.mark.parametrize("name", ["D65", "A"])
def test_lab_agrees_with_colour_science_and_is_invertible(name):
    xy = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"][name]
    white = colour.xy_to_XYZ(xy)
    xyz = np.random.default_rng(4).uniform(-0.01, 1, (500, 3))
    xyz[0] = 0
    assert_allclose(lab(xyz, white), colour.XYZ_to_Lab(xyz, xy), rtol=1e-9, atol=1e-9)
    assert_allclose(lab_to_xyz(lab(xyz, white), white), xyz, atol=1e-14)


def test_dominant_wavelengths_agree_with_colour_science(sensor):
    """Their locus has a step of 1 nm, ours of 5 nm."""
    white = sensor.light.white[:2] / sensor.light.white.sum()
    kinds = set()
    for rgb in np.random.default_rng(3).random((60, 3)):
        xyz = sensor.xyz(rgb)
        xy = xyz[:2] / xyz.sum()
        if np.hypot(*(xy - white)) < 0.02:
            continue
        theirs, *_ = colour.dominant_wavelength(xy, white)
        [found], [is_complement], [purity] = dominant_wavelengths(xyz[None], sensor)
        kinds.add(bool(is_complement))
        assert is_complement == (theirs < 0)
        assert found == pytest.approx(abs(float(theirs)), abs=1.0)
        if not is_complement:
            expected = colour.excitation_purity(xy, white)
            assert purity == pytest.approx(expected, abs=5e-3)
    assert kinds == {True, False}


def test_greys_and_black_have_no_dominant_wavelength(sensor):
    xyz = np.array([np.zeros(3), np.full(3, -1.0), 0.3 * sensor.light.white])
    wavelengths, complementary, purity = dominant_wavelengths(xyz, sensor)
    assert np.isnan(wavelengths).all()
    assert not complementary.any()
    assert not purity.any()
