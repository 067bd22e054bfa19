"""Evidence on emission tables: what predictions must not know, other methods,
exactness, on small tables.
"""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.emission import (
    FAMILIES,
    exactness,
    lamp_family,
    planck,
    predict,
    spokes,
    unknown_lamps,
)
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.emission.lookup import EmissionTable

LAMPS = known_lamps()
TABLE = uplift.load_emission()
RADIOMETRY = TABLE.data.radiometry
UV = chromaticity(LAMPS.power @ RADIOMETRY)


@pytest.fixture(scope="module")
def unknown():
    return unknown_lamps(
        LAMPS, on_grid(read_atlas("macbeth"), observer.grid()), RADIOMETRY
    )


def row(name):
    return LAMPS.names.index(name)


def test_predictions_of_a_lamp_never_know_it_nor_its_family(unknown):
    assert set(Counter(map(lamp_family, LAMPS.names))) == set(FAMILIES)
    with pytest.raises(ValueError, match="not enough"):
        lamp_family("candle")
    for known in unknown.values():
        assert known.diagonal().all()
        assert (known == known.T).all()
    assert unknown["lamp"].sum() == len(LAMPS)
    assert unknown["near-duplicates"][row("D65"), row("ID65")]
    assert not unknown["near-duplicates"][row("D65"), row("A")]
    assert unknown["family"][row("FL11"), row("F32T8/TL830 (Triphosphor)")]
    assert not unknown["family"][row("FL11"), row("FL1")]


def test_a_table_without_a_lamp_has_its_colour_and_not_its_spectrum():
    few = Lamps(("FL11", "FL1"), LAMPS.power[[row("FL11"), row("FL1")]])
    found = predict(
        few,
        {"lamp": np.eye(2, dtype=bool), "both": np.ones((2, 2), dtype=bool)},
        knots=32,
        rings=4,
    )
    for power, expected in found.values():
        assert_allclose(
            chromaticity(power @ RADIOMETRY),
            chromaticity(few.power @ RADIOMETRY),
            atol=1e-7,
        )
        assert np.abs(power - few.power).max(axis=1)[0] > 0.1
        assert (expected > 0).all()
    assert np.abs(found["lamp"][0] - found["both"][0]).max() > 1e-4


def test_tungsten_is_planckian():
    lamp = LAMPS.power[row("A")]
    found = planck(UV[[row("A")]], RADIOMETRY, observer.grid())[0]
    assert_allclose(found / found.sum(), lamp / lamp.sum(), rtol=5e-3)


def test_exactness_is_measured_from_white_to_the_locus():
    uv = spokes(TABLE, 12, 5)
    share = TABLE.data.lattice.polar(uv - TABLE.data.lattice.white)[2]
    assert (share.min(), share.max()) == (
        pytest.approx(0, abs=1e-12),
        pytest.approx(1, abs=1e-12),
    )
    double, single = exactness(TABLE, uv)
    assert double["uv_error"] < 1e-6
    assert single["uv_error"] < 1e-5
    assert min(double["min_power"], single["min_power"]) >= 0
    data = TABLE.data
    wrong = EmissionTable(
        replace(
            data, spectra=data.spectra * np.linspace(0.9, 1.1, 81, dtype=np.float32)
        )
    )
    assert next(exactness(wrong, uv))["uv_error"] > 1e-3
