"""Lights and dots: linear, so that spectra and RGB say the same."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import OptionError
from uplift.design.mixing import additive


def test_lights_add_up(spectra, parts):
    expected = sum(parts[:, i, None] * spectra[:, i] for i in range(3))
    np.testing.assert_allclose(additive.lights(spectra, parts), expected)


def test_dots_are_the_mean_whatever_the_parts_sum_to(spectra, parts):
    expected = np.array([np.average(s, axis=0, weights=p) for s, p in zip(spectra, parts, strict=True)])
    np.testing.assert_allclose(additive.dots(spectra, parts), expected)
    np.testing.assert_allclose(additive.dots(spectra, 7 * parts), expected)


def test_spectra_and_rgb_agree(sensor, rng):
    spectra = rng.random((3, 81))
    mixed = sensor.rgb(additive.lights(spectra, [1, 2, 3]))
    np.testing.assert_allclose(mixed, additive.lights(sensor.rgb(spectra), [1, 2, 3]))


@pytest.mark.parametrize("parts", [[1, -1], [1, np.nan], [1, np.inf], 3.0])
def test_parts_are_numbers_from_0_up(parts):
    with pytest.raises(OptionError, match="from 0 up"):
        additive.lights(np.ones((2, 5)), parts)


def test_a_mixture_of_nothing_is_refused():
    with pytest.raises(OptionError, match="no parts"):
        additive.dots(np.ones((2, 5)), [0, 0])
