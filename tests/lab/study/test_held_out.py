"""Held-out errors of an atlas with predictable spectra."""

import numpy as np
import pytest

from tests.helpers import raises
from uplift.atlas import Atlas, Entry
from uplift.colorimetry import observer
from uplift.common.errors import AtlasError
from uplift.common.progress import Progress
from uplift.lab.study.held_out import HALF, LIBRARY_METHODS, NO_ATLAS, SIGMOID, holdout

GRID = observer.grid()


@pytest.fixture(scope="module")
def family():
    """24 spectra of similar colours that share ripples which a smooth spectrum does not
    have.
    """
    ripple = np.cos((GRID - 380) / 400 * 6 * np.pi)
    return Atlas(
        tuple(
            Entry(f"{level:.3f}", GRID, level * (1 + 0.3 * ripple))
            for level in np.linspace(0.3, 0.6, 24)
        )
    )


def test_half_an_atlas_of_similar_spectra_predicts_the_other(family):
    events = []
    records = holdout(family, 2, events.append, dim=8, trust_atlas=True)
    assert events[-1] == Progress("methods", len(records), len(records))
    by_method = {record["cube"]: record for record in records}
    half = by_method[HALF]
    for name in (NO_ATLAS, SIGMOID):
        for key in ("rms", "A", "FL11", "HP1"):
            assert half[key] < 0.6 * by_method[name][key]
    assert (half["colours"], by_method[SIGMOID]["colours"]) == (12, 24)
    assert half["standard_error"]["count"] == 4 * 12
    assert {name for name, record in by_method.items() if record["rms"] is None} == {
        name for name in LIBRARY_METHODS if "matrix" in name or "polynomial" in name
    }


def test_small_atlas_raises(family):
    with raises(AtlasError, "too-few-entries"):
        holdout(Atlas(family.entries[:7]), 1, dim=4)
