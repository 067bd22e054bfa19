"""Crowding: lattice size that an atlas needs."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.fidelity.materials import entries, large, materials, problem_of
from uplift.colorimetry import observer
from uplift.fit.base import learn_base
from uplift.fit.dim import DIMS, choose_lattice, lattice_error
from uplift.fit.entries import FittedEntries
from uplift.fit.families import shipped_library
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.seeds import learnt_blend
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.pipeline.options import AXES, Options

TOLERANCES = (0.5, 1.0)
MODEL = Moments(9)
PROBLEM = problem_of(MODEL)


def measure() -> dict[str, Any]:
    """Measure the lattice alone, and the choices of ``--dim auto``."""
    crowding, choices = [], []
    for name in ("macbeth", *large()):
        fitted = entries(MODEL, materials(name))
        prior = fitted_prior(fitted)
        crowding += [lattice_errors(name, axis, fitted, prior) for axis in AXES]
        choices += [automatic(name, fitted, prior, tolerance) for tolerance in TOLERANCES]
    return {"lights": list(Options.lights), "crowding": crowding, "lattice_choices": choices}


def fitted_prior(fitted: FittedEntries) -> Prior:
    base, _ = learn_base(PROBLEM, shipped_library(), fitted)
    return fit_prior(PROBLEM, fitted, base)


def lattice_errors(name: str, axis: str, fitted: FittedEntries, prior: Prior) -> dict[str, Any]:
    """Return the median error at the entries, and how many exceed the smaller tolerance, by dim."""
    errors = {}
    for dim in DIMS[1::2]:
        lattice = Lattice(observer.axis_nodes(axis, dim))
        distances = lattice_error(PROBLEM, lattice, prior, learnt_blend(prior), fitted)
        errors[str(dim)] = {
            "median": float(np.median(distances)),
            "over": int((distances > TOLERANCES[0]).sum()),
        }
    return {"atlas": name, "entries": len(fitted.rgb), "axis": axis, "errors": errors}


def automatic(name: str, fitted: FittedEntries, prior: Prior, tolerance: float) -> dict[str, Any]:
    """Return the lattice that ``--dim auto`` chooses."""
    axis, dim, over = choose_lattice(PROBLEM, prior, learnt_blend(prior), fitted, observer.axis_nodes, AXES, tolerance)
    return {"atlas": name, "tolerance": tolerance, "dim": dim, "axis": axis, "entries_over": over}
