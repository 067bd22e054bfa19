"""The size of lattice that an atlas needs."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import uplift
from tests.conftest import MACBETH
from uplift.atlas import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.base import learn_base
from uplift.fit.dim import DIMS, choose_lattice, lattice_error
from uplift.fit.entries import fit_entries
from uplift.fit.families import shipped_library
from uplift.fit.prior import fit_prior
from uplift.fit.problem import Problem
from uplift.fit.seeds import FULL_ENTRY, EntryBlend, learnt_blend
from uplift.lattice import Lattice
from uplift.models import Moments, reflectance


@pytest.fixture(scope="module")
def stage(sensor):
    """Problem, prior and the entries of the ColorChecker."""
    spectra = on_grid(uplift.read_atlas(MACBETH), sensor.wavelengths)
    spectra = spectra[sensor.contains(sensor.rgb(spectra))]
    lights = tuple(observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3"))
    problem = Problem(sensor, Moments(9), lights, lights[1])
    entries = fit_entries(problem, spectra, sensor.rgb(spectra))
    return problem, fit_prior(problem, entries, learn_base(problem, shipped_library(), entries)[0]), entries


@pytest.mark.parametrize("seed_corners", [True, False])
def test_lattice_error_predicts_the_error_of_the_cube(stage, sensor, monkeypatch, seed_corners):
    """The lattice of the cube is evaluated at the entries without their boxes."""
    monkeypatch.setattr("uplift.pipeline.build.learnt_blend", lambda prior: EntryBlend(0.6))
    problem, prior, entries = stage
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        data = uplift.build(MACBETH, dim=16, seed_corners=seed_corners).data
    trial = lattice_error(problem, data.lattice, prior, FULL_ENTRY if seed_corners else EntryBlend(0.6), entries)
    corners, weights = data.lattice.corners(entries.rgb)
    spectra = reflectance(data.model, data.points.coefficients[corners.ravel()], sensor.wavelengths)
    answered = (weights[..., None] * spectra.reshape(*corners.shape, -1)).sum(axis=1)
    own = reflectance(data.model, data.atlas.coefficients, sensor.wavelengths)
    plain = np.max([delta_e_spectra(lit, answered, own) for lit in problem.lights], axis=0)
    np.testing.assert_allclose(trial, plain, atol=1e-3)


def test_the_smallest_lattice_that_keeps_all_entries_is_chosen(stage):
    problem, prior, entries = stage
    blend, spacings = learnt_blend(prior), ("srgb", "linear")
    spacing, dim, lost = choose_lattice(problem, prior, blend, entries, observer.axis_nodes, spacings, 0.5)
    assert lost == 0
    assert dim in DIMS
    assert spacing in spacings
    for size in [size for size in DIMS if size < dim][-1:]:
        for axis in spacings:
            lattice = Lattice(observer.axis_nodes(axis, size))
            assert lattice_error(problem, lattice, prior, blend, entries).max() > 0.5


def test_without_an_atlas_the_smallest_lattice_is_chosen():
    assert uplift.build(dim="auto").data.lattice.dim == DIMS[0]
