"""Held-out errors of an atlas with predictable spectra."""

from functools import partial

import numpy as np

from uplift.atlas.atlas import Atlas, Entry
from uplift.colorimetry import observer
from uplift.lab.runner import divided
from uplift.lab.study import held_out
from uplift.lab.study.held_out import HALF, NO_ATLAS, SIGMOID

GRID = observer.grid()


def test_half_an_atlas_of_similar_spectra_predicts_the_other(monkeypatch):
    """They share ripples that a smooth spectrum does not have."""
    ripples = 1 + 0.3 * np.cos((GRID - 380) / 400 * 6 * np.pi)
    levels = np.linspace(0.3, 0.6, 24)
    entries = (Entry(f"{level:.3f}", GRID, level * ripples) for level in levels)
    family = Atlas(tuple(entries))
    monkeypatch.setattr(held_out, "LIBRARY_METHODS", {})
    monkeypatch.setattr(held_out, "divided", partial(divided, seeds=1))
    records = held_out.holdout(family, dim=8)
    by_method = {record["cube"]: record for record in records}
    half = by_method[HALF]
    for name in (NO_ATLAS, SIGMOID):
        for key in ("rms", "A", "FL11", "HP1"):
            assert half[key] < 0.6 * by_method[name][key]
    assert (half["colours"], by_method[SIGMOID]["colours"]) == (12, 24)
    assert half["standard_error"]["count"] == 2 * 12
