"""The rendered ColorChecker, small and noisy: layout, reference, errors."""

# ruff: noqa: E402  (what follows imports Mitsuba)
import pytest
from numpy.testing import assert_allclose

from tests.parts import MITSUBA, need

need(MITSUBA)

from benchmarks import render as demo
from benchmarks.checker import Layout, chart, measured_spectra, start_mitsuba
from uplift.colorimetry.observer import light

LAYOUT = Layout(patch=4, gap=2)
SPP = 32


@pytest.fixture(scope="module")
def painted():
    return chart()


@pytest.fixture(scope="module")
def renders(painted, repository):
    """All methods under all lights; Mitsuba's own uplift stands in for the cubes that
    are not stored.
    """
    start_mitsuba()
    built_in = [{"type": "rgb", "value": rgb} for rgb in painted.painted.tolist()]
    cube = str(repository / "cubes" / "moments-8-macbeth.uplift")
    methods = {
        demo.REFERENCE: measured_spectra(painted),
        **dict.fromkeys((demo.MITSUBA, demo.PLAIN, demo.ATLAS_17), built_in),
        demo.ATLAS: [
            {"type": "uplift", "cube": cube, "rgb": rgb}
            for rgb in painted.painted.tolist()
        ],
    }
    return demo.render(methods, LAYOUT, SPP)


def test_reference_equals_the_integral_of_the_measured_spectra(painted, renders):
    for name in demo.LIGHTS:
        expected = painted.measured @ light(name).xyz.T
        found = LAYOUT.means(renders.images[name, demo.REFERENCE])
        assert_allclose(found.mean(axis=0), expected.mean(axis=0), rtol=0.03)
        assert_allclose(found[:, 1], expected[:, 1], rtol=0.1)


def test_cube_with_atlas_has_less_than_half_the_error_of_mitsuba(painted, renders):
    for name in demo.LIGHTS[1:]:
        cube, mitsuba = (
            renders.delta_e[name, method][~painted.outside].mean()
            for method in (demo.ATLAS, demo.MITSUBA)
        )
        assert cube < mitsuba / 2
