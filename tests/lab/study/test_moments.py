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
from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError, OptionError
from uplift.extras.papers.representations.samples import wavelengths
from uplift.lab.study.moments import (
    ALL_ATLASES,
    MAX_MOMENTS,
    TECHNIQUES,
    study_moments,
)

pytestmark = pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")


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

    def moment(order):
        def part(phi):
            return np.interp(phi, phase, values) * np.exp(-1j * order * phi)

        ends = phase[[0, -1]]
        exact = {"points": phase[1:-1], "epsabs": 1e-13, "complex_func": True}
        return quad(part, *ends, **exact)[0] / np.ptp(phase)

    expected = np.array([moment(order) for order in range(7)])
    if technique.mirrored:
        expected = expected.real
    actual = technique.moments(values[None], samples, 6)[0]
    assert_allclose(actual, expected, atol=1e-12)


@by_name(TECHNIQUES)
@pytest.mark.parametrize("count", [0, 4, 15])
def test_reconstruction_has_its_moments(technique, count):
    measured = on_grid(read_atlas("tcs"), wavelengths())
    moments = technique.moments(measured, wavelengths(), count)
    dense = np.linspace(380, 780, 1 << 14)
    reflectance = technique.reconstruct(moments, dense)
    actual = technique.moments(reflectance, dense, count)
    assert_allclose(actual, moments, rtol=0, atol=1e-6)


@pytest.fixture(scope="module")
def rows():
    """Errors of all shipped atlases together."""
    return where(study_moments(read_atlases(), 8).rows(), atlas=ALL_ATLASES)


@by_name(TECHNIQUES[:2])
def test_errors_agree_with_those_of_the_thesis(rows, technique):
    row = pick(rows, mirrored=True, warped=technique.warped, moments=8)
    table = read_reference("moments_todova2020.csv")
    printed = pick(table, method=technique.short, moments="8")
    mean, largest = row["delta_e_76_D65_mean"], row["delta_e_76_D65_max"]
    assert mean == pytest.approx(float(printed["mean"]), abs=0.2)
    assert largest == pytest.approx(float(printed["max"]), abs=0.35)


def test_invalid_studies_are_refused():
    with raises(OptionError, "option"):
        study_moments({"tcs": read_atlas("tcs")}, MAX_MOMENTS + 1)
    with raises(AtlasError, "too-few-entries"):
        study_moments({"empty": Atlas()})
