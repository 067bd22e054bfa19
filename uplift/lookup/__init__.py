"""Queries of a cube or an emission table with numpy alone: neither the fit, JAX nor colour-science is imported."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from uplift.lookup.cube import Cube, load
from uplift.lookup.emission import EmissionTable, load_emission
from uplift.lookup.interpolate import MODES
from uplift.lookup.query import QueryResult, query, query_xyz

if TYPE_CHECKING:
    from uplift.lookup.metamer_bounds import Bounds, bounds

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


def __getattr__(name: str) -> Any:
    """Import bounds when they are needed: plain queries start without them."""
    if name not in ("Bounds", "bounds"):
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from uplift.lookup import metamer_bounds

    return getattr(metamer_bounds, name)
