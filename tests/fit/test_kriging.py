"""Kriging of deviations against dense linear algebra, and kernels learnt where the best
kernel is known.
"""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from tests.conftest import MACBETH
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import delta_e_spectra, in_unit_cube, observer
from uplift.fit import Problem, kriging
from uplift.fit.base import smooth
from uplift.fit.kriging import (
    CELLS,
    DEFAULT,
    MAX_POINTS,
    METRIC,
    MIN_ENTRIES,
    REACH,
    WHITE,
    Kernel,
    average_close,
    krige,
    learn_kriging,
    visible_change,
)
from uplift.fit.solver import solve
from uplift.models import Moments

RNG = np.random.default_rng(5)
PLACES = RNG.uniform(-20, 60, (30, 3))
DEVIATIONS = RNG.normal(size=(30, 4))
VARIANCES = RNG.uniform(0.3, 3, 30)
KERNEL = Kernel(length=10.0, noise=0.5)


def covariance(first, second, variances=1.0, kernel=KERNEL):
    """Covariance of materials at L*a*b*, the white noise of a material left out."""
    apart = np.linalg.norm((first[:, None] - second[None]) * METRIC, axis=-1)
    own = np.where(apart < REACH, (1 - apart / REACH) ** 4 * (1 + 4 * apart / REACH), 0)
    return np.exp(-apart / kernel.length) + kernel.noise * (1 - WHITE) * own * variances


def predicted(places, deviations, at, variances, at_variance=1.0, kernel=KERNEL):
    """The conditional mean of a Gaussian process at L*a*b* (3)."""
    within = covariance(places, places, np.sqrt(np.outer(variances, variances)), kernel)
    within += WHITE * kernel.noise * np.diag(variances)
    return covariance(at[None], places, np.sqrt(at_variance * variances), kernel)[
        0
    ] @ np.linalg.solve(within, deviations)


def test_it_is_the_conditional_mean():
    found, _ = krige(PLACES, DEVIATIONS, KERNEL, VARIANCES)
    for at in RNG.uniform(-20, 60, (5, 3)):
        assert_allclose(
            found(at[None])[0], predicted(PLACES, DEVIATIONS, at, VARIANCES), atol=1e-9
        )


@pytest.mark.parametrize("points", [30, 20])
def test_leave_one_out_equals_kriging_of_the_other_entries(monkeypatch, points):
    """Also where close entries are averaged, which is the same as moving them to their
    mean.
    """
    monkeypatch.setattr(kriging, "MAX_POINTS", points)
    monkeypatch.setattr(kriging, "CELLS", (20.0,))
    means = average_close(PLACES * METRIC, DEVIATIONS)
    assert (len(means.counts) < 30) == (points < 30)
    places = means.locations[means.point] / METRIC
    variances = (np.bincount(means.point, VARIANCES) / means.counts)[means.point]
    _, errors = krige(PLACES, DEVIATIONS, KERNEL, VARIANCES)
    for row in range(len(PLACES)):
        others = np.arange(len(PLACES)) != row
        again = predicted(
            places[others],
            DEVIATIONS[others],
            places[row],
            variances[others],
            variances[row],
        )
        assert_allclose(DEVIATIONS[row] - errors[row], again, atol=1e-9)


@given(st.floats(3, 60), st.floats(0, 4), st.integers(0, 1000))
def test_kernels_are_positive_definite(length, noise, seed):
    places = np.random.default_rng(seed).uniform(0, 30, (30, 3))
    assert (
        np.linalg.eigvalsh(
            covariance(places, places, kernel=Kernel(length, noise))
        ).min()
        > 0
    )


def test_close_spectra_are_averaged_where_there_are_many():
    few = average_close(PLACES, DEVIATIONS)
    assert few.locations is PLACES
    assert_array_equal(few.counts, 1)
    places = RNG.uniform(0, 60, (20 * MAX_POINTS, 3))
    deviations = RNG.normal(size=(20 * MAX_POINTS, 4))
    many = average_close(places, deviations)
    assert len(many.locations) <= MAX_POINTS
    assert_array_equal(many.counts, np.bincount(many.point))
    assert_allclose(many.counts @ many.deviations, deviations.sum(axis=0), atol=1e-9)
    assert np.abs(many.locations[many.point] - places).max() <= CELLS[-1]


