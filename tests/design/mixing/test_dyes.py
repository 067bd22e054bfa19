"""Dyes: eq. 9.4 and 9.7 agree with sums over single passes, and have the right limits."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.design.mixing import dyes, filters, kubelka_munk, surface
from uplift.design.mixing.pigments import Pigment

T = np.array([0.0, 0.05, 0.5, 0.9, 1.0])
OIL = surface.normal_incidence(1.5)


def rays_in_contact(transmittance, ground, rho, inside):
    """Sum the light that leaves at each pass (9.6)."""
    light, total = (1 - rho) * np.ones_like(transmittance), rho
    for _ in range(500):
        light = light * transmittance * ground * transmittance
        total, light = total + (1 - inside) * light, inside * light
    return total


def rays_in_a_plate(transmittance, rho):
    """Sum reflected and transmitted light over passes."""
    inside = (1 - rho) * np.ones_like(transmittance)
    up, down = rho, 0.0
    for _ in range(500):
        inside = inside * transmittance
        down, inside = down + (1 - rho) * inside, rho * inside * transmittance
        up, inside = up + (1 - rho) * inside, rho * inside
    return up, down


@pytest.mark.parametrize("ground", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("of", [OIL, surface.diffuse_incidence(1.66), surface.Surface(0.04, 0.04), surface.NO_SURFACE])
def test_reflectance_on_a_ground_is_the_sum_over_passes(of, ground):
    expected = rays_in_contact(T, ground, of.outside, of.inside)
    np.testing.assert_allclose(dyes.reflectance_on_ground(T, ground, of), expected, atol=1e-12)


def test_the_printed_closed_form_creates_energy():
    """Eq. 9.7 as printed lacks the ground in its numerator: R is 24."""
    rho, ground = 0.04, 1.0
    printed = rho + (1 - rho) ** 2 / (rho * (1 - T**2 * ground * rho))
    assert (printed > 20).all()
    assert (dyes.reflectance_on_ground(T, ground, surface.Surface(rho, rho)) <= 1).all()


@pytest.mark.parametrize("rho", [0.0, 0.04, 0.5])
def test_reflectance_of_a_plate_is_the_sum_over_passes(rho):
    found = dyes.plate(T, rho)
    up, down = rays_in_a_plate(T, rho)
    np.testing.assert_allclose(found.reflectance, up)
    np.testing.assert_allclose(found.transmittance, down)
    assert (found.reflectance + found.transmittance <= 1 + 1e-12).all()


def test_a_clear_plate_reflects_on_both_sides():
    assert dyes.plate(1.0, 0.04).reflectance == pytest.approx(2 * 0.04 / 1.04)


def test_a_dye_is_paint_that_does_not_scatter():
    K = np.array([0.1, 1, 5])
    painted = kubelka_munk.layer(Pigment(K, np.zeros(3)), 0.7).over(0.8)
    np.testing.assert_allclose(dyes.reflectance_on_ground(dyes.transmittance(K, thickness=0.7), 0.8), painted)


def test_concentration_and_thickness_are_equivalent():
    K = np.array([0.2, 3])
    np.testing.assert_allclose(dyes.transmittance(K, 2, 3), dyes.transmittance(K, 6, 1))
    np.testing.assert_allclose(dyes.transmittance(K, 0), 1)
    np.testing.assert_allclose(dyes.transmittance(K, 1, 5), dyes.transmittance(K, 1, 2) * dyes.transmittance(K, 1, 3))


def test_absorption_round_trip():
    np.testing.assert_allclose(dyes.transmittance(dyes.absorption(T)), np.maximum(T, dyes.DARKEST))
    assert np.isfinite(dyes.absorption(0.0))


@pytest.mark.parametrize("of", [surface.NO_SURFACE, OIL])
def test_reflectance_on_white_round_trip(of):
    measured = np.array([0.05, 0.3, 1.0])
    through = dyes.transmittance(dyes.from_reflectance(measured, of))
    np.testing.assert_allclose(dyes.reflectance_on_ground(through, 1.0, of), measured)


def test_a_mixture_is_a_stack_of_its_parts(spectra, parts):
    """Beer's law: dyes in one layer act as a stack of filters."""
    K = dyes.absorption(spectra)
    found = dyes.transmittance(dyes.mix(K, parts))
    shares = parts / parts.sum(axis=-1, keepdims=True)
    np.testing.assert_allclose(found, filters.stack(np.maximum(spectra, dyes.DARKEST), shares))


def test_mixing_with_itself_changes_nothing(spectra):
    K = dyes.absorption(spectra[:, [0, 0]])
    np.testing.assert_allclose(dyes.mix(K, [3, 2]), K[:, 0])


def test_invalid_amounts_raise():
    with raises(OptionError, "invalid-concentration"):
        dyes.transmittance([1], -1)
    with raises(OptionError, "invalid-thickness"):
        dyes.transmittance([1], 1, float("nan"))
