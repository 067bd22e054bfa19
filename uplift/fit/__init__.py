"""The fit: atlas entries, prior, seeds, then growth, improvement and storage of the
nodes.
"""

from uplift.fit.base import learn_base
from uplift.fit.entries import (
    FittedEntries,
    Marquardt,
    fit_entries,
    join_entries,
    with_multipliers,
)
from uplift.fit.families import Family, families_with, shipped_library
from uplift.fit.growth_outward import grow_outward, shells
from uplift.fit.kriging import posterior
from uplift.fit.left_out_families import family_errors, leave_out_families
from uplift.fit.prior import Prior, fit_prior
from uplift.fit.problem import Nodes, Problem, nodes_of

__all__ = [
    "Family",
    "FittedEntries",
    "Marquardt",
    "Nodes",
    "Prior",
    "Problem",
    "families_with",
    "family_errors",
    "fit_entries",
    "fit_prior",
    "grow_outward",
    "join_entries",
    "learn_base",
    "leave_out_families",
    "nodes_of",
    "posterior",
    "shells",
    "shipped_library",
    "with_multipliers",
]
