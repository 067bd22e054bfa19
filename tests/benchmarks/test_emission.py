"""Evidence on emission tables: what predictions must not know, and other methods, on
small tables.
"""

from collections import Counter

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.emission import FAMILIES, lamp_family, planck, predict, unknown_lamps
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity

LAMPS = known_lamps()
RADIOMETRY = uplift.load_emission().data.radiometry
UV = chromaticity(LAMPS.power @ RADIOMETRY)


def row(name):
    return LAMPS.names.index(name)


def test_predictions_of_a_lamp_never_know_it_nor_its_family():
    assert set(Counter(map(lamp_family, LAMPS.names))) == set(FAMILIES)
    with pytest.raises(ValueError, match="not enough"):
        lamp_family("candle")
    unknown = unknown_lamps(LAMPS)
    for known in unknown.values():
        assert known.diagonal().all()
        assert (known == known.T).all()
    assert unknown["lamp"].sum() == len(LAMPS)
    assert unknown["family"][row("FL11"), row("F32T8/TL830 (Triphosphor)")]
    assert not unknown["family"][row("FL11"), row("FL1")]


def test_a_table_without_a_lamp_has_its_colour_and_not_its_spectrum():
    few = Lamps(("FL11", "FL1"), LAMPS.power[[row("FL11"), row("FL1")]])
    found = []
    for unknown in (np.eye(2, dtype=bool), np.ones((2, 2), dtype=bool)):
        power, expected = predict(few, unknown, knots=32, rings=4)
        assert_allclose(
            chromaticity(power @ RADIOMETRY),
            chromaticity(few.power @ RADIOMETRY),
            atol=1e-7,
        )
        assert np.abs(power - few.power).max(axis=1)[0] > 0.1
        assert (expected > 0).all()
        found.append(power)
    assert np.abs(found[0] - found[1]).max() > 1e-4


def test_tungsten_is_planckian():
    lamp = LAMPS.power[row("A")]
    found = planck(UV[[row("A")]], RADIOMETRY)[0]
    assert_allclose(found / found.sum(), lamp / lamp.sum(), rtol=5e-3)
