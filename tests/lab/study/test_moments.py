"""The techniques against their definitions, the laws of the study, and the statements
of its page.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad

from benchmarks import read_reference
from benchmarks.materials import read_atlases
from tests.helpers import raises
from tools.render_docs import pick, where
from uplift.atlas import Atlas, read_atlas
from uplift.common.errors import AtlasError, OptionError
from uplift.extras.scene.representations.samples import wavelengths
from uplift.lab.study.moments import (
    ALL_ATLASES,
    MAX_MOMENTS,
    TECHNIQUES,
    study_moments,
)

MIRRORED = TECHNIQUES[:2]


@pytest.fixture
def bumps():
    """Smooth reflectances (20, 401) in (0, 1) whose ends differ."""
    slope, wave, shift = np.random.default_rng(2020).normal(size=(3, 20, 1))
    t = (wavelengths() - 380) / 400
    angle = 3 * slope * (t - 0.5) + 2 * wave * np.cos(7 * t + 3 * shift)
    return 0.5 + np.arctan(angle) / np.pi


def by_name(techniques):
    return pytest.mark.parametrize(
        "technique", techniques, ids=lambda technique: technique.short
    )


@by_name(TECHNIQUES)
def test_moments_equal_the_integrals(technique):
    """Compared with adaptive integration of the same piecewise linear function."""
    samples = np.array([380.0, 430, 520, 560, 640, 780])
    values = np.array([0.1, 0.9, 0.3, 0.35, 1.0, 0.6])
    phase = technique.phase(samples)
    actual = technique.moments(values[None], samples, 6)[0]

    def moment(order, function):
        def part(phi):
            return np.interp(phi, phase, values) * function(-order * phi)

        ends = phase[[0, -1]]
        integral, _ = quad(part, *ends, points=phase[1:-1], epsabs=1e-13)
        return integral / np.ptp(phase)

    real = [moment(order, np.cos) for order in range(7)]
    assert_allclose(actual.real, real, atol=1e-12)
    if not technique.mirrored:
        imaginary = [moment(order, np.sin) for order in range(7)]
        assert_allclose(actual.imag, imaginary, atol=1e-12)


@by_name(TECHNIQUES)
@pytest.mark.parametrize("count", [0, 1, 4, 15])
def test_reconstruction_has_its_moments(technique, count, bumps):
    moments = technique.moments(bumps, wavelengths(), count)
    dense = np.linspace(380, 780, 1 << 14)
    reflectance = technique.reconstruct(moments, dense)
    actual = technique.moments(reflectance, dense, count)
    assert_allclose(actual, moments, rtol=0, atol=1e-6)


@pytest.fixture(scope="module")
def rows():
    """Errors of all shipped atlases together."""
    return where(study_moments(read_atlases(), 12).rows(), atlas=ALL_ATLASES)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
@pytest.mark.parametrize("floats", [3, 5, 9, 13])
def test_mirrored_techniques_have_the_least_error(rows, floats):
    mirrored, others = (
        where(rows, floats=floats, mirrored=value) for value in (True, False)
    )

    def least(rows, name):
        return min(row[name] for row in rows)

    error = "delta_e_76_D65_mean"
    assert least(mirrored, error) < least(others, error)
    if floats >= 9:
        assert 2.5 * least(mirrored, "rms_mean") < least(others, "rms_mean")


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
@by_name(MIRRORED)
def test_errors_agree_with_those_of_the_thesis(rows, technique):
    row = pick(rows, mirrored=True, warped=technique.warped, moments=8)
    table = read_reference("moments_todova2020.csv")
    printed = pick(table, method=technique.short, moments="8")
    mean, largest = row["delta_e_76_D65_mean"], row["delta_e_76_D65_max"]
    assert mean == pytest.approx(float(printed["mean"]), abs=0.2)
    assert largest == pytest.approx(float(printed["max"]), abs=0.35)


def test_invalid_studies_are_refused(repository):
    atlas = read_atlas(repository / "atlases" / "tcs.txt")
    for count in (-1, MAX_MOMENTS + 1):
        with raises(OptionError, "option"):
            study_moments({"tcs": atlas}, count)
    with raises(AtlasError, "too-few-entries"):
        study_moments({"empty": Atlas()})
