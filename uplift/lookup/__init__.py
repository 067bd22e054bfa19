"""Queries of a cube or an emission table with numpy alone: neither the fit, JAX nor colour-science is imported."""

from __future__ import annotations

from uplift.lookup.bounds import Bounds, bounds
from uplift.lookup.cube import Cube, load
from uplift.lookup.emission import EmissionTable, load_emission
from uplift.lookup.interpolate import MODES
from uplift.lookup.query import QueryResult, query, query_xyz

__all__ = [
    "MODES",
    "Bounds",
    "Cube",
    "EmissionTable",
    "QueryResult",
    "bounds",
    "load",
    "load_emission",
    "query",
    "query_xyz",
]
