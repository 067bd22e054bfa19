"""The four techniques: moments against their definition, reconstructions against their moments."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from uplift.colorimetry import observer
from uplift.lab.study.moments import TECHNIQUES, Technique, fine_grid
from uplift.models import Moments, Phase, duality, evaluate

MIRRORED = [technique for technique in TECHNIQUES if technique.mirrored]
UNMIRRORED = [technique for technique in TECHNIQUES if not technique.mirrored]


def bumps(rows: int, wavelengths: np.ndarray) -> np.ndarray:
    """Smooth reflectances (rows, N) in (0, 1) whose ends differ."""
    rng = np.random.default_rng(2020)
    slope, wave, shift = rng.normal(size=(3, rows, 1))
    t = (wavelengths - 380) / 400
    return 0.5 + np.arctan(3 * slope * (t - 0.5) + 2 * wave * np.cos(7 * t + 3 * shift)) / np.pi


def by_label(techniques):
    return pytest.mark.parametrize("technique", techniques, ids=lambda technique: technique.short)


@by_label(TECHNIQUES)
def test_phase_covers_the_half_or_full_circle(technique):
    phase = technique.phase(fine_grid())
    assert phase[0] == pytest.approx(-np.pi, abs=1e-14)
    assert phase[-1] == pytest.approx(0 if technique.mirrored else np.pi, abs=1e-14)
    assert (np.diff(phase) > 0).all()


@by_label(TECHNIQUES)
def test_moments_equal_the_integrals(technique):
    """Compared with adaptive integration of the same piecewise linear function."""
    samples = np.array([380.0, 430, 520, 560, 640, 780])
    values = np.array([[0.1, 0.9, 0.3, 0.35, 1.0, 0.6]])
    phase = technique.phase(samples)
    actual = technique.moments(values, samples, 6)[0]
    for j, moment in enumerate(actual):

        def part(phi, function, j=j):
            return np.interp(phi, phase, values[0]) * function(-j * phi) / np.ptp(phase)

        real = quad(part, phase[0], phase[-1], (np.cos,), points=phase[1:-1], epsabs=1e-13)[0]
        assert moment.real == pytest.approx(real, abs=1e-12)
        if not technique.mirrored:
            imaginary = quad(part, phase[0], phase[-1], (np.sin,), points=phase[1:-1], epsabs=1e-13)[0]
            assert moment.imag == pytest.approx(imaginary, abs=1e-12)


@by_label(UNMIRRORED)
@pytest.mark.parametrize("count", [0, 1, 2, 4, 8, 15])
def test_reconstruction_has_its_complex_moments(technique, count):
    """Computed by the trapezoid rule on the circle, which converges exponentially."""
    moments = technique.moments(bumps(20, fine_grid()), fine_grid(), count)
    circle = -np.pi + 2 * np.pi * np.arange(1 << 14) / (1 << 14)
    waves = duality.fourier_basis(circle, count + 1)
    reflectance = 0.5 + np.arctan((duality.multipliers_from_moments(moments) @ waves.T).real) / np.pi
    again = reflectance @ np.exp(-1j * circle[:, None] * np.arange(count + 1)) / len(circle)
    np.testing.assert_allclose(again, moments, rtol=0, atol=1e-10)


@by_label(MIRRORED)
@pytest.mark.parametrize("count", [3, 9, 16])
def test_mirrored_moments_are_those_of_cubes(technique, count):
    """The model of cubes gives the same spectra and the same moments."""
    model = Moments(count, Phase(warp="vision" if technique.warped else "none"))
    moments = technique.moments(bumps(20, fine_grid()), fine_grid(), count - 1)
    multipliers = model.from_storage(moments)
    np.testing.assert_allclose(
        technique.reconstruct(moments, observer.grid()),
        evaluate(model, multipliers, observer.grid()),
        rtol=0,
        atol=1e-12,
    )
    np.testing.assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=1e-10)


@by_label(MIRRORED)
def test_spectrum_of_the_model_is_reconstructed(technique):
    """Nine moments represent nine multipliers up to the error of sampling at 1 nm."""
    model = Moments(9, Phase(warp="vision" if technique.warped else "none"))
    multipliers = np.random.default_rng(4).normal(size=(10, 9)) / (1 + np.arange(9))
    moments = technique.moments(evaluate(model, multipliers, fine_grid()), fine_grid(), 8)
    np.testing.assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=1e-4)
    np.testing.assert_allclose(
        technique.reconstruct(moments, fine_grid()),
        evaluate(model, multipliers, fine_grid()),
        rtol=0,
        atol=2e-3,
    )


@by_label(TECHNIQUES)
def test_zeroth_moment_gives_the_mean_over_the_phase(technique):
    reflectance = bumps(5, fine_grid())
    mean = np.trapezoid(reflectance, technique.phase(fine_grid())) / np.ptp(technique.phase(fine_grid()))
    actual = technique.reconstruct(technique.moments(reflectance, fine_grid(), 0), observer.grid())
    np.testing.assert_allclose(actual, np.repeat(mean[:, None], 81, axis=1), rtol=0, atol=1e-12)


def test_symmetric_spectrum_has_zero_odd_mirrored_moments():
    """Its even moments equal those of the full circle."""
    wavelengths = fine_grid()
    even = bumps(5, wavelengths)
    even = (even + even[:, ::-1]) / 2
    mirrored = Technique(True, False).moments(even, wavelengths, 8)
    whole = Technique(False, False).moments(even, wavelengths, 4)
    np.testing.assert_allclose(mirrored[:, 1::2], 0, atol=1e-14)
    signs = (-1) ** np.arange(5)  # the full circle starts half a turn earlier
    np.testing.assert_allclose(mirrored[:, ::2] * signs, whole, rtol=0, atol=1e-13)


@by_label(TECHNIQUES)
def test_black_white_and_a_step_are_reconstructed(technique):
    extremes = np.stack([np.zeros(401), np.ones(401), (fine_grid() > 580).astype(float)])
    actual = technique.reconstruct(technique.moments(extremes, fine_grid(), 15), observer.grid())
    assert ((actual >= 0) & (actual <= 1)).all()
    np.testing.assert_allclose(actual[:2], [[0] * 81, [1] * 81], atol=1e-4)


def test_storage_and_abbreviations():
    assert [technique.floats(8) for technique in TECHNIQUES] == [9, 9, 17, 17]
    assert [technique.short for technique in TECHNIQUES] == ["M&W", "M&nW", "nM&W", "nM&nW"]
