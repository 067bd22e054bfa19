"""Properties of every spectrum model."""

from typing import get_args

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from colour.recovery import sd_Jakob2019
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift.common.errors import OptionError, UnknownNameError
from uplift.extras.mitsuba.texels import GREY_WEIGHTS
from uplift.models import registry
from uplift.models.duality import blended_multipliers
from uplift.models.model import evaluate
from uplift.models.moments import WARPS, Moments
from uplift.models.registry import from_description
from uplift.models.sigmoid import Sigmoid
from uplift.pipeline import options

GRID = np.arange(380.0, 781.0, 5.0)
LIMIT = 2e-7
"""Linear RGB: about the rounding of RGB itself."""
MODELS = [
    Moments(3),
    Moments(9),
    Moments(17),
    Moments(9, warp="vision"),
    Moments(3, warp="colour"),
    Sigmoid(),
]
each = pytest.mark.parametrize(
    "model", MODELS, ids=lambda model: f"{model.name}{model.count}"
)


def random_multipliers(model, rows):
    rng = np.random.default_rng(model.count)
    return rng.normal(size=(rows, model.count)) * 2 / (1 + np.arange(model.count))


@each
@given(x=arrays(float, 6, elements=st.floats(-1e12, 1e12)))
def test_reflectance_is_increasing_bounded_and_odd_about_one_half(model, x):
    y = model.to_reflectance(np.sort(x))
    assert (np.diff(y) >= -1e-16).all()
    assert ((y >= 0) & (y <= 1)).all()
    assert_allclose(model.to_reflectance(x) + model.to_reflectance(-x), 1, atol=1e-15)
    assert_allclose(model.to_reflectance(np.array([-1e9, 1e9])), [0, 1], atol=1e-9)


@each
@given(y=arrays(float, 5, elements=st.floats(1e-6, 1 - 1e-6)))
def test_from_reflectance_is_the_inverse(model, y):
    assert_allclose(model.to_reflectance(model.from_reflectance(y)), y, rtol=1e-9)
    limits = np.array([0.0, 1.0])
    assert_allclose(
        model.to_reflectance(model.from_reflectance(limits)), limits, atol=1e-12
    )


@each
def test_derivative_agrees_with_differences_and_is_positive(model):
    x = np.linspace(-30, 30, 401)
    numeric = (model.to_reflectance(x + 1e-5) - model.to_reflectance(x - 1e-5)) / 2e-5
    assert_allclose(model.derivative(x), numeric, atol=1e-9)
    assert (model.derivative(x) > 0).all()


@each
def test_numpy_and_jax_agree(model):
    x = np.linspace(-5, 5, 11)
    with jax.enable_x64(True):
        for function in (model.to_reflectance, model.derivative):
            assert_allclose(
                np.asarray(function(jnp.asarray(x))), function(x), rtol=1e-14
            )


@each
def test_storage_round_trip_keeps_spectra(model):
    multipliers = random_multipliers(model, 200)
    back = model.from_storage(model.to_storage(multipliers))
    assert_allclose(
        evaluate(model, back, GRID), evaluate(model, multipliers, GRID), atol=1e-11
    )


@each
def test_description_round_trip(model):
    assert from_description(model.describe()) == model


@pytest.mark.parametrize("count", [-1, 0, 2, 18])
def test_count_of_moments_out_of_range_raises(count):
    with raises(OptionError, "option"):
        Moments(count)


def test_sigmoid_agrees_with_colour_science():
    """Equation 5 of Jakob & Hanika 2019 with coefficients per nm², per nm and 1."""
    model = Sigmoid()
    c0 = 1.3
    c1 = -0.7
    c2 = 0.4
    half = 200.0
    middle = 580.0
    per_nm = [
        c0 / half**2,
        c1 / half - 2 * c0 * middle / half**2,
        c0 * middle**2 / half**2 - c1 * middle / half + c2,
    ]
    theirs = sd_Jakob2019(np.array(per_nm)).align(
        __import__("colour").SpectralShape(380, 780, 5)
    )
    assert_allclose(
        model.to_reflectance(model.basis(GRID) @ [c0, c1, c2]),
        theirs.values,
        atol=1e-12,
    )


@pytest.mark.parametrize("warp", WARPS)
def test_phases_increase_from_minus_pi_to_0(warp):
    model = Moments(warp=warp)
    values = model.phase(np.arange(300.0, 901.0, 5.0))
    assert values[0] == -np.pi
    assert values[-1] == 0
    assert (np.diff(model.phase(GRID)) > 0).all()


def test_invalid_phases_raise():
    with raises(UnknownNameError, "unknown-name"):
        Moments(warp="eye")
    with raises(OptionError, "option"):
        Moments(9, 780, 380)


@each
def test_spectra_are_constant_outside_their_range(model):
    multipliers = random_multipliers(model, 5)
    ends = model.to_reflectance(multipliers @ model.basis([300, 380, 780, 900]).T)
    assert_array_equal(ends[:, 0], ends[:, 1])
    assert_array_equal(ends[:, 2], ends[:, 3])


def change_by_rounding(model, multipliers, sensor):
    """Change of linear RGB (n,) when coefficients are rounded to single precision."""
    rounded = model.from_storage(model.to_storage(multipliers).astype(np.float32))
    before, after = (
        sensor.rgb(evaluate(model, each, sensor.wavelengths))
        for each in (multipliers, rounded)
    )
    return np.abs(after - before).max(axis=1)


@each
def test_safe_spectra_keep_their_colour_in_single_precision(model, sensor):
    rng = np.random.default_rng(3)
    multipliers = rng.normal(size=(4000, model.count)) * 10 ** rng.uniform(
        -2, 2, (4000, 1)
    )
    safe = model.is_float32_safe(multipliers)
    assert safe.sum() > 500
    assert change_by_rounding(model, multipliers[safe], sensor).max() <= LIMIT


def test_the_criterion_is_needed(sensor):
    """Nearly box-shaped spectra change more."""
    boxes = np.random.default_rng(4).normal(size=(200, 9)) * 1e5
    assert not Moments(9).is_float32_safe(boxes).any()
    assert change_by_rounding(Moments(9), boxes, sensor).max() > LIMIT


def test_moments_that_rounding_moved_outside_return():
    """A box-shaped spectrum, rounded to half precision."""
    model = Moments(9)
    moments = model.to_storage([[0, 3e4, 0, -1e4, 0, 0, 0, 0, 0]])
    rounded = moments.astype(np.float16).astype(float)
    assert not model.try_from_storage(rounded)[1].all()
    multipliers, valid = blended_multipliers(rounded, GREY_WEIGHTS)
    assert valid.all()
    assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=0.01)


def test_builds_name_the_models_that_files_have():
    assert set(registry.MODELS) == set(get_args(options.ModelName))
