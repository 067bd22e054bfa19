"""Materials under lights: scales, checks, and the same colours as the rest of the project sees."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UnknownNameError
from uplift.scene.wavelengths import RenderSetup, grid, make_setup


def test_white_has_y_1_under_every_light(spiky: RenderSetup) -> None:
    np.testing.assert_allclose(spiky.whites[:, 1], 1, rtol=1e-12)
    assert spiky.lights == ("FL2", "FL11")


def test_colours_are_those_of_the_project_on_its_own_grid() -> None:
    reflectances = np.random.default_rng(1).uniform(0, 1, (5, 81))
    seen = make_setup(reflectances, ["A"], wavelengths=observer.grid())
    light = observer.light("A")
    np.testing.assert_allclose(seen.xyz[0], reflectances @ light.xyz.T, rtol=1e-12)
    np.testing.assert_allclose(seen.lab[0], lab(reflectances @ light.xyz.T, light.white), rtol=1e-9)


@pytest.mark.parametrize("count", [101, 64])
def test_grids_of_any_step_see_nearly_the_same(smooth: RenderSetup, count: int) -> None:
    nm = np.linspace(380, 770, count)
    coarse = make_setup(smooth.curves(nm), smooth.lights, wavelengths=nm)
    np.testing.assert_allclose(coarse.lab, smooth.lab, atol=0.2)


def test_a_light_named_twice_counts_once(checker: Array) -> None:
    assert make_setup(checker, ["A", "A"]).lights == ("A",)


def test_some_of_the_materials(smooth: RenderSetup) -> None:
    few = smooth.only([3, 1])
    np.testing.assert_array_equal(few.xyz, smooth.xyz[:, [3, 1]])


@pytest.mark.parametrize(
    ("reflectances", "nm"),
    [
        (np.ones((2, 390)), grid()),
        (np.ones(391), grid()),
        (np.ones((0, 391)), grid()),
        (np.full((1, 391), np.nan), grid()),
        (np.full((1, 391), -0.1), grid()),
        (np.ones((1, 391)), np.geomspace(380, 770, 391)),
        (np.ones((1, 391)), grid()[::-1]),
        (np.ones((1, 3)), [400, 500, 600]),
    ],
)
def test_refuses_what_is_no_material_on_a_grid(reflectances: Array, nm: Array) -> None:
    with pytest.raises(OptionError, match="; give"):
        make_setup(reflectances, ["A"], wavelengths=nm)


def test_refuses_no_light_and_unknown_lights(checker: Array) -> None:
    with pytest.raises(OptionError, match="no light"):
        make_setup(checker, [])
    with pytest.raises(UnknownNameError, match="D65"):
        make_setup(checker, ["D 65"])
