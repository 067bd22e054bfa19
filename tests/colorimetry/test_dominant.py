"""Dominant wavelength and purity: colour-science, mixtures with white, purples and greys."""

from __future__ import annotations

import colour
import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.dominant import GREY, dominant_wavelength


@pytest.fixture(scope="module")
def sensor():
    return observer.sensor()


def test_spectral_colours_and_their_tints(sensor):
    """A mixture of white and one wavelength has that wavelength, and the purity of the distances in x, y."""
    for wavelength in (440, 480, 520, 560, 600, 640):
        pure = sensor.cmfs[list(sensor.wavelengths).index(wavelength)]
        found = dominant_wavelength(pure, sensor)
        assert found.wavelength == pytest.approx(wavelength, abs=1e-6)
        assert (found.complementary, found.purity) == (False, pytest.approx(1))
        tint = pure / pure.sum() + 2 * sensor.light.white / sensor.light.white.sum()
        found = dominant_wavelength(tint, sensor)
        assert found.wavelength == pytest.approx(wavelength, abs=1e-6)
        assert found.purity == pytest.approx(1 / 3)


def test_agrees_with_colour_science(sensor):
    """Their locus has a step of 1 nm, ours of 5 nm."""
    white = sensor.light.white[:2] / sensor.light.white.sum()
    kinds = set()
    for rgb in np.random.default_rng(3).random((60, 3)):
        xyz = sensor.xyz(rgb)
        xy = xyz[:2] / xyz.sum()
        if np.hypot(*(xy - white)) < 0.02:
            continue
        theirs, *_ = colour.dominant_wavelength(xy, white)
        found = dominant_wavelength(xyz, sensor)
        kinds.add(found.complementary)
        assert found.complementary == (theirs < 0)
        assert found.wavelength == pytest.approx(abs(float(theirs)), abs=1.0)
        if not found.complementary:
            assert found.purity == pytest.approx(colour.excitation_purity(xy, white), abs=5e-3)
    assert kinds == {True, False}


def test_purples_have_the_wavelength_of_their_complement(sensor):
    found = dominant_wavelength(sensor.xyz([1.0, 0, 1.0]), sensor)
    green = dominant_wavelength(sensor.xyz([0.0, 1, 0]), sensor)
    assert found.complementary
    assert found.wavelength == pytest.approx(green.wavelength, abs=1e-6)
    assert 0 < found.purity < 1


@pytest.mark.parametrize("xyz", [np.zeros(3), np.full(3, -1.0), None])
def test_greys_and_black_have_none(sensor, xyz):
    assert dominant_wavelength(0.3 * sensor.light.white if xyz is None else xyz, sensor) == GREY


def test_hue_turns_without_gaps(sensor):
    """Every direction from white meets the locus once."""
    white = sensor.light.white[:2] / sensor.light.white.sum()
    for angle in np.linspace(0, 2 * np.pi, 721):
        x, y = white + 0.01 * np.array([np.cos(angle), np.sin(angle)])
        found = dominant_wavelength([x, y, 1 - x - y], sensor)
        assert 380 <= found.wavelength <= 780
        assert 0 < found.purity < 0.2
