"""Colour maps, Burns 2019 and means of metamers: linear worlds, exposures, exact
colours.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from uplift.atlas.atlas import Atlas
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.lab.methods.burns2019 import reconstruct
from uplift.lab.methods.colour_maps import (
    fit_map,
    term_exponents,
)
from uplift.lab.methods.metamer_mean import metamer_mean
from uplift.lab.runner import Task, spectra_of, within

D65 = observer.light("D65")
FL11 = observer.light("FL11")


SENSOR = observer.sensor()
MEASURED = spectra_of(within(read_atlas("tcs"), SENSOR), SENSOR)
TASK = Task(SENSOR, Atlas(), MEASURED, ("tcs",))


@pytest.mark.parametrize(("degree", "count"), [(1, 3), (2, 6), (3, 13)])
def test_maps_are_exact_for_three_basis_spectra_and_scale(degree, count):
    assert len(term_exponents(degree)) == count
    weights = np.random.default_rng(1).dirichlet(np.ones(3), 40)
    spectra = weights @ MEASURED[:3]
    xyz = spectra @ D65.xyz.T / D65.white
    exact = fit_map(degree, D65, FL11, spectra[:30])(xyz)
    assert_allclose(exact, spectra @ FL11.xyz.T / FL11.white, atol=1e-9)
    to_light = fit_map(degree, D65, FL11, MEASURED)
    assert_allclose(to_light(3 * xyz), 3 * to_light(xyz))


def test_burns_spectra_have_their_colours_and_the_least_slope(monkeypatch):
    monkeypatch.setattr("uplift.lab.methods.burns2019.BLOCK", 5)
    xyz = MEASURED @ D65.xyz.T
    spectra = reconstruct(D65.xyz, xyz)
    assert spectra.min() > 0
    assert_allclose(spectra @ D65.xyz.T, xyz, atol=1e-12)

    # A general solver, on fewer wavelengths.
    coarse = D65.xyz[:, ::8] * 8
    goal = MEASURED[0, ::8] @ coarse.T
    found = minimize(
        lambda logs: (np.diff(logs) ** 2).sum(),
        np.full(coarse.shape[1], -1.0),
        constraints={"type": "eq", "fun": lambda logs: coarse @ np.exp(logs) - goal},
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert_allclose(reconstruct(coarse, goal[None])[0], np.exp(found.x), atol=1e-4)


def test_metamer_means_have_their_colours():
    spectra = metamer_mean(SENSOR, TASK.library, TASK.rgb)
    assert_allclose(SENSOR.rgb(spectra), TASK.rgb, atol=1e-6)
    assert spectra.min() > 0
    assert spectra.max() < 1
    red = np.array([[0.9, 0.05, 0.05]])  # the colour of no mixture
    (moved,) = metamer_mean(SENSOR, MEASURED[:3], red)
    assert_allclose(SENSOR.rgb(moved), red[0], atol=1e-3)
