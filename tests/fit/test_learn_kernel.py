"""Kernels learnt from atlases of which the best kernel is known, and the change of colours by coefficients."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from tests.conftest import MACBETH
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit.kriging import Kernel
from uplift.fit.learn_kernel import DEFAULT, MIN_ENTRIES, learn_kernel, visible_change
from uplift.fit.smooth import smooth
from uplift.fit.solve import solve
from uplift.models import Moments
from uplift.models.minimum_norm import forward_map

RNG = np.random.default_rng(8)
PLACES = RNG.uniform(0, 60, (150, 3))
APART = np.linalg.norm(PLACES[:, None] - PLACES[None], axis=-1)
ALL_VISIBLE = np.broadcast_to(np.eye(3), (150, 1, 3, 3))


def drawn_from(kernel):
    return np.linalg.cholesky(kernel(APART) + 1e-9 * np.eye(150)) @ RNG.normal(size=(150, 3))


@pytest.mark.parametrize("truth", [Kernel(48.0, 0.01), Kernel(24.0, 1.0), Kernel(6.0, 0.03)])
def test_a_large_atlas_tells_its_kernel(truth):
    learnt = learn_kernel(PLACES, drawn_from(truth), ALL_VISIBLE)
    assert truth.length / 2 <= learnt.length <= truth.length * 2
    assert truth.nugget / 10 <= learnt.nugget <= truth.nugget * 10


def test_families_and_mixtures_differ():
    family, mixture = (learn_kernel(PLACES, drawn_from(Kernel(30.0, nugget)), ALL_VISIBLE) for nugget in (0.01, 2))
    assert family.nugget < mixture.nugget


def test_few_entries_keep_the_default():
    few = slice(0, MIN_ENTRIES - 1)
    deviations = RNG.normal(size=(150, 3))
    assert learn_kernel(PLACES[few], deviations[few], ALL_VISIBLE[few]) == DEFAULT


def test_invisible_deviations_keep_the_default():
    assert learn_kernel(PLACES, RNG.normal(size=(150, 3)), 0 * ALL_VISIBLE) == DEFAULT
    assert learn_kernel(PLACES, np.zeros((150, 3)), ALL_VISIBLE) == DEFAULT


def test_visible_change_ranks_metameric_changes_by_delta_e(sensor):
    """A change of the coefficients, made exact in colour by the solver, against the linear prediction."""
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    lights = [observer.light(name) for name in ("A", "FL11")]
    measured = on_grid(read_atlas(MACBETH), sensor.wavelengths)
    measured = measured[sensor.contains(sensor.rgb(measured))]
    coloured = partial(solve, model, forward, target=sensor.rgb(measured), tolerance=1e-9, max_passes=32)
    plain = coloured(start=smooth(model, forward)(sensor.rgb(measured))).multipliers
    moments = model.to_storage(plain)
    change = 1e-3 * RNG.normal(size=moments.shape) / (1 + np.arange(9))
    moved = coloured(start=model.from_storage(moments + change)).multipliers
    before, after = (model.squash(each @ forward.basis.T) for each in (plain, moved))
    linear = np.linalg.norm(np.einsum("elkc,ec->elk", visible_change(model, forward, lights, before), change), axis=-1)
    actual = np.stack([delta_e_spectra(light, before, after) for light in lights], axis=1)
    assert 0.4 < np.sqrt((linear**2).mean() / (actual**2).mean()) < 1.2  # it neglects the roughest parts
    assert np.corrcoef(linear.ravel(), actual.ravel())[0, 1] > 0.7


def test_the_light_of_the_build_shows_no_change(sensor):
    model = Moments(9)
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    grey = np.full((1, len(sensor.wavelengths)), 0.4)
    assert np.abs(visible_change(model, forward, [sensor.light], grey)).max() < 1e-9
