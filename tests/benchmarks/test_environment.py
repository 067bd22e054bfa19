"""Environments of measured lamps."""

from __future__ import annotations

import numpy as np

from benchmarks.environment.__main__ import KNOWN, MITSUBA, OTHER_SEED, UNKNOWN, Renders, rows
from benchmarks.environment.skies import HEIGHT, SKIES, WIDTH
from uplift.colorimetry.observer import lamps
from uplift.lights.lookup import load_emission


def test_skies_are_mixtures_of_their_lights():
    known = lamps()
    for sky in SKIES:
        power = sky.power()
        assert power.shape == (HEIGHT, WIDTH, known.power.shape[1])
        basis = np.array([known.power[known.names.index(name)] for name in sky.lamp_names])
        weights, *_ = np.linalg.lstsq(basis.T, power.reshape(-1, power.shape[2]).T, rcond=None)
        assert weights.min() > -1e-9
        np.testing.assert_allclose(weights.T @ basis, power.reshape(-1, power.shape[2]), atol=1e-8)
        assert load_emission().contains(load_emission().rgb(power)).all()


def test_the_brightest_pixel_is_at_the_lamp():
    luminance = SKIES[0].power() @ load_emission().data.cmfs[:, 1]
    assert luminance.argmax() % WIDTH == round(SKIES[0].lamps[0].u * HEIGHT - 0.5)


def test_rows_state_errors_of_patches():
    errors = np.linspace(0, 1, 24)
    names = (KNOWN, UNKNOWN, MITSUBA, OTHER_SEED)
    renders = Renders({}, {"a": np.ones(3)}, {("a", name): errors for name in names})
    found = list(rows(renders))
    assert [row["method"] for row in found] == list(names)
    assert found[0]["worst"] == 1
    np.testing.assert_allclose(found[0]["mean"], 0.5)
