"""Colour maps, Burns 2019 and means of metamers: linear worlds, exposures, exact
colours.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from uplift.atlas import read_atlas
from uplift.colorimetry import observer
from uplift.lab.methods.burns2019 import reconstruct
from uplift.lab.methods.colour_maps import (
    fit_map,
    prepare,
    term_exponents,
    terms,
)
from uplift.lab.methods.metamer_mean import metamer_mean, metamers, nearest_mixture
from uplift.lab.runner import whole, within

D65 = observer.light("D65")
FL11 = observer.light("FL11")


@pytest.fixture(scope="module")
def task(sensor):
    return whole(within(read_atlas("tcs"), sensor), ("tcs",), sensor)


@pytest.fixture(scope="module")
def measured(task):
    return task.queried


@pytest.mark.parametrize(("degree", "count"), [(1, 3), (2, 6), (3, 13)])
def test_terms_are_those_of_the_paper_and_scale_with_the_exposure(degree, count):
    exponents = term_exponents(degree)
    assert len(exponents) == count
    xyz = np.random.default_rng(0).random((5, 3))
    assert_allclose(terms(3 * xyz, exponents), 3 * terms(xyz, exponents))


def test_a_matrix_is_exact_for_three_basis_spectra(measured):
    weights = np.random.default_rng(1).dirichlet(np.ones(3), 40)
    spectra = weights @ measured[:3]
    mapped = fit_map(1, D65, FL11, spectra[:30])(spectra @ D65.xyz.T / D65.white)
    assert_allclose(mapped, spectra @ FL11.xyz.T / FL11.white, atol=1e-9)


def test_maps_know_the_library_without_the_families_of_the_task(task):
    prepared = prepare(task, degree=1)
    to_light = fit_map(1, D65, FL11, task.library)
    expected = to_light(task.sensor.xyz(task.rgb) / D65.white)
    assert_allclose(prepared.colours(task.rgb, FL11), expected)
    errors = prepared.errors(task, [D65, FL11])
    assert errors.delta_e[:, 1].mean() > 100 * errors.delta_e[:, 0].mean()
    assert errors.rms is None


def test_burns_spectra_have_their_colours_and_the_least_slope(measured, monkeypatch):
    monkeypatch.setattr("uplift.lab.methods.burns2019.BLOCK", 5)
    xyz = measured @ D65.xyz.T
    spectra = reconstruct(D65.xyz, xyz)
    assert spectra.min() > 0
    assert_allclose(spectra @ D65.xyz.T, xyz, atol=1e-12)
    assert_allclose(reconstruct(D65.xyz, 0.3 * D65.white[None]), 0.3, atol=1e-12)

    # A general solver, on fewer wavelengths.
    coarse = D65.xyz[:, ::8] * 8
    goal = measured[0, ::8] @ coarse.T
    found = minimize(
        lambda logs: (np.diff(logs) ** 2).sum(),
        np.full(coarse.shape[1], -1.0),
        constraints={"type": "eq", "fun": lambda logs: coarse @ np.exp(logs) - goal},
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert_allclose(reconstruct(coarse, goal[None])[0], np.exp(found.x), atol=1e-4)


def test_metamer_means_have_their_colours(task, measured):
    sensor = task.sensor
    spectra = metamer_mean(sensor, task.library, task.rgb)
    assert_allclose(sensor.rgb(spectra), task.rgb, atol=1e-6)
    assert spectra.min() > 0
    assert spectra.max() < 1

    # No mixture of these has the colour.
    red = np.array([[0.9, 0.05, 0.05]])
    (moved,) = metamer_mean(sensor, measured[:3], red)
    assert_allclose(sensor.rgb(moved), red[0], atol=1e-3)


def test_the_only_metamer_is_found(measured):
    groups = np.array([[0, 1, 2, 3]])
    mixture = np.array([0.1, 0.2, 0.3, 0.4]) @ measured[:4]
    xyz = mixture @ D65.xyz.T
    found = metamers(D65, measured[:4], groups, xyz)
    assert_allclose(found, mixture[None], atol=1e-6)
    assert len(metamers(D65, measured[:4], groups, 2 * D65.white)) == 0
    assert_allclose(nearest_mixture(D65, measured[:4], xyz) @ D65.xyz.T, xyz, atol=1e-9)
