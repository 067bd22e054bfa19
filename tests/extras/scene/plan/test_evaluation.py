"""Samples of pixels, colour errors against a slow oracle, and the choice among
candidates.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.errors import TextureError, UpliftWarning
from uplift.common.progress import ignore_progress
from uplift.extras.papers.wavelengths.sampling import make_setup
from uplift.extras.scene.plan.evaluation import (
    WORST_DELTA_E,
    EvaluationSet,
    fit_renderings,
)
from uplift.extras.texture.scene_colours import Images, sample_colours

LIGHTS = ("D65", "FL11")
ROWS = {"textures": slice(0, 40), "materials": slice(40, 47)}


@pytest.fixture(scope="module")
def tests(plain_cube):
    rng = np.random.default_rng(0)
    weights = rng.random(40)
    weights = np.concatenate([weights / weights.sum(), np.full(7, 1 / 7)])
    rgb = rng.random((47, 3))
    setup = make_setup(rng.random((47, 81)), LIGHTS, wavelengths=observer.grid())
    return EvaluationSet(plain_cube, setup, rgb, weights, ROWS, 0.8)


def weighted_quantile(values, weights, share):
    """Smallest value that bounds this share of the weights."""
    total = 0.0
    for value, weight in sorted(zip(values, weights, strict=True)):
        total += weight
        if total >= share - 1e-12:
            return value
    raise AssertionError


def test_errors_agree_with_a_slow_oracle(tests):
    spectra = np.clip(
        tests.setup.reflectances + np.random.default_rng(1).normal(0, 0.02, (47, 81)),
        0,
        1,
    )
    error = tests.error(tests.xyz(spectra))
    assert len(error.parts) == 4
    for part in error.parts:
        rows = ROWS[part.group]
        delta_e = delta_e_spectra(
            observer.light(part.light), tests.setup.reflectances[rows], spectra[rows]
        )
        assert part.quantile == pytest.approx(
            weighted_quantile(delta_e, tests.weights[rows], 0.8), rel=1e-9
        )
        assert part.mean == pytest.approx(
            np.average(delta_e, weights=tests.weights[rows]), rel=1e-9
        )
        assert part.largest == pytest.approx(delta_e.max(), rel=1e-9)
    assert error.quantile == max(part.quantile for part in error.parts)


def test_more_wavelengths_follow_while_they_lower_the_error(tests):
    fitted = fit_renderings((3, 16), tests, 1e-3, ignore_progress)
    errors = [rendering.error.quantile for rendering in fitted]
    assert errors == sorted(errors, reverse=True)
    assert [rendering.samples for rendering in fitted][:2] == [3, 16]


def test_reference_spectra_have_no_error_and_nan_has_the_largest(tests):
    assert tests.error(tests.xyz(tests.setup.reflectances)).quantile == pytest.approx(
        0, abs=1e-9
    )
    broken = tests.setup.reflectances.copy()
    broken[3] = np.nan
    error = tests.error(tests.xyz(broken))
    assert {part.largest for part in error.parts if part.group == "textures"} == {
        WORST_DELTA_E
    }


@pytest.fixture
def image(tmp_path):
    """A file of linear RGB (h, w, 3)."""
    return lambda rgb, name="a.exr": write_exr(
        tmp_path / name, planes(np.asarray(rgb, np.float32))
    )


def sample(paths, sensor, sizes):
    return sample_colours(Images(tuple(paths)), sensor, sizes, lambda progress: None)


def test_small_textures_are_sampled_completely(image, sensor):
    rgb = np.array(
        [[[0.1, 0.2, 0.3], [0.1, 0.2, 0.3], [0.5, 0.5, 0.5], [0.1, 0.2, 0.3]]]
    )
    found = sample([image(rgb), image(rgb, "b.exr")], sensor, (4, 6))
    for each in (found.predicting, found.confirming):
        assert_allclose(each.rgb, [[0.1, 0.2, 0.3], [0.5, 0.5, 0.5]], rtol=1e-6)
        assert_allclose(each.share, [0.75, 0.25])
    assert len(found.colour_bins) == len(found.few) == 2
    assert (found.pixels, found.size) == (8, 8 * 12)


def test_the_two_samples_of_a_large_texture_are_disjoint(image, sensor):
    rgb = np.random.default_rng(1).random((100, 90, 3))
    path = image(rgb)
    found = sample([path], sensor, (300, 600))
    first, second = (
        set(map(tuple, each.rgb.tolist()))
        for each in (found.predicting, found.confirming)
    )
    assert not first & second
    assert 240 < len(first) < 360
    assert 500 < len(second) < 700
    assert first | second <= set(
        map(tuple, rgb.astype(np.float32).reshape(-1, 3).astype(float).tolist())
    )
    assert found.few is None
    for each in (found.predicting, found.confirming):
        assert each.share.sum() == pytest.approx(1)
        assert_allclose(each.share @ each.rgb, 0.5, atol=0.06)  # equal probability
    again = sample([path], sensor, (300, 600))
    assert_array_equal(again.predicting.rgb, found.predicting.rgb)


def test_rare_colours_have_a_bin_and_others_are_clipped_with_a_warning(image, sensor):
    rgb = np.full((80, 80, 3), 0.25)
    rgb[40, 40] = [1.5, 0.05, 0.1]
    with pytest.warns(UpliftWarning, match="outside"):
        found = sample([image(rgb)], sensor, (50, 50))
    assert_allclose(np.sort(found.colour_bins[:, 0]), [0.25, 1], rtol=1e-6)


def test_of_many_pixels_only_some_are_read_and_without_any_none(
    image, sensor, monkeypatch
):
    path = image(np.random.default_rng(2).random((64, 64, 3)))
    limits = "uplift.extras.texture.scene_colours"
    monkeypatch.setattr(f"{limits}.MAX_PIXELS", 1000)
    found = sample([path], sensor, (100, 200))
    assert len(found.colour_bins) <= 1000
    assert 60 < len(found.predicting.rgb) < 150
    assert found.pixels == 4096
    monkeypatch.setattr(f"{limits}._pixel_count", lambda path: (0, 0))
    with raises(TextureError):
        sample([path], sensor, (5, 5))


def test_the_best_matrices_map_rgb_under_the_light_of_the_space_exactly(
    sensor, plain_cube
):
    spectra = np.random.default_rng(4).random((30, 81)) ** 2
    rgb = spectra @ sensor.matrix.T
    setup = make_setup(spectra, ("D65", "A"), wavelengths=observer.grid())
    tests = EvaluationSet(
        plain_cube, setup, rgb, np.full(30, 1 / 30), {"textures": slice(0, 30)}, 0.9
    )
    matrices = tests.matrices()
    assert_allclose(matrices[0], np.linalg.inv(sensor.xyz_to_rgb), atol=1e-9)
    fitted = tests.error(rgb @ matrices.mT)
    plain = tests.error(rgb @ np.stack([matrices[0], matrices[0]]).mT)
    assert fitted.quantile < plain.quantile
