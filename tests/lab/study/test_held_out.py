"""Held-out errors: an atlas with predictable spectra, results by hand, and plain predictors."""

from __future__ import annotations

import numpy as np
import pytest

import uplift
from tests.conftest import ATLASES
from tests.helpers import raises
from uplift.atlas import Atlas, Entry, read_atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS, SCENE_LIGHTS
from uplift.common.errors import AtlasError
from uplift.common.progress import Progress
from uplift.lab.study import baselines
from uplift.lab.study import held_out as module
from uplift.lab.study.baselines import centroid, local_linear, mismatch_centroids
from uplift.lab.study.held_out import (
    HoldoutSplit,
    SpectrumErrors,
    holdout,
    pooled_calibration,
    spectrum_errors,
)
from uplift.pipeline.build import build

GRID = observer.grid()


@pytest.fixture(scope="module")
def family():
    """24 spectra of similar colours that share ripples which a smooth spectrum does not have."""
    levels = np.linspace(0.3, 0.6, 24)
    ripple = np.cos((GRID - 380) / 400 * 6 * np.pi)
    return Atlas(tuple(Entry(f"{level:.3f}", GRID, level * (1 + 0.3 * ripple)) for level in levels))


@pytest.fixture(scope="module")
def splits(family):
    events = []
    results = holdout(family, 2, events.append, dim=8)
    assert events == [Progress("builds", done, 4) for done in (2, 3, 4)]
    return results


def test_half_an_atlas_of_similar_spectra_predicts_the_other(splits):
    for split in splits:
        means = {method: errors.means() for method, errors in split.errors.items()}
        assert (means["half the atlas"] < 0.5 * means["without an atlas"]).all()
        assert (means["half the atlas"] < 0.5 * means["sigmoid"]).all()


def test_every_split_predicts_another_half(splits):
    assert [len(split.actual) for split in splits] == [12, 12]
    assert not np.array_equal(splits[0].actual, splits[1].actual)
    assert splits[0].errors["sigmoid"].delta_e.shape == (12, len(HELD_OUT_LIGHTS))


def test_the_prior_does_not_know_the_atlas(monkeypatch):
    known = []

    def recorded(*args, **options):
        known.append(options["leave_out"])
        return build(*args, **options)

    monkeypatch.setattr(module, "build", recorded)
    atlas = read_atlas(ATLASES / "tcs.txt")
    holdout(atlas, 1, dim=4, coefficients=4)
    assert known == [("tcs",)] * 3
    holdout(atlas, 1, dim=4, coefficients=4, leave_out=("vs",))
    assert known[3:] == [("vs",)] * 3


def test_spectrum_errors_equal_their_definitions():
    rng = np.random.default_rng(0)
    predicted, measured = rng.random((3, 81)), rng.random((3, 81))
    errors = spectrum_errors(predicted, measured, ("A", "FL11"))
    for row in range(3):
        assert errors.rms[row] == pytest.approx(np.sqrt(np.mean((predicted[row] - measured[row]) ** 2)))
        for column, name in enumerate(("A", "FL11")):
            expected = delta_e_spectra(observer.light(name), predicted[row], measured[row])
            assert errors.delta_e[row, column] == pytest.approx(expected)
    assert errors.means() == pytest.approx([errors.rms.mean(), *errors.delta_e.mean(axis=0)])


def test_calibration_pools_splits_with_standard_errors():
    nothing = SpectrumErrors(np.zeros(2), np.zeros((2, 1)))
    result = pooled_calibration(
        [
            HoldoutSplit({"": nothing}, np.array([1.0, 3.0]), np.array([2.0, 2.0]), np.array([5.0, 5.0])),
            HoldoutSplit({"": nothing}, np.array([5.0, 9.0]), None, None),
        ]
    )
    assert (result.count, result.predicted, result.within_error, result.within_bound) == (2, 2, 0.5, 1)
    assert result.actual == pytest.approx(2 * (0.5 + 0.68))
    assert pooled_calibration([HoldoutSplit({"": nothing}, np.zeros(2), None, None)]) is None


