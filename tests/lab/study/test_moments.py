"""The techniques against their definitions, the laws of the study, and the statements
of its page.
"""

import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

import uplift
from benchmarks.moments import FLOATS, max_moments, read_thesis
from tests.helpers import raises
from uplift.atlas import Atlas, read_atlas
from uplift.colorimetry import observer
from uplift.common.errors import AtlasError, OptionError
from uplift.extras.scene.representations.samples import wavelengths
from uplift.lab.study.moments import ALL_ATLASES, MAX_MOMENTS, TECHNIQUES, study_moments
from uplift.models import Moments, duality, evaluate

MIRRORED = [technique for technique in TECHNIQUES if technique.mirrored]
UNMIRRORED = [technique for technique in TECHNIQUES if not technique.mirrored]


def bumps(rows: int, wavelengths: np.ndarray) -> np.ndarray:
    """Smooth reflectances (rows, N) in (0, 1) whose ends differ."""
    rng = np.random.default_rng(2020)
    slope, wave, shift = rng.normal(size=(3, rows, 1))
    t = (wavelengths - 380) / 400
    return (
        0.5
        + np.arctan(3 * slope * (t - 0.5) + 2 * wave * np.cos(7 * t + 3 * shift))
        / np.pi
    )


def by_label(techniques):
    return pytest.mark.parametrize(
        "technique", techniques, ids=lambda technique: technique.short
    )


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

        real = quad(
            part, phase[0], phase[-1], (np.cos,), points=phase[1:-1], epsabs=1e-13
        )[0]
        assert moment.real == pytest.approx(real, abs=1e-12)
        if not technique.mirrored:
            imaginary = quad(
                part, phase[0], phase[-1], (np.sin,), points=phase[1:-1], epsabs=1e-13
            )[0]
            assert moment.imag == pytest.approx(imaginary, abs=1e-12)


@by_label(UNMIRRORED)
@pytest.mark.parametrize("count", [0, 1, 4, 15])
def test_reconstruction_has_its_complex_moments(technique, count):
    """Computed by the trapezoid rule on the circle, which converges exponentially."""
    moments = technique.moments(bumps(20, wavelengths()), wavelengths(), count)
    circle = -np.pi + 2 * np.pi * np.arange(1 << 14) / (1 << 14)
    waves = duality.fourier_basis(circle, count + 1)
    multipliers = duality.multipliers_from_moments(
        moments, duality.try_complex_multipliers
    )
    reflectance = 0.5 + np.arctan((multipliers @ waves.T).real) / np.pi
    again = (
        reflectance @ np.exp(-1j * circle[:, None] * np.arange(count + 1)) / len(circle)
    )
    assert_allclose(again, moments, rtol=0, atol=1e-10)


@by_label(MIRRORED)
@pytest.mark.parametrize("count", [3, 9, 16])
def test_mirrored_moments_are_those_of_cubes(technique, count):
    """The model of cubes gives the same spectra and the same moments."""
    model = Moments(count, warp="vision" if technique.warped else "none")
    moments = technique.moments(bumps(20, wavelengths()), wavelengths(), count - 1)
    multipliers = model.from_storage(moments)
    assert_allclose(
        technique.reconstruct(moments, observer.grid()),
        evaluate(model, multipliers, observer.grid()),
        rtol=0,
        atol=1e-12,
    )
    assert_allclose(model.to_storage(multipliers), moments, rtol=0, atol=1e-10)


@by_label(TECHNIQUES)
def test_black_white_and_a_step_are_reconstructed(technique):
    extremes = np.stack(
        [np.zeros(401), np.ones(401), (wavelengths() > 580).astype(float)]
    )
    actual = technique.reconstruct(
        technique.moments(extremes, wavelengths(), 15), observer.grid()
    )
    assert ((actual >= 0) & (actual <= 1)).all()
    assert_allclose(actual[:2], [[0] * 81, [1] * 81], atol=1e-4)


@pytest.fixture(scope="module")
def study(repository):
    """Study of all shipped atlases."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return study_moments(
            {
                path.stem: read_atlas(path)
                for path in sorted((repository / "atlases").glob("*.txt"))
            }
        )


@pytest.mark.parametrize("group", ["macbeth", ALL_ATLASES])
def test_mirrored_techniques_have_the_least_error(study, group):
    for floats in FLOATS:
        means = np.array(
            [
                study.result(one, max_moments(one, floats), group).mean
                for one in TECHNIQUES
            ]
        )
        assert means[:2, 0].min() < means[2:, 0].min(), floats
        if floats >= 9:
            assert means[2:, -1].min() > 2.5 * means[:2, -1].min(), floats


def test_errors_agree_with_those_of_the_thesis(study):
    thesis = read_thesis()
    assert len(thesis) == 64
    for technique in MIRRORED:
        found = study.result(technique, 8)
        assert found.mean[0] == pytest.approx(thesis[technique, 8][0], abs=0.2)
        assert found.max[0] == pytest.approx(thesis[technique, 8][1], abs=0.35)


def test_invalid_studies_are_refused(repository):
    atlas = read_atlas(repository / "atlases" / "tcs.txt")
    for count in (-1, MAX_MOMENTS + 1):
        with raises(OptionError, "option"):
            study_moments({"tcs": atlas}, count)
    with raises(AtlasError, "too-few-entries"):
        study_moments({"empty": Atlas()})
