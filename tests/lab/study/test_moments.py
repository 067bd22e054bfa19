"""The techniques against their definitions, the laws of the study, and the statements of its page."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.integrate import quad

import uplift
from benchmarks.moments import FLOATS, max_moments, read_thesis
from tests.helpers import raises
from uplift.atlas import Atlas, read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import AtlasError, OptionError
from uplift.lab.study import complex_moments
from uplift.lab.study.moments import ALL_ATLASES, MAX_MOMENTS, MEASURES, TECHNIQUES, Technique, fine_grid, study_moments
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
    waves = complex_moments.fourier_basis(circle, count + 1)
    multipliers = duality.multipliers_from_moments(moments, complex_moments.try_multipliers)
    reflectance = 0.5 + np.arctan((multipliers @ waves.T).real) / np.pi
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


MW, MNW, NMW, NMNW = TECHNIQUES


@pytest.fixture(scope="module")
def macbeth_study(repository):
    return study_moments({"macbeth": read_atlas(repository / "atlases" / "macbeth.txt")})


@pytest.fixture(scope="module")
def full_study(repository):
    """Study of all shipped atlases."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return study_moments({path.stem: read_atlas(path) for path in sorted((repository / "atlases").glob("*.txt"))})


@pytest.fixture(params=["macbeth", ALL_ATLASES])
def errors(request, macbeth_study, full_study):
    """Function from technique, floats and measure to the mean error, for the ColorChecker and for all atlases."""
    study = full_study if request.param == ALL_ATLASES else macbeth_study
    return lambda technique, floats, measure=0: study.result(technique, max_moments(technique, floats)).mean[measure]


@by_label(TECHNIQUES)
def test_error_falls_with_moments(macbeth_study, technique):
    means = np.array([macbeth_study.result(technique, count).mean for count in range(16)])
    assert (means[15] < means[4]).all()
    assert (means[8] < means[4]).all()
    assert (means[4] < means[2]).all()
    assert (np.diff(means[:9, 0]) < 0).all()


def test_zero_moments_give_a_grey(macbeth_study):
    np.testing.assert_allclose(macbeth_study.errors[0, 0], macbeth_study.errors[2, 0], atol=1e-9)
    np.testing.assert_allclose(macbeth_study.errors[1, 0], macbeth_study.errors[3, 0], atol=1e-9)
    assert macbeth_study.result(MW, 0).mean[0] > 30


def test_mirrored_techniques_have_the_least_error(errors):
    for floats in FLOATS:
        best = min(TECHNIQUES, key=lambda technique: errors(technique, floats))
        assert best.mirrored, floats
    for floats in (9, 13, 16):
        rms = {technique: errors(technique, floats, MEASURES.index("rms")) for technique in TECHNIQUES}
        assert min(rms[NMW], rms[NMNW]) > 2.5 * min(rms[MW], rms[MNW])


def test_errors_agree_with_those_of_the_thesis(full_study):
    thesis = read_thesis()
    assert len(thesis) == 64
    for technique in (MW, MNW):
        assert full_study.result(technique, 8).mean[0] == pytest.approx(thesis[technique, 8][0], abs=0.2)
        assert full_study.result(technique, 8).max[0] == pytest.approx(thesis[technique, 8][1], abs=0.35)
    assert full_study.result(MW, 2).mean[0] > 5 * thesis[MW, 2][0]
    assert all(mean > 0.2 for mean, _ in thesis.values())
    assert full_study.result(NMNW, 15).mean[0] < 0.02


def test_groups_partition_the_entries(full_study):
    counts = [len(full_study.rows(group)) for group in full_study.groups]
    assert counts[0] == sum(counts[1:]) == 396
    worst = full_study.result(MW, 8)
    home = full_study.result(MW, 8, full_study.atlases[worst.worst])
    assert (home.worst, home.max[0]) == (worst.worst, worst.max[0])
    assert full_study.errors[0, 8, worst.worst, 0] == worst.max[0]


@pytest.mark.parametrize("count", [-1, MAX_MOMENTS + 1])
def test_moments_out_of_range_raise(count, repository):
    with raises(OptionError, "option"):
        study_moments({"tcs": read_atlas(repository / "atlases" / "tcs.txt")}, count)


def test_empty_atlases_raise():
    with raises(AtlasError, "too-few-entries"):
        study_moments({"empty": Atlas()})