def test_small_atlas_raises(family):
    with raises(AtlasError, "too-few-entries"):
        holdout(Atlas(family.entries[:7]), 1, dim=4)


@pytest.fixture(scope="module")
def data():
    return uplift.load().data


@pytest.fixture(scope="module")
def known(sensor):
    spectra = resample(read_atlas(ATLASES / "rawtoaces.txt"), sensor.wavelengths).values
    return spectra[sensor.contains(sensor.rgb(spectra))][::3]


def test_local_linear_reproduces_spectra_that_are_linear_in_rgb(data):
    sensor = data.sensor
    spectra = 0.5 + np.random.default_rng(0).uniform(-2, 2, (45, 3)) @ observer.light("A").xyz
    known, queried = spectra[:40], spectra[40:]
    np.testing.assert_allclose(local_linear(data, known, sensor.rgb(queried)), queried, atol=1e-3)


def test_local_linear_predictions_have_the_queried_colours(data, known):
    rgb = data.sensor.rgb(known.mean(axis=0)[None]) * [[0.9, 1.0, 1.1]]
    np.testing.assert_allclose(data.sensor.rgb(local_linear(data, known, rgb)), rgb, atol=1e-6)


def test_smoothing_has_the_least_leave_one_out_error(data, known, monkeypatch):
    """Against leaving out one by one."""
    monkeypatch.setattr(baselines, "BANDWIDTHS", (10.0, 40.0))
    monkeypatch.setattr(baselines, "RIDGES", (1e-6, 1e-2))
    some = known[:20]
    colours = data.sensor.rgb(some)
    lights = [observer.light(name) for name in SCENE_LIGHTS]

    def slow(smoothing):
        found = []
        for row, rest in enumerate(~np.eye(len(some), dtype=bool)):
            alone = colours[row : row + 1]
            spectra = baselines._regress(data.sensor, colours[rest], some[rest], alone, smoothing)
            found.append(baselines._exact(data, spectra, alone)[0])
        return np.mean([delta_e_spectra(light, np.array(found), some) for light in lights])

    every = [baselines.Smoothing(width, ridge) for width in (10.0, 40.0) for ridge in (1e-6, 1e-2)]
    assert baselines._best_smoothing(data, some, colours) == min(every, key=slow)


def test_centroid_of_a_tetrahedron_and_of_a_flat_body():
    corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    np.testing.assert_allclose(centroid(corners), [0.25] * 3)
    np.testing.assert_allclose(centroid(np.concatenate([corners, [[0.1, 0.1, 0.1]]])), [0.25] * 3)
    np.testing.assert_allclose(centroid(np.eye(3)), [1 / 3] * 3)


def test_mixtures_have_the_colour_and_their_centroid_too(sensor, known):
    colours = sensor.rgb(known[:10])
    rgb = colours.mean(axis=0)
    corners, weights = baselines._mixtures(colours, rgb)
    assert len(corners) >= 4
    np.testing.assert_allclose(np.einsum("vk,vkc->vc", weights, colours[corners]), rgb + 0 * corners[:, :3], atol=1e-9)
    own = mismatch_centroids(sensor, known[:10], rgb[None], [sensor.light])
    np.testing.assert_allclose(own[0, 0], sensor.xyz(rgb), atol=1e-6)


def test_colours_that_no_mixture_has_are_nan(sensor):
    grey = np.linspace(0.2, 0.6, 6)[:, None] * np.ones(len(sensor.wavelengths))
    red = np.array([[0.6, 0.1, 0.1]])
    assert np.isnan(mismatch_centroids(sensor, grey, red, [observer.light("A")])).all()
    assert mismatch_centroids(sensor, grey, np.zeros((0, 3)), [observer.light("A")]).shape == (0, 1, 3)
