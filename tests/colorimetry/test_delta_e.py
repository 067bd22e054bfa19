"""ΔE00 compared with the published pairs and with colour-science."""

from __future__ import annotations

from pathlib import Path

import colour
import numpy as np
import pytest

from uplift.colorimetry.delta_e import delta_e_2000, lab

PAIRS = np.loadtxt(
    Path(__file__).parents[1] / "reference" / "ciede2000_sharma2005.csv", delimiter=",", comments=("#", "L1")
)


def test_published_pairs_of_sharma_2005():
    assert len(PAIRS) == 34
    np.testing.assert_allclose(delta_e_2000(PAIRS[:, :3], PAIRS[:, 3:6]), PAIRS[:, 6], atol=5.1e-5)


def test_delta_e_2000_is_symmetric():
    np.testing.assert_allclose(
        delta_e_2000(PAIRS[:, :3], PAIRS[:, 3:6]), delta_e_2000(PAIRS[:, 3:6], PAIRS[:, :3]), rtol=1e-12
    )


def test_delta_e_2000_agrees_with_colour_science():
    rng = np.random.default_rng(3)
    first = rng.uniform([0, -100, -100], [100, 100, 100], (2000, 3))
    second = first + rng.normal(scale=10, size=first.shape)
    expected = colour.difference.delta_E_CIE2000(first, second)
    np.testing.assert_allclose(delta_e_2000(first, second), expected, rtol=1e-9)


@pytest.mark.parametrize("white", ["D65", "A"])
def test_lab_agrees_with_colour_science(white):
    xy = colour.CCS_ILLUMINANTS["CIE 1931 2 Degree Standard Observer"][white]
    xyz = np.random.default_rng(4).uniform(-0.01, 1, (500, 3))
    xyz[0] = 0
    expected = colour.XYZ_to_Lab(xyz, xy)
    np.testing.assert_allclose(lab(xyz, colour.xy_to_XYZ(xy)), expected, rtol=1e-9, atol=1e-9)
