"""Rivals of cubes: linear worlds, exposures, exact colours, and look-alikes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

import uplift
from benchmarks.materials import materials
from uplift.colorimetry import observer
from uplift.fit import families_with
from uplift.lab.study.burns2019 import reconstruct
from uplift.lab.study.colour_maps import fit_map, term_exponents, terms
from uplift.lab.study.look_alikes import families_like
from uplift.lab.study.metamer_mean import metamer_mean, metamers, nearest_mixture
from uplift.lab.study.rivals import library_spectra

D65 = observer.light("D65")
FL11 = observer.light("FL11")


@pytest.fixture(scope="module")
def measured():
    return materials("tcs").measured


@pytest.fixture(scope="module")
def data():
    return uplift.load().data


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


def test_burns_spectra_have_their_colours_and_the_least_slope(measured):
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


def test_blocks_do_not_change_burns_spectra(measured, monkeypatch):
    xyz = measured @ D65.xyz.T
    whole = reconstruct(D65.xyz, xyz)
    monkeypatch.setattr("uplift.lab.study.burns2019.BLOCK", 5)
    assert_allclose(reconstruct(D65.xyz, xyz), whole, rtol=1e-10)


def test_metamer_means_have_their_colours(data, measured):
    rgb = data.sensor.rgb(measured)
    spectra = metamer_mean(data, library_spectra(("tcs",)), rgb)
    assert_allclose(data.sensor.rgb(spectra), rgb, atol=1e-6)
    assert spectra.min() > 0
    assert spectra.max() < 1

    # No mixture of these has the colour.
    red = np.array([[0.9, 0.05, 0.05]])
    (moved,) = metamer_mean(data, measured[:3], red)
    assert_allclose(data.sensor.rgb(moved), red[0], atol=1e-3)


def test_the_only_metamer_is_found(measured):
    groups = np.array([[0, 1, 2, 3]])
    mixture = np.array([0.1, 0.2, 0.3, 0.4]) @ measured[:4]
    xyz = mixture @ D65.xyz.T
    found = metamers(D65, measured[:4], groups, xyz)
    assert_allclose(found, mixture[None], atol=1e-6)
    assert len(metamers(D65, measured[:4], groups, 2 * D65.white)) == 0
    assert_allclose(nearest_mixture(D65, measured[:4], xyz) @ D65.xyz.T, xyz, atol=1e-9)


def test_families_with_many_look_alikes_are_not_known():
    for name in ("macbeth", "babelcolor"):
        assert families_like(materials(name).measured) == ("checker", "rawtoaces")
    for name in ("pmc", "tcs", "vs", "cie2017", "rawtoaces"):
        spectra = materials(name).measured
        assert families_like(spectra) == families_with(spectra) == (name,)
    assert families_like(np.zeros((0, 81))) == ()


def test_nothing_is_known_without_all_families():
    names = ("checker", "pmc", "tcs", "vs", "cie2017", "rawtoaces", "otsu2018")
    assert library_spectra(names).shape == (0, 81)
