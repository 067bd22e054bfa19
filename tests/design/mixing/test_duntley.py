"""Duntley's theory: agreement with numerical integration, and limits: two constants, dyes, thick layers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from uplift.design.mixing import duntley
from uplift.design.mixing.duntley import Flux
from uplift.design.mixing.pigments import Pigment

BEAM = Flux(np.array([0.4, 0.1]), np.array([0.7, 0.2]), np.array([0.9, 1.5]))
DIFFUSE = Flux(np.array([0.6, 0.3]), np.array([1.1, 0.5]), np.array([0.8, 2.0]))
NONE = np.zeros(2)


def integrated(beam, diffuse, X):
    """Return R and T at one wavelength from a numerical solution of the differential equations."""
    mu = beam.absorption + beam.backward + beam.forward
    K, B = diffuse.absorption, diffuse.backward

    def slopes(x, flux):
        t, s = flux
        left = np.exp(-mu * x)
        return np.stack([beam.forward * left - (K + B) * t + B * s, (K + B) * s - B * t - beam.backward * left])

    x = np.linspace(0, X, 80)
    solved = solve_bvp(slopes, lambda top, bottom: np.array([top[0], bottom[1]]), x, np.zeros((2, 80)), tol=1e-9)
    return solved.y[1, 0], solved.y[0, -1] + np.exp(-mu * X)


def at(flux, place):
    return Flux(*(values[place] for values in (flux.absorption, flux.backward, flux.forward)))


@pytest.mark.parametrize("place", [0, 1])
def test_the_differential_equations_are_satisfied(place):
    found = duntley.layer(BEAM, DIFFUSE, 1.3)
    R, T = integrated(at(BEAM, place), at(DIFFUSE, place), 1.3)
    assert found.reflectance[place] == pytest.approx(R, abs=1e-7)
    assert found.transmittance[place] == pytest.approx(T, abs=1e-7)


def test_dyes():
    """B = B' = F = F' = 0: nothing is reflected, and T = exp(−K'X)."""
    found = duntley.layer(Flux(np.array([0.4, 2.0]), NONE, NONE), Flux(np.array([0.4, 0.7]), NONE, NONE), 1.5)
    np.testing.assert_array_equal(found.reflectance, 0)
    np.testing.assert_allclose(found.transmittance, np.exp([-0.6, -3]))


def test_strong_forward_scattering_gives_the_two_constant_theory():
    """P' → 0 and Q' → 1: the beam becomes diffuse before anything else happens."""
    beam = Flux(BEAM.absorption, BEAM.backward, np.full(2, 1e7))
    P, Q = duntley.sources(beam, DIFFUSE)
    np.testing.assert_allclose(P, 0, atol=1e-6)
    np.testing.assert_allclose(Q, 1, atol=1e-6)
    two = Pigment(DIFFUSE.absorption, DIFFUSE.backward).layer(0.9)
    found = duntley.layer(beam, DIFFUSE, 0.9)
    np.testing.assert_allclose(found.reflectance, two.reflectance, atol=1e-6)
    np.testing.assert_allclose(found.transmittance, two.transmittance, atol=1e-6)


@pytest.mark.parametrize("off", [0, 1e-14, 1e-9, 1e-7, 1e-5, 3e-5])
def test_the_result_is_smooth_where_the_denominator_vanishes(off):
    """μ = γ: the beam decays as fast as diffuse light."""
    gamma = np.sqrt(DIFFUSE.absorption * (DIFFUSE.absorption + 2 * DIFFUSE.backward))
    forward = np.array([0.5, 0.3])
    beam = Flux(gamma - forward - 0.1 + off, np.full(2, 0.1), forward)
    found = duntley.layer(beam, DIFFUSE, 1.0)
    R, T = integrated(at(beam, 0), at(DIFFUSE, 0), 1.0)
    assert found.reflectance[0] == pytest.approx(R, abs=1e-7)
    assert found.transmittance[0] == pytest.approx(T, abs=1e-7)


def test_energy_is_not_created(rng):
    beam, diffuse = (Flux(*10 ** rng.uniform(-3, 1, (3, 200))) for _ in range(2))
    for X in (0.01, 1.0, 30.0):
        found = duntley.layer(beam, diffuse, X)
        assert (found.reflectance >= -1e-12).all()
        assert (found.transmittance >= -1e-12).all()
        assert (found.reflectance + found.transmittance <= 1 + 1e-9).all()


def test_isotropic_paint_in_a_beam_is_two_r_over_three_minus_r(rng):
    """Eq. 10.8 in the limit of thick layers against the closed form, and its inverse."""
    paint = Pigment(rng.uniform(0.01, 4, 30), rng.uniform(0.2, 3, 30))
    r = paint.opaque_reflectance()
    thick = duntley.layer(*duntley.isotropic(paint), 400.0).reflectance
    np.testing.assert_allclose(duntley.directed_reflectance(r), thick, rtol=1e-6)
    np.testing.assert_allclose(duntley.diffuse_reflectance(duntley.directed_reflectance(r)), r, rtol=1e-12)
