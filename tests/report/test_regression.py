"""``uplift check`` can fail: one coefficient nudged is enough."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from uplift.errors import CubeFileError
from uplift.report.regression import LIMITS, Comparison, compare

HERE = Path("cube.uplift")
GREY = 4 * (64 + 8 + 1)
"""A point in the middle of the lattice, whose moments have room on all sides."""


def changed(cube, **changes):
    return dataclasses.replace(cube.data, **changes)


def test_a_cube_passes_against_itself(small_cube):
    comparison = compare(HERE, small_cube.data, small_cube.data)
    assert comparison.failures == ()
    assert set(comparison.measures) == set(LIMITS)
    assert not any(comparison.measures.values())


def test_one_coefficient_nudged_fails(small_cube):
    coefficients = small_cube.data.coefficients.copy()
    coefficients[GREY, 4] += 1e-3
    comparison = compare(HERE, small_cube.data, changed(small_cube, coefficients=coefficients))
    assert "spectra_max" in comparison.failures
    assert any(name.startswith("delta_e") for name in comparison.failures)


def test_a_nudge_of_rounding_passes(small_cube):
    coefficients = small_cube.data.coefficients.copy()
    coefficients[GREY, 4] += 1e-12
    assert compare(HERE, small_cube.data, changed(small_cube, coefficients=coefficients)).failures == ()


def test_another_lattice_rgb_fails(small_cube):
    rgb = small_cube.data.rgb.copy()
    rgb[3, 1] += 1e-4
    assert compare(HERE, small_cube.data, changed(small_cube, rgb=rgb)).failures == ("rgb",)


def test_another_status_fails(small_cube):
    status = small_cube.data.status.copy()
    status[np.flatnonzero(status == 2)[0]] = 4
    comparison = compare(HERE, small_cube.data, changed(small_cube, status=status))
    assert comparison.failures == ("status",)


def test_nan_fails():
    measures = dict.fromkeys(LIMITS, 0.0) | {"spectra_rms": float("nan")}
    assert Comparison(HERE, measures, {}, {}).failures == ("spectra_rms",)


def test_another_lattice_cannot_be_compared(small_cube, macbeth_cube):
    with pytest.raises(CubeFileError, match="another lattice"):
        compare(HERE, small_cube.data, macbeth_cube.data)
