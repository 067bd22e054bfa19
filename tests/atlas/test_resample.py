"""Resampling of entries, and validation of entries from Python."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.helpers import raises, warns
from uplift.atlas import Atlas, Entry, on_grid, resample
from uplift.common.errors import AtlasError

GRID = np.arange(380.0, 785.0, 5.0)
UNIT = st.lists(st.floats(0.0, 1.0), min_size=9, max_size=9)


def spectra(*rows, wavelengths=(400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0)):
    return Atlas(tuple(Entry(f"e{i}", np.array(wavelengths), np.array(row)) for i, row in enumerate(rows)))


def test_samples_on_the_grid_are_kept():
    row = [0.1, 0.9, 0.2, 0.2, 0.7, 0.0, 1.0]
    found = on_grid(spectra(row), [400, 450, 500, 550, 600, 650, 700])
    np.testing.assert_allclose(found, [row], rtol=0, atol=1e-15)


def test_extrapolation_is_constant():
    found = on_grid(spectra([0.1, 0.9, 0.2, 0.2, 0.7, 0.0, 0.8]), GRID)
    assert found.shape == (1, 81)
    assert (found[0, GRID <= 400] == 0.1).all()
    np.testing.assert_allclose(found[0, GRID >= 700], 0.8, rtol=0, atol=1e-15)


@settings(max_examples=50)
@given(UNIT)
def test_no_overshoot(row):
    wavelengths = np.linspace(380, 780, 9)
    found = on_grid(spectra(row, wavelengths=wavelengths), GRID)[0]
    for i in range(8):
        between = found[(wavelengths[i] <= GRID) & (wavelengths[i + 1] >= GRID)]
        low, high = sorted(row[i : i + 2])
        assert between.min() >= low - 1e-12
        assert between.max() <= high + 1e-12


def test_one_warning_for_all_clipped_entries():
    rows = ([0.5] * 6 + [1.25], [0.5] * 7, [1.5, 1.0, 0.5, -0.04, 0.5, 0.5, 0.5], [0.5, -0.04] + [0.5] * 5)
    with warns("entry-clipped") as caught:
        found = on_grid(spectra(*rows), GRID)
    assert str(caught[0]) == ("3 entries clipped to [0, 1]: 'e0', 'e2', 'e3'; 'e2' has 1.5 at 380 nm clipped to 1")
    assert (found.min(), found.max()) == (0.0, 1.0)
    assert [clip.name for clip in resample(spectra(*rows), GRID).clips] == ["e0", "e2", "e3"]


def test_noise_is_clipped_without_warning():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = on_grid(spectra([-2e-16, 0.5, 1 + 2e-16, 0.5, -9e-7, 0.5, 0.5]), GRID)
    assert (found.min(), found.max()) == (0.0, 1.0)


def test_entries_are_read_only():
    (entry,) = spectra([0.5] * 7).entries
    with pytest.raises(ValueError, match="read-only"):
        entry.values[0] = 1


@pytest.mark.parametrize(
    ("name", "wavelengths", "values", "code"),
    [
        ("a", [400, 700], [0.5], "atlas"),
        ("a", [400, 700], ["x", "y"], "atlas"),
        ("a", [400, None, 700], [1, 1, 1], "atlas"),
        ("a\nb", [400, 700], [1, 1], "atlas"),
        (" a", [400, 700], [1, 1], "atlas"),
    ],
)
def test_entries_from_python_are_validated(name, wavelengths, values, code):
    with raises(AtlasError, code):
        Entry(name, wavelengths, values)
