"""Stored coefficients: single precision where it is accurate enough, double precision elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.helpers import residual
from uplift.colorimetry import observer
from uplift.common.progress import ignore_progress
from uplift.fit.growth import Growth
from uplift.fit.problem import Problem, nodes_of
from uplift.fit.seeds import seed
from uplift.fit.store import MAX_LOSS, store
from uplift.lattice import Lattice
from uplift.models import Moments

DIM = 9
LATTICE = Lattice(observer.axis_nodes("srgb", DIM))
NO_SEEDS = seed(LATTICE, np.zeros((0, 3)))


@pytest.fixture(scope="module")
def problem():
    return Problem(observer.sensor(), Moments(9))


def distance(problem, coefficients):
    """Distance evaluated by numpy, as a lookup does."""
    rgb = problem.model.to_reflectance(problem.model.from_storage(coefficients) @ problem.forward.basis.T)
    return np.abs(LATTICE.points - rgb @ problem.forward.sensor.T).max(axis=1)


def greys(problem, level):
    """Multipliers of a flat spectrum per lattice point."""
    return np.tan(np.pi * (np.asarray(level) - 0.5))[:, None] * problem.model.constant()


def grown(problem, multipliers, progress=ignore_progress):
    """Growth that ended with multipliers (n, C)."""
    growth = Growth(problem, nodes_of(LATTICE, problem.sensor, 1e-4), progress)
    growth.multipliers[:] = multipliers
    off = residual(problem.forward, multipliers, LATTICE.points)
    growth.distance[:], growth.rgb[:] = np.abs(off).max(axis=1), LATTICE.points - off
    return growth


def test_single_precision_is_used_where_it_is_accurate(problem):
    multipliers = greys(problem, np.linspace(0.001, 0.999, DIM**3))
    here = distance(problem, problem.model.to_storage(multipliers))
    stored = store(grown(problem, multipliers), NO_SEEDS, None)
    assert stored.coefficients.dtype == np.float32
    np.testing.assert_allclose(stored.distance, distance(problem, stored.coefficients), atol=1e-6)
    assert (stored.distance <= here + MAX_LOSS * problem.threshold).all()


def test_double_precision_is_used_where_single_is_inaccurate(problem, monkeypatch):
    """The threshold is so small that rounding exceeds it in the last block: all points are evaluated again."""
    monkeypatch.setattr("uplift.fit.growth.BLOCK_POINTS", 256)
    strict = replace(problem, threshold=1e-7)
    multipliers = greys(problem, np.concatenate([np.full(DIM**3 - 9, 0.5), np.linspace(0.99, 0.9999, 9)]))
    coefficients = problem.model.to_storage(multipliers)
    here = distance(problem, coefficients)
    stored = store(grown(strict, multipliers), NO_SEEDS, None)
    assert stored.coefficients.dtype == np.float64
    np.testing.assert_allclose(stored.coefficients, coefficients, atol=1e-12)
    np.testing.assert_allclose(stored.distance, here, atol=1e-7)
