"""Samples of pixels, colour errors against a slow oracle, and the choice among
candidates.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.extras.texture.conftest import planes, write_exr
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.errors import UpliftWarning
from uplift.common.progress import ignore_progress
from uplift.extras.papers.wavelengths.sampling import make_setup
from uplift.extras.scene.plan.evaluation import (
    WORST_DELTA_E,
    EvaluationSet,
)
from uplift.extras.texture.scene_colours import Images, sample_colours

LIGHTS = ("D65", "FL11")
ROWS = {"textures": slice(0, 40), "materials": slice(40, 47)}


@pytest.fixture(scope="module")
def tests(plain_cube):
    rng = np.random.default_rng(0)
    weights = rng.random(40)
    weights = np.concatenate([weights / weights.sum(), np.full(7, 1 / 7)])
    spectra = rng.random((47, 81))
    setup = make_setup(spectra, LIGHTS, wavelengths=observer.grid())
    rgb = spectra @ observer.sensor().matrix.T
    return EvaluationSet(plain_cube, setup, rgb, weights, ROWS, 0.8)


def weighted_quantile(values, weights, share):
    """Smallest value that bounds this share of the weights."""
    order = np.argsort(values)
    return values[order][np.cumsum(weights[order]) >= share - 1e-12][0]


def test_errors_agree_with_a_slow_oracle(tests):
    known = tests.setup.reflectances
    spectra = np.clip(known + np.random.default_rng(1).normal(0, 0.02, (47, 81)), 0, 1)
    error = tests.error(tests.xyz(spectra))
    assert len(error.parts) == 4
    for part in error.parts:
        rows = ROWS[part.group]
        light = observer.light(part.light)
        delta_e = delta_e_spectra(light, known[rows], spectra[rows])
        weights = tests.weights[rows]
        expected = [
            weighted_quantile(delta_e, weights, 0.8),
            np.average(delta_e, weights=weights),
            delta_e.max(),
        ]
        assert_allclose([part.quantile, part.mean, part.largest], expected, rtol=1e-9)
    assert error.quantile == max(part.quantile for part in error.parts)


def test_reference_spectra_have_no_error_and_nan_has_the_largest(tests):
    spectra = tests.setup.reflectances.copy()
    assert tests.error(tests.xyz(spectra)).quantile == pytest.approx(0, abs=1e-9)
    spectra[3] = np.nan
    [first, *_] = tests.error(tests.xyz(spectra)).parts
    assert (first.group, first.largest) == ("textures", WORST_DELTA_E)


def test_the_best_matrices_map_rgb_under_the_light_of_the_space_exactly(tests, sensor):
    matrices = tests.matrices()
    assert_allclose(matrices[0], sensor.rgb_to_xyz, atol=1e-9)
    fitted = tests.error(tests.rgb @ matrices.mT)
    plain = tests.error(tests.rgb @ np.stack([matrices[0], matrices[0]]).mT)
    assert fitted.quantile < plain.quantile


@pytest.fixture
def sample(tmp_path, sensor):
    """A function that samples images of linear RGB (h, w, 3)."""

    def sample(sizes, *images):
        paths = []
        for number, rgb in enumerate(images):
            path = tmp_path / f"{number}.exr"
            paths.append(write_exr(path, planes(np.asarray(rgb, np.float32))))
        return sample_colours(Images(tuple(paths)), sensor, sizes, ignore_progress)

    return sample


def test_small_textures_are_sampled_completely(sample):
    first = [0.1, 0.2, 0.3]
    rgb = [[first, first, [0.5, 0.5, 0.5], first]]
    found = sample((4, 6), rgb, rgb)
    for each in (found.predicting, found.confirming):
        assert_allclose(each.rgb, [first, [0.5, 0.5, 0.5]], rtol=1e-6)
        assert_allclose(each.share, [0.75, 0.25])
    assert len(found.colour_bins) == len(found.few) == 2
    assert (found.pixels, found.size) == (8, 8 * 12)


def test_the_two_samples_of_a_large_texture_are_disjoint(sample):
    rgb = np.random.default_rng(1).random((100, 90, 3)).astype(np.float32)
    found = sample((300, 600), rgb)
    samples = (found.predicting, found.confirming)
    first, second = (set(map(tuple, each.rgb.tolist())) for each in samples)
    assert not first & second
    assert 240 < len(first) < 360
    assert 500 < len(second) < 700
    assert first | second <= set(map(tuple, rgb.reshape(-1, 3).tolist()))
    assert found.few is None
    for each in samples:
        assert each.share.sum() == pytest.approx(1)
        assert_allclose(each.share @ each.rgb, 0.5, atol=0.06)  # equal probability
    assert (sample((300, 600), rgb).predicting.rgb == found.predicting.rgb).all()


def test_rare_colours_have_a_bin_and_others_are_clipped_with_a_warning(sample):
    rgb = np.full((80, 80, 3), 0.25)
    rgb[40, 40] = [1.5, 0.05, 0.1]
    with pytest.warns(UpliftWarning, match="outside"):
        found = sample((50, 50), rgb)
    assert_allclose(np.sort(found.colour_bins[:, 0]), [0.25, 1], rtol=1e-6)
