"""Laws that every spectrum model keeps."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from colour.recovery import sd_Jakob2019
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from uplift.common.errors import OptionError
from uplift.models import Moments, Phase, Sigmoid, from_description
from uplift.models.sigmoid import published

GRID = np.arange(380.0, 781.0, 5.0)
MODELS = [Moments(3), Moments(9), Moments(17), Moments(9, Phase(warp="vision")), Sigmoid()]
each = pytest.mark.parametrize("model", MODELS, ids=lambda model: f"{model.name}{model.count}")


def random_multipliers(model, rows, scale=2.0):
    rng = np.random.default_rng(model.count)
    return rng.normal(size=(rows, model.count)) * scale / (1 + np.arange(model.count))


@each
def test_the_constant_multipliers_make_a_linear_part_of_one(model):
    np.testing.assert_allclose(model.basis(GRID) @ model.constant(), 1, atol=1e-15)


@each
@given(x=arrays(float, 5, elements=st.floats(-1e6, 1e6)))
def test_squash_stays_within_0_and_1_and_is_odd_about_a_half(model, x):
    y = model.squash(x)
    assert ((y >= 0) & (y <= 1)).all()
    np.testing.assert_allclose(y + model.squash(-x), 1, atol=1e-15)


@each
def test_slope_is_the_derivative_of_squash_and_positive(model):
    x = np.linspace(-30, 30, 401)
    numeric = (model.squash(x + 1e-5) - model.squash(x - 1e-5)) / 2e-5
    np.testing.assert_allclose(model.slope(x), numeric, atol=1e-9)
    assert (model.slope(x) > 0).all()


@each
def test_numpy_and_jax_run_the_same_lines(model):
    x = np.linspace(-5, 5, 11)
    with jax.enable_x64(True):
        for function in (model.squash, model.slope):
            np.testing.assert_allclose(np.asarray(function(jnp.asarray(x))), function(x), rtol=1e-14)


@each
def test_storage_and_back_gives_the_same_spectra(model):
    multipliers = random_multipliers(model, 200)
    back = model.from_storage(model.to_storage(multipliers))
    basis = model.basis(GRID)
    np.testing.assert_allclose(model.squash(back @ basis.T), model.squash(multipliers @ basis.T), atol=1e-11)


@each
def test_storage_keeps_leading_dimensions(model):
    one = random_multipliers(model, 1)[0]
    assert model.to_storage(one).shape == (model.count,)
    assert model.from_storage(np.zeros((0, model.count)) + 0.5).shape == (0, model.count)


@each
def test_a_description_makes_the_model_again(model):
    assert from_description(model.describe()) == model


def test_an_unknown_description_is_no_model():
    with pytest.raises(KeyError):
        from_description({"name": "polynomial"})


@pytest.mark.parametrize("count", [-1, 0, 2, 18])
def test_the_moments_model_takes_3_to_17_coefficients(count):
    with pytest.raises(OptionError, match="3 to 17"):
        Moments(count)


def test_the_sigmoid_is_jakob_and_hanika_s():
    """Equation 5 of the paper in colour-science's hand: coefficients per nm², nm, 1."""
    model = Sigmoid()
    c0, c1, c2 = 1.3, -0.7, 0.4
    half, middle = 200.0, 580.0
    per_nm = [
        c0 / half**2,
        c1 / half - 2 * c0 * middle / half**2,
        c0 * middle**2 / half**2 - c1 * middle / half + c2,
    ]
    theirs = sd_Jakob2019(np.array(per_nm)).align(__import__("colour").SpectralShape(380, 780, 5))
    np.testing.assert_allclose(model.squash(model.basis(GRID) @ [c0, c1, c2]), theirs.values, atol=1e-12)


@pytest.mark.parametrize("warp", ["none", "vision"])
def test_phases_run_from_minus_pi_to_0_and_stay_there(warp):
    phase = Phase(warp=warp)
    values = phase(np.arange(300.0, 901.0, 5.0))
    assert values[0] == -np.pi
    assert values[-1] == 0
    assert (np.diff(phase(GRID)) > 0).all()


def test_the_vision_warp_gives_the_middle_more_room():
    middle = Phase(warp="vision")(np.array([500.0, 600.0]))
    assert np.diff(middle) > 1.5 * np.diff(Phase()(np.array([500.0, 600.0])))


def test_bad_phases_are_refused():
    with pytest.raises(OptionError, match="unknown warp 'eye'"):
        Phase(warp="eye")
    with pytest.raises(OptionError, match="cannot run from 780"):
        Phase(780, 380)


@each
def test_outside_their_range_spectra_are_held_flat(model):
    multipliers = random_multipliers(model, 5)
    ends = model.squash(multipliers @ model.basis([300, 380, 780, 900]).T)
    np.testing.assert_array_equal(ends[:, 0], ends[:, 1])
    np.testing.assert_array_equal(ends[:, 2], ends[:, 3])


def test_published_sigmoid_is_ours_with_wavelengths_as_they_are(sensor):
    expected = Sigmoid().squash(sensor.wavelengths**2 * 1e-5 - sensor.wavelengths * 1e-2 + 2)
    found = published(np.array([[1e-5, -1e-2, 2]]), sensor.wavelengths)
    np.testing.assert_allclose(found, expected[None], atol=1e-12)
