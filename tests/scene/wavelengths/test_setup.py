"""Materials under lights: scales, validation, agreement with the sensors of the package."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UnknownNameError
from uplift.scene.wavelengths import grid, make_setup


def test_colours_agree_with_observer_light_on_its_grid() -> None:
    reflectances = np.random.default_rng(1).uniform(0, 1, (5, 81))
    setup = make_setup(reflectances, ["A"], wavelengths=observer.grid())
    light = observer.light("A")
    np.testing.assert_allclose(setup.whites[:, 1], 1, rtol=1e-12)
    np.testing.assert_allclose(setup.xyz[0], reflectances @ light.xyz.T, rtol=1e-12)
    np.testing.assert_allclose(setup.lab[0], lab(reflectances @ light.xyz.T, light.white), rtol=1e-9)


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
def test_invalid_materials_or_grids_raise(reflectances: Array, nm: Array) -> None:
    with raises(OptionError):
        make_setup(reflectances, ["A"], wavelengths=nm)


def test_missing_and_unknown_lights_raise(checker: Array) -> None:
    with raises(OptionError):
        make_setup(checker, [])
    with raises(UnknownNameError, "unknown-illuminant") as caught:
        make_setup(checker, ["D 65"])
    assert "D65" in caught.value.hint
