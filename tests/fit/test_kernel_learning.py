"""Kernels, reach and trust learnt from entries where the best ones are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.linalg import null_space

from tests.conftest import MACBETH
from tests.fit.test_kriging import covariance
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.kernel_learning import (
    MIN_ENTRIES,
    MIN_REACH,
    TRUST,
    TRUST_ENTRIES,
    TRUSTS,
    entry_reach,
    learn_kriging,
    visible_change,
)
from uplift.fit.kriging import DEFAULT, METRIC, REACH, WHITE, Kernel, krige
from uplift.fit.problem import Problem
from uplift.models.moments import Moments

MANY = np.random.default_rng(8).uniform(0, 60, (150, 3))
ALL_VISIBLE = np.broadcast_to(np.eye(3), (150, 1, 3, 3))


def drawn_from(kernel):
    random = np.random.default_rng(8)
    drawn = covariance(MANY, MANY, kernel=kernel)
    drawn += (WHITE * kernel.noise + 1e-9) * np.eye(150)
    return np.linalg.cholesky(drawn) @ random.normal(size=(150, 3))


@pytest.mark.parametrize(
    "truth", [Kernel(48.0, 0.01), Kernel(24.0, 1.0), Kernel(6.0, 0.03)]
)
def test_a_large_atlas_tells_its_kernel(truth):
    learnt = learn_kriging(MANY, drawn_from(truth), ALL_VISIBLE)[0].kernel
    assert truth.length / 2 <= learnt.length <= truth.length * 2
    assert truth.noise / 10 <= learnt.noise <= truth.noise * 10


def test_without_evidence_the_default_is_kept():
    """Few entries are none, and nor are invisible deviations."""
    few = slice(0, MIN_ENTRIES - 1)
    deviations = np.random.default_rng(9).normal(size=(150, 3))
    for learnt, _ in (
        learn_kriging(MANY[few], deviations[few], ALL_VISIBLE[few]),
        learn_kriging(MANY, deviations, 0 * ALL_VISIBLE),
        learn_kriging(MANY, np.zeros((150, 3)), ALL_VISIBLE),
    ):
        assert learnt.kernel[:2] == DEFAULT[:2]


def test_an_entry_reaches_as_far_as_to_the_next():
    grid = np.stack(np.meshgrid(*3 * [np.arange(4.0)]), axis=-1).reshape(-1, 3)
    for step, reach in ((5 / METRIC, 5), (50, REACH), (0, MIN_REACH)):
        assert entry_reach(grid * step) == pytest.approx(reach)


def test_an_atlas_that_predicts_itself_is_trusted():
    alike = drawn_from(Kernel(48.0, 0.01))
    assert learn_kriging(MANY, alike, ALL_VISIBLE)[0].trust >= 0.9
    random = np.random.default_rng(10).normal(size=(150, 3))
    assert learn_kriging(MANY, random, ALL_VISIBLE)[0].trust == TRUSTS[0]
    few = slice(0, TRUST_ENTRIES - 1)
    assert learn_kriging(MANY[few], alike[few], ALL_VISIBLE[few])[0].trust == TRUST


def test_what_deviates_from_all_others_hardly_counts():
    """A sixth of the materials is of another kind: the means of the kinds
    are 0 and 1.
    """
    draw = np.random.default_rng(11)
    other = draw.random(150) < 1 / 6
    deviations = 0.1 * draw.normal(size=(150, 3)) + other[:, None]
    found, _ = learn_kriging(MANY, deviations, ALL_VISIBLE, trust=1.0)
    plain, _ = krige(MANY, deviations, found.kernel)
    away = draw.uniform(10, 50, (200, 3))
    assert found(away).mean() < 0.6 * plain(away).mean()


def test_visible_change_is_the_delta_e_of_changes_that_keep_the_colour(sensor):
    """What a smooth change of the same colour undoes does not count."""
    model = Moments(9)
    problem = Problem(sensor, model, (observer.light("A"), observer.light("FL11")))
    measured = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    visible = visible_change(problem, measured)
    colour = sensor.matrix @ problem.forward.basis
    smooth = colour.T / model.metric_diagonal()[:, None]
    assert_allclose(visible @ smooth, 0, atol=1e-9)
    for change in null_space(colour).T:
        moved = measured + 1e-6 * problem.forward.basis @ change
        for number, light in enumerate(problem.lights):
            linear = np.linalg.norm(visible[:, number] @ change, axis=1)
            actual = delta_e_spectra(light, measured, moved) / 1e-6
            assert np.corrcoef(linear, actual)[0, 1] > 0.97
            assert 0.75 < linear.mean() / actual.mean() < 1
