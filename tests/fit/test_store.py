"""What a cube keeps of a fit: single precision where that is as good, and double where it is not."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from uplift import fit
from uplift.colorimetry import observer
from uplift.fit.store import MAX_LOSS, store
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.models.minimum_norm import forward_map

DIM = 9


@pytest.fixture(scope="module")
def problem():
    sensor, model = observer.sensor(), Moments(9)
    ahead = forward_map(model, sensor.wavelengths, sensor.matrix)
    return fit.Problem(model, ahead, Lattice(observer.axis_nodes("srgb", DIM)))


def distance(problem, coefficients):
    """By numpy alone, as a reader finds it."""
    rgb = problem.model.squash(problem.model.from_storage(coefficients) @ problem.forward.basis.T)
    return np.abs(problem.lattice.points - rgb @ problem.forward.sensor.T).max(axis=1)


def greys(problem, level):
    """Multipliers of flat spectra, one a lattice point."""
    return np.tan(np.pi * (np.asarray(level) - 0.5))[:, None] * problem.model.constant()


def test_single_precision_where_it_costs_nothing(problem):
    multipliers = greys(problem, np.linspace(0.01, 0.99, DIM**3))
    here = distance(problem, problem.model.to_storage(multipliers))
    stored = store(problem, multipliers.copy(), here, lambda done: None)
    assert stored.coefficients.dtype == np.float32
    np.testing.assert_allclose(stored.distance, distance(problem, stored.coefficients), atol=1e-6)
    assert (stored.distance <= here + MAX_LOSS * problem.threshold).all()


def test_double_precision_where_single_would_lose(problem, monkeypatch):
    """With a threshold so small that even rounding counts, found in the last block: all are judged again."""
    monkeypatch.setattr(sys.modules[store.__module__], "BLOCK_POINTS", 256)
    strict = replace(problem, threshold=1e-7)
    multipliers = greys(problem, np.concatenate([np.full(DIM**3 - 9, 0.5), np.linspace(0.9, 0.99, 9)]))
    coefficients = problem.model.to_storage(multipliers)
    here = distance(problem, coefficients)
    stored = store(strict, multipliers.copy(), here, lambda done: None)
    assert stored.coefficients.dtype == np.float64
    np.testing.assert_allclose(stored.coefficients, coefficients, atol=1e-12)
    np.testing.assert_allclose(stored.distance, here, atol=1e-7)


def test_every_block_is_told_of(problem, monkeypatch):
    monkeypatch.setattr(sys.modules[store.__module__], "BLOCK_POINTS", 256)
    told = []
    store(problem, greys(problem, np.full(DIM**3, 0.5)), np.full(DIM**3, np.inf), told.append)
    assert [done.done for done in told] == [256, 512, 729]
