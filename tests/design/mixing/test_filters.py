"""Filters: thickness is additive, energy is not created."""

from __future__ import annotations

import numpy as np

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.design.mixing import filters


def test_the_thesis_s_example():
    """9.2.1.2: cyan light through an orange and a grey filter."""
    found = filters.stack([[0, 1, 1], [1, 0.5, 0], [0.5, 0.5, 0.5]], [1, 1, 1])
    np.testing.assert_allclose(found, [0, 0.25, 0])


def test_thickness_composes(spectra):
    first, second = (filters.stack(spectra, thickness) for thickness in ([1, 2, 0.5], [2, 0, 1]))
    np.testing.assert_allclose(filters.stack(spectra, [3, 2, 1.5]), first * second)


def test_thickness_3_equals_three_filters(spectra):
    three = np.concatenate([spectra[:, :1]] * 3, axis=1)
    np.testing.assert_allclose(filters.stack(spectra, [3, 0, 0]), filters.stack(three, np.ones(3)))


def test_thickness_0_transmits_everything(spectra):
    assert (filters.stack(spectra, np.zeros(3)) == 1).all()


def test_energy_is_not_created(spectra, parts):
    found = filters.stack(spectra, parts)
    assert (found >= 0).all()
    assert (found <= 1).all()


def test_negative_thickness_raises(spectra):
    with raises(OptionError, "invalid-parts"):
        filters.stack(spectra, [1, -1, 1])
