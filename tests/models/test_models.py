"""Properties of every spectrum model."""

import colour
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift.common.errors import UpliftError
from uplift.models.model import evaluate
from uplift.models.moments import WARPS, Moments
from uplift.models.registry import from_description
from uplift.models.sigmoid import Sigmoid

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
@settings(max_examples=20)
@given(x=arrays(float, 6, elements=st.floats(-1e12, 1e12)))
def test_reflectance_is_increasing_bounded_and_odd_about_one_half(model, x):
    y = model.to_reflectance(np.sort(x))
    assert (np.diff(y) >= -1e-16).all()
    assert ((y >= 0) & (y <= 1)).all()
    assert_allclose(model.to_reflectance(x) + model.to_reflectance(-x), 1, atol=1e-15)
    assert_allclose(model.to_reflectance(np.array([-1e9, 1e9])), [0, 1], atol=1e-9)


@pytest.mark.parametrize("warp", WARPS)
def test_phases_increase_from_minus_pi_to_0(warp):
    model = Moments(warp=warp)
    values = model.phase(np.arange(300.0, 901.0, 5.0))
    assert values[0] == -np.pi
    assert values[-1] == 0
    assert (np.diff(model.phase(GRID)) > 0).all()


@each
def test_spectra_are_constant_outside_their_range(model):
    multipliers = random_multipliers(model, 5)
    ends = model.to_reflectance(multipliers @ model.basis([300, 380, 780, 900]).T)
    assert_array_equal(ends[:, 0], ends[:, 1])
    assert_array_equal(ends[:, 2], ends[:, 3])


@each
@settings(max_examples=20)
@given(y=arrays(float, 5, elements=st.floats(1e-6, 1 - 1e-6)))
def test_from_reflectance_is_the_inverse(model, y):
    assert_allclose(model.to_reflectance(model.from_reflectance(y)), y, rtol=1e-9)
    limits = np.array([0.0, 1.0])
    assert_allclose(
        model.to_reflectance(model.from_reflectance(limits)), limits, atol=1e-12
    )


@each
def test_derivative_agrees_with_differences_and_jax_with_numpy(model):
    x = np.linspace(-30, 30, 401)
    numeric = (model.to_reflectance(x + 1e-5) - model.to_reflectance(x - 1e-5)) / 2e-5
    assert_allclose(model.derivative(x), numeric, atol=1e-9)
    with jax.enable_x64(True):
        for function in (model.to_reflectance, model.derivative):
            there = np.asarray(function(jnp.asarray(x)))
            assert_allclose(there, function(x), rtol=1e-14)


@each
def test_storage_and_description_round_trip(model):
    multipliers = random_multipliers(model, 200)
    back = model.from_storage(model.to_storage(multipliers))
    expected = evaluate(model, multipliers, GRID)
    assert_allclose(evaluate(model, back, GRID), expected, atol=1e-11)
    assert from_description(model.describe()) == model


@pytest.mark.parametrize(
    ("args", "options", "code"),
    [
        *(((count,), {}, "option") for count in (-1, 0, 2, 18)),
        ((9, 780, 380), {}, "option"),
        ((9,), {"warp": "eye"}, "unknown-name"),
    ],
)
def test_invalid_models_raise(args, options, code):
    with raises(UpliftError, code):
        Moments(*args, **options)


def test_sigmoid_agrees_with_colour_science():
    """Equation 5 of Jakob & Hanika 2019 with coefficients per nm², per nm and 1."""
    multipliers = [1.3, -0.7, 0.4]
    per_nm = np.polynomial.Polynomial(multipliers[::-1])
    per_nm = per_nm(np.polynomial.Polynomial([-580 / 200, 1 / 200])).coef[::-1]
    shape = colour.SpectralShape(380, 780, 5)
    theirs = colour.recovery.sd_Jakob2019(per_nm).align(shape)
    model = Sigmoid()
    ours = model.to_reflectance(model.basis(GRID) @ multipliers)
    assert_allclose(ours, theirs.values, atol=1e-12)


@each
def test_safe_spectra_keep_their_colour_in_single_precision(model, sensor):
    rng = np.random.default_rng(3)
    scale = 10 ** rng.uniform(-2, 2, (1000, 1))
    multipliers = rng.normal(size=(1000, model.count)) * scale
    safe = multipliers[model.is_float32_safe(multipliers)]
    assert len(safe) > 125
    rounded = model.from_storage(model.to_storage(safe).astype(np.float32))
    before, after = (
        sensor.rgb(evaluate(model, each, sensor.wavelengths))
        for each in (safe, rounded)
    )
    assert np.abs(after - before).max() <= LIMIT
