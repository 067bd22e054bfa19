"""Assumed scattering: laws of the dispersive rule, and mixtures of measured paints from their colours alone."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.mixing.paints import BLUES, acrylics, published
from tests.helpers import raises
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.errors import OptionError
from uplift.design.mixing import scattering
from uplift.design.mixing.mixers import mixers
from uplift.design.mixing.scattering import PowerOfReflectance, dispersive

GREEN_EDGE = 520.0


@pytest.fixture(scope="module")
def sensor(small_cube):
    return small_cube.data.sensor


@pytest.fixture(scope="module")
def assumed(sensor):
    return dispersive(sensor)


@pytest.fixture(scope="module")
def by_name(smooth_cube):
    return {one.name: one for one in mixers(smooth_cube)}


@pytest.fixture(scope="module")
def smooth_cube():
    import uplift

    return uplift.load()


def errors(mixtures, mixer, sensor):
    """ΔE00 (n,) of mixtures from the colours of their paints."""
    found = np.clip(mixer.mix(mixtures.components, mixtures.shares), 0, 1)
    return delta_e_rgb(sensor, mixtures.expected, found)


def mean_error(mixtures, mixer, sensor):
    return errors(mixtures, mixer, sensor).mean()


def test_grey_paints_scatter_alike_at_all_wavelengths(assumed):
    found = assumed(np.full((2, 81), [[0.2], [1.0]]))
    np.testing.assert_allclose(found, np.full((2, 81), [[0.2**0.75], [1.0]]), rtol=1e-12)


def test_scattering_is_strongest_where_an_absorption_ends(assumed, sensor):
    """Anomalous dispersion: more on the long-wave side of an absorption band, less on its short-wave side."""
    wavelengths = sensor.wavelengths
    yellow = assumed(np.where(wavelengths < GREEN_EDGE, 0.05, 0.9))
    blue = assumed(np.where(wavelengths < GREEN_EDGE, 0.9, 0.05))
    assert abs(wavelengths[yellow.argmax()] - GREEN_EDGE) <= 5
    assert abs(wavelengths[blue.argmin()] - GREEN_EDGE) <= 5
    assert yellow.max() > 1.5 * yellow[-1]


def test_h_is_the_mean_on_one_side_less_that_on_the_other(assumed, sensor, rng):
    """The matrix against sums written out."""
    R = rng.uniform(scattering.DARKEST_DISPERSED, 1, 81)
    strength = np.sqrt((1 - R) ** 2 / (2 * R))
    expected = []
    for wavelength in sensor.wavelengths:
        weights = np.exp(-np.abs(sensor.wavelengths - wavelength) / scattering.REACH)
        below, above = (
            sum(w * s for w, s, side in zip(weights, strength, sides, strict=True) if side)
            / sum(w for w, side in zip(weights, sides, strict=True) if side)
            for sides in (sensor.wavelengths <= wavelength, sensor.wavelengths >= wavelength)
        )
        expected.append(below - above)
    Y = (sensor.cmfs[:, 1] * R).sum() / sensor.cmfs[:, 1].sum()
    np.testing.assert_allclose(assumed(R), Y**0.75 * np.exp(np.array(expected) / 4), rtol=1e-12)


def test_further_wavelengths_change_nothing_and_are_consistent(sensor, assumed, rng):
    R = rng.uniform(0.01, 1, (3, 81))
    further = [450.0, 550.0, 300.0, 900.0]
    columns = [14, 34, 0, 80]
    found = dispersive(sensor, further)(np.concatenate([R, R[:, columns]], axis=1))
    np.testing.assert_allclose(found[:, :81], assumed(R), rtol=1e-12)
    np.testing.assert_allclose(found[:, 81:], assumed(R)[:, columns], rtol=1e-12)


def test_scattering_is_finite_and_bounded(assumed):
    extremes = np.stack([np.full(81, 1e-4), np.where(np.arange(81) < 40, 1e-4, 1), np.ones(81)])
    found = assumed(extremes)
    assert (found > 0).all()
    assert found.max() < np.exp(scattering.DISPERSION * 0.99 / np.sqrt(0.02)) + 1e-9


@pytest.mark.parametrize("exponent", [-1.0, float("nan"), float("inf")])
def test_an_invalid_exponent_raises(exponent):
    with raises(OptionError, "invalid-grading"):
        PowerOfReflectance(exponent)


@pytest.mark.parametrize(("name", "largest"), [("pigments", 8.0), ("pigments, S = √R", 11.0)])
def test_mixtures_of_measured_paints_from_their_rgb(by_name, sensor, name, largest):
    """Mean ΔE00 over 513 mixtures of acrylics; docs/mixing.md has the table."""
    error = mean_error(acrylics(), by_name[name], sensor)
    assert largest - 1 < error < largest


def test_blues_and_yellows_are_nearer_to_measured_greens(by_name, sensor):
    greens = acrylics(BLUES, "yellow")
    assert len(greens.pairs) == 45
    now, before = (mean_error(greens, by_name[name], sensor) for name in ("pigments", "pigments, S = √R"))
    assert now < 0.65 * before


@pytest.mark.parametrize(
    ("blue", "yellow"),
    [("#002185", "#fcd200"), ("#005fa0", "#ffd200"), ("#0000ff", "#ffff00"), ("#190059", "#fcd200")],
)
def test_common_blues_and_yellows_are_green(by_name, smooth_cube, blue, yellow):
    rgb = np.array([smooth_cube.decode([int(c[i : i + 2], 16) for i in (1, 3, 5)]) for c in (blue, yellow)])
    codes = smooth_cube.encode(np.clip(by_name["pigments"].mix(rgb, np.array([[1, 1], [1, 3], [3, 1]])), 0, 1))
    assert (codes[:, 1] - np.maximum(codes[:, 0], codes[:, 2])).max() > 25


def test_mixbox_s_published_mixtures_are_nearer_than_before(by_name, smooth_cube):
    examples = published("mixbox", smooth_cube)
    assert len(examples.pairs) == 11
    now, before = (
        errors(examples, by_name[name], smooth_cube.data.sensor) for name in ("pigments", "pigments, S = √R")
    )
    assert now[0] < 8 < 30 < before[0], "cobalt blue and Hansa yellow"
    assert now.mean() < before.mean()
