"""Filters: thickness composes, energy never grows."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.common.errors import OptionError
from uplift.design.mixing import filters


def test_the_thesis_s_example():
    """9.2.1.2: cyan light through an orange and a grey filter."""
    found = filters.stacked([[0, 1, 1], [1, 0.5, 0], [0.5, 0.5, 0.5]], [1, 1, 1])
    np.testing.assert_allclose(found, [0, 0.25, 0])


def test_thickness_composes(spectra):
    first, second = (filters.stacked(spectra, thickness) for thickness in ([1, 2, 0.5], [2, 0, 1]))
    np.testing.assert_allclose(filters.stacked(spectra, [3, 2, 1.5]), first * second)


def test_three_thick_is_three_filters(spectra):
    three = np.concatenate([spectra[:, :1]] * 3, axis=1)
    np.testing.assert_allclose(filters.stacked(spectra, [3, 0, 0]), filters.stacked(three, np.ones(3)))


def test_no_thickness_lets_all_through(spectra):
    assert (filters.stacked(spectra, np.zeros(3)) == 1).all()


def test_energy_never_grows(spectra, parts):
    found = filters.stacked(spectra, parts)
    assert (found >= 0).all()
    assert (found <= 1).all()


def test_negative_thickness_is_refused(spectra):
    with pytest.raises(OptionError, match="from 0 up"):
        filters.stacked(spectra, [1, -1, 1])
