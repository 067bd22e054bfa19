"""Factor model: span, white, products, and colour errors well below those of RGB;
products without sharpening.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.conftest import ATLASES
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import delta_e
from uplift.extras.papers.palette.colours import exposure, illuminant, screen_matrix
from uplift.extras.papers.palette.factor import linear_product


@pytest.fixture(scope="module")
def measured(sensor):
    """Reflectances that the model was not fitted to."""
    return on_grid(
        read_atlas(ATLASES / "cie2017.txt", ATLASES / "macbeth.txt"), sensor.wavelengths
    )


def test_the_projection_inverts_the_basis_and_white_is_the_identity_of_products(model):
    assert_allclose(model.projection @ model.basis, np.eye(7), atol=1e-9)
    coefficients = np.array([0.1, 0.9, 0.3, 0.5, 0.2, 0.8, 0.4])
    white = model.reflectance(np.ones(len(model.wavelengths)))
    assert_allclose(model.product(white, coefficients), coefficients, atol=1e-12)


@pytest.mark.parametrize("light", ["D65", "A", "FL2", "LED-B3"])
def test_two_reflections_are_five_times_more_accurate_than_in_rgb(
    model, sensor, measured, light
):
    power = illuminant(sensor, light)
    screen = screen_matrix(sensor)
    first = measured[:-1]
    second = measured[1:]
    full = (power * first * second) @ screen.T
    modelled = model.rgb(
        model.product(
            model.light(power), model.reflectance(first), model.reflectance(second)
        )
    )
    rgb = (screen @ power) * sensor.rgb(first) * sensor.rgb(second)
    gain = exposure(sensor, full)[:, None]
    errors = [
        delta_e.delta_e_rgb(sensor, gain * found, gain * full).mean()
        for found in (modelled, rgb)
    ]
    assert errors[0] * 5 < errors[1]


def test_unsharpened_products_in_the_span_are_exact_and_commute(model):
    """They equal the projection of the full product (eq. 5–7)."""
    first, second = np.random.default_rng(3).random((2, 5, model.count))
    full = (model.spectra(first) * model.spectra(second)) @ model.projection.T
    assert_allclose(linear_product(model, first, second), full, atol=1e-9)
    assert_allclose(linear_product(model, second, first), full, atol=1e-9)