LEARNING = np.random.default_rng(8)
MANY = LEARNING.uniform(0, 60, (150, 3))
ALL_VISIBLE = np.broadcast_to(np.eye(3), (150, 1, 3, 3))


def drawn_from(kernel):
    drawn = covariance(MANY, MANY, kernel=kernel) + (
        WHITE * kernel.noise + 1e-9
    ) * np.eye(150)
    return np.linalg.cholesky(drawn) @ LEARNING.normal(size=(150, 3))


@pytest.mark.parametrize(
    "truth", [Kernel(48.0, 0.01), Kernel(24.0, 1.0), Kernel(6.0, 0.03)]
)
def test_a_large_atlas_tells_its_kernel(truth):
    learnt = learn_kriging(MANY, drawn_from(truth), ALL_VISIBLE)[0].kernel
    assert truth.length / 2 <= learnt.length <= truth.length * 2
    assert truth.noise / 10 <= learnt.noise <= truth.noise * 10


def test_without_evidence_the_default_is_kept():
    few = slice(0, MIN_ENTRIES - 1)
    deviations = LEARNING.normal(size=(150, 3))
    assert (
        learn_kriging(MANY[few], deviations[few], ALL_VISIBLE[few])[0].kernel == DEFAULT
    )
    # nor are invisible deviations evidence for another kernel
    assert learn_kriging(MANY, deviations, 0 * ALL_VISIBLE)[0].kernel == DEFAULT
    assert learn_kriging(MANY, np.zeros((150, 3)), ALL_VISIBLE)[0].kernel == DEFAULT


def test_what_deviates_from_all_others_hardly_counts():
    """A sixth of the materials is of another kind: the means of the kinds
    are 0 and 1.
    """
    other = LEARNING.random(150) < 1 / 6
    deviations = 0.1 * LEARNING.normal(size=(150, 3)) + other[:, None]
    found, _ = learn_kriging(MANY, deviations, ALL_VISIBLE)
    plain, _ = krige(MANY, deviations, found.kernel)
    away = LEARNING.uniform(10, 50, (200, 3))
    assert found(away).mean() < 0.6 * plain(away).mean()


def test_visible_change_ranks_metameric_changes_by_delta_e(sensor):
    """A change of the coefficients, made exact in colour by the solver, against the
    linear prediction.

    All coefficients change alike. If changes fell off with the order, most of what
    remains once the colour is exact would lie in the roughest parts of the spectrum,
    which the prediction neglects: the correlation would be 0.6, and 0.6 without the
    weights of ΔE00. So it is 0.84 to 0.90 over samples, below 0.79 without these
    weights, and below 0.70 without the part that a smooth change of the same colour
    undoes.
    """
    model = Moments(9)
    problem = Problem(sensor, model, (observer.light("A"), observer.light("FL11")))
    forward = problem.forward
    measured = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    measured = np.tile(measured[in_unit_cube(sensor.rgb(measured))], (10, 1))
    coloured = partial(
        solve, forward, target=sensor.rgb(measured), tolerance=1e-9, max_passes=32
    )
    start = model.from_storage(
        smooth(model, forward).coefficients(sensor.rgb(measured))
    )
    plain = coloured(start=start).multipliers
    moments = model.to_storage(plain)
    change = 1e-3 * np.random.default_rng(0).normal(size=moments.shape)
    moved = coloured(start=model.from_storage(moments + change)).multipliers
    before, after = (
        model.to_reflectance(each @ forward.basis.T) for each in (plain, moved)
    )
    linear = np.linalg.norm(
        np.einsum("elkc,ec->elk", visible_change(problem, before), change), axis=-1
    )
    actual = np.stack(
        [delta_e_spectra(light, before, after) for light in problem.lights], axis=1
    )
    assert (
        0.5 < np.sqrt((linear**2).mean() / (actual**2).mean()) < 0.8
    )  # it neglects the roughest parts
    assert np.corrcoef(linear.ravel(), actual.ravel())[0, 1] > 0.8
