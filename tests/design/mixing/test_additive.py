"""Additive mixture is linear, in spectra and in RGB."""

from __future__ import annotations

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.design.mixing import additive


def test_lights_add_up(spectra, parts):
    expected = sum(parts[:, i, None] * spectra[:, i] for i in range(3))
    np.testing.assert_allclose(additive.add_lights(spectra, parts), expected)


def test_areas_are_averaged_for_any_sum_of_parts(spectra, parts):
    expected = np.array([np.average(s, axis=0, weights=p) for s, p in zip(spectra, parts, strict=True)])
    np.testing.assert_allclose(additive.average_areas(spectra, parts), expected)
    np.testing.assert_allclose(additive.average_areas(spectra, 7 * parts), expected)


def test_spectra_and_rgb_agree(sensor, rng):
    spectra = rng.random((3, 81))
    mixed = sensor.rgb(additive.add_lights(spectra, [1, 2, 3]))
    np.testing.assert_allclose(mixed, additive.add_lights(sensor.rgb(spectra), [1, 2, 3]))


@pytest.mark.parametrize("parts", [[1, -1], [1, np.nan], [1, np.inf], 3.0])
def test_invalid_parts_raise(parts):
    with raises(OptionError, "invalid-parts"):
        additive.add_lights(np.ones((2, 5)), parts)


def test_parts_of_0_only_raise():
    with raises(OptionError, "invalid-parts"):
        additive.average_areas(np.ones((2, 5)), [0, 0])
