"""Crowding: lattice size that an atlas needs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.fidelity.materials import SENSOR, entries, forward, large, materials
from uplift import fit
from uplift.colorimetry import observer
from uplift.fit.lattice_size import DIMS, lattice_error
from uplift.lattice import Lattice
from uplift.models import Moments
from uplift.pipeline.options import AXES, Options

TOLERANCES = (0.5, 1.0)
MODEL = Moments(9)
PROBLEM = fit.Problem(MODEL, forward(MODEL), fit.NO_LATTICE)
LIGHTS = [observer.light(name) for name in Options.lights]


def measure() -> dict[str, Any]:
    """Measure the lattice alone, and the choices of ``--dim auto``."""
    crowding, choices = [], []
    for name in ("macbeth", *large()):
        fitted = entries(MODEL, materials(name))
        prior = fitted_prior(fitted)
        crowding += [lattice_errors(name, axis, fitted, prior) for axis in AXES]
        choices += [automatic(name, fitted, prior, tolerance) for tolerance in TOLERANCES]
    return {"lights": list(Options.lights), "crowding": crowding, "lattice_choices": choices}


def fitted_prior(fitted: fit.FittedEntries) -> fit.Prior:
    base = fit.learn_base(PROBLEM, SENSOR, LIGHTS, fit.shipped_library(), fitted).base
    return fit.fit_prior(PROBLEM, SENSOR, fitted, LIGHTS, LIGHTS[1], base)


def lattice_errors(name: str, axis: str, fitted: fit.FittedEntries, prior: fit.Prior) -> dict[str, Any]:
    """Return the median error at the entries, and how many exceed the smaller tolerance, by dim."""
    errors = {}
    for dim in DIMS[1::2]:
        problem = replace(PROBLEM, lattice=Lattice(observer.axis_nodes(axis, dim)))
        distances = lattice_error(problem, prior, prior.corner_share, LIGHTS, fitted)
        errors[str(dim)] = {
            "median": float(np.median(distances)),
            "over": int((distances > TOLERANCES[0]).sum()),
        }
    return {"atlas": name, "entries": len(fitted.rgb), "axis": axis, "errors": errors}


def automatic(name: str, fitted: fit.FittedEntries, prior: fit.Prior, tolerance: float) -> dict[str, Any]:
    """Return the lattice that ``--dim auto`` chooses."""
    axis, dim, over = fit.choose_lattice(
        PROBLEM, prior, prior.corner_share, LIGHTS, fitted, observer.axis_nodes, AXES, tolerance
    )
    return {"atlas": name, "tolerance": tolerance, "dim": dim, "axis": axis, "entries_over": over}
