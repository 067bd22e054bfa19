"""The fit: atlas entries, prior, seeds, then growth, improvement and storage of the lattice points."""

from __future__ import annotations

from uplift.fit.corner_share import ENTRY_ALONE, CornerShare
from uplift.fit.entries import FittedEntries, fit_entries
from uplift.fit.improve import Improvement
from uplift.fit.lattice import STRATEGIES, LatticeFit, fit_lattice
from uplift.fit.lattice_size import DIMS, LatticeChoice, choose_lattice
from uplift.fit.learnt import LearntBase, has_freedom, learn_base
from uplift.fit.library import Family, families_with, shipped_library
from uplift.fit.looks import (
    MET,
    LookGoal,
    design_reflectance,
    expected_reflectances,
    fit_designs,
    join_entries,
    prior_with_looks,
)
from uplift.fit.objective import Weights
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import NO_LATTICE, Method, Problem, solver_tolerance
from uplift.fit.seed import Collision, Seeds, seed
from uplift.fit.solve import solve
from uplift.fit.starts import Starts
from uplift.fit.unrealisable import Unrealisable, unrealisable

__all__ = [
    "DIMS",
    "ENTRY_ALONE",
    "MET",
    "NO_LATTICE",
    "STRATEGIES",
    "Collision",
    "CornerShare",
    "Family",
    "FittedEntries",
    "Improvement",
    "LatticeChoice",
    "LatticeFit",
    "LearntBase",
    "LookGoal",
    "Method",
    "Prior",
    "Problem",
    "Seeds",
    "Starts",
    "Unrealisable",
    "Weights",
    "choose_lattice",
    "design_reflectance",
    "expected_reflectances",
    "families_with",
    "fit_designs",
    "fit_entries",
    "fit_lattice",
    "fit_prior",
    "has_freedom",
    "join_entries",
    "learn_base",
    "prior_with_looks",
    "seed",
    "shipped_library",
    "solve",
    "solver_tolerance",
    "unrealisable",
]
