"""The size of lattice that an atlas needs."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import uplift
from tests.conftest import MACBETH
from uplift import fit
from uplift.atlas import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.lattice_size import DIMS, choose_lattice, lattice_error
from uplift.lattice import Lattice
from uplift.models import Moments, reflectance
from uplift.models.minimum_norm import forward_map


@pytest.fixture(scope="module")
def stage(sensor):
    """Problem, prior, lights and the entries of the ColorChecker."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    spectra = on_grid(uplift.read_atlas(MACBETH), sensor.wavelengths)
    spectra = spectra[sensor.contains(sensor.rgb(spectra))]
    lights = [observer.light(name) for name in ("D65", "A", "FL2", "FL11", "LED-B3")]
    entries = fit.fit_entries(model, forward, spectra, sensor.rgb(spectra), lights, lights[1], 1e-6)
    problem = fit.Problem(model, forward, fit.NO_LATTICE)
    base = fit.learn_base(problem, sensor, lights, fit.shipped_library(), entries).base
    return problem, fit.fit_prior(problem, sensor, entries, lights, lights[1], base), lights, entries


@pytest.mark.parametrize("seed_corners", [True, False])
def test_lattice_error_predicts_the_error_of_the_cube(stage, sensor, monkeypatch, seed_corners):
    """The lattice of the cube is evaluated at the entries without their boxes."""
    monkeypatch.setattr(fit.Prior, "corner_share", fit.CornerShare(0.6))
    problem, prior, lights, entries = stage
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        data = uplift.build(MACBETH, dim=16, seed_corners=seed_corners).data
    share = fit.ENTRY_ALONE if seed_corners else prior.corner_share
    trial = lattice_error(replace(problem, lattice=data.lattice), prior, share, lights, entries)
    corners, weights = data.lattice.corners(entries.rgb)
    spectra = reflectance(data.model, data.points.coefficients[corners.ravel()], sensor.wavelengths)
    answered = (weights[..., None] * spectra.reshape(*corners.shape, -1)).sum(axis=1)
    own = reflectance(data.model, data.atlas.coefficients, sensor.wavelengths)
    plain = np.max([delta_e_spectra(lit, answered, own) for lit in lights], axis=0)
    np.testing.assert_allclose(trial, plain, atol=1e-3)


def test_the_smallest_lattice_that_keeps_all_entries_is_chosen(stage):
    problem, prior, lights, entries = stage
    spacing, dim, lost = choose_lattice(
        problem, prior, prior.corner_share, lights, entries, observer.axis_nodes, ("srgb", "linear"), 0.5
    )
    assert lost == 0
    assert dim in DIMS
    smaller = [size for size in DIMS if size < dim]
    for size in smaller[-1:]:
        for axis in ("srgb", "linear"):
            trial = replace(problem, lattice=Lattice(observer.axis_nodes(axis, size)))
            assert lattice_error(trial, prior, prior.corner_share, lights, entries).max() > 0.5
    assert spacing in ("srgb", "linear")


def test_without_an_atlas_the_smallest_lattice_is_chosen():
    assert uplift.build(dim="auto").data.lattice.dim == DIMS[0]
