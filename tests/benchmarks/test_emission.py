"""Evidence on emission tables: what predictions must not know, and other methods, on
small tables.
"""

import numpy as np
from numpy.testing import assert_allclose

import uplift
from benchmarks.emission import FAMILIES, lamp_family, planck, predict
from uplift.extras.emission.discs import Lamps
from uplift.extras.emission.lamps import known_lamps
from uplift.extras.emission.lattice import chromaticity

LAMPS = known_lamps()
RADIOMETRY = uplift.load_emission().data.radiometry
UV = chromaticity(LAMPS.power @ RADIOMETRY)


def row(name):
    return LAMPS.names.index(name)


def test_every_lamp_is_in_one_family():
    assert set(map(lamp_family, LAMPS.names)) == set(FAMILIES)
    assert lamp_family("FL11") == lamp_family("F32T8/TL830 (Triphosphor)")


def test_a_table_without_a_lamp_has_its_colour_and_not_its_spectrum():
    few = Lamps(("FL11", "FL1"), LAMPS.power[[row("FL11"), row("FL1")]])
    power, expected = predict(few, lambda name: name[:2], knots=16, rings=3)
    found, actual = (chromaticity(lamps @ RADIOMETRY) for lamps in (power, few.power))
    assert_allclose(found, actual, atol=1e-7)
    assert np.abs(power - few.power).max(axis=1)[0] > 0.1
    assert (expected > 0).all()


def test_tungsten_is_planckian():
    lamp = LAMPS.power[row("A")]
    found = planck(UV[[row("A")]], RADIOMETRY)[0]
    assert_allclose(found / found.sum(), lamp / lamp.sum(), rtol=5e-3)
