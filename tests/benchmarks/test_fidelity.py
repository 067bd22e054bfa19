"""Rows of the page on fidelity."""

from __future__ import annotations

import numpy as np

from benchmarks.fidelity.cubes import CUBES, halves
from benchmarks.fidelity.materials import materials
from uplift.lab.study.held_out import HoldoutSplit, baseline_errors, spectrum_errors


def test_rows_of_halves_are_numbers(small_cube):
    """Baselines without spectra have no rms, which a page cannot store."""
    measured = materials("macbeth").measured
    known, queried = measured[::2], measured[1::2]
    found = dict.fromkeys(CUBES, spectrum_errors(queried + 0.01, queried))
    found |= baseline_errors(small_cube.data, known, queried)
    assert any(np.isnan(each.means()).any() for each in found.values())
    split = HoldoutSplit(found, np.zeros(len(queried)), None, None)
    rows = list(halves("macbeth", 9, (split, split)))
    assert [row["cube"] for row in rows] == list(CUBES)
    for row in rows:
        numbers = [row["rms"]["mean"], *(each["mean"] for each in row["errors"].values())]
        assert np.isfinite(numbers).all()
