"""Queries of a cube with numpy alone: neither the fit, JAX nor colour-science is imported."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import MODES
from uplift.lookup.query import QueryResult, query, query_xyz

if TYPE_CHECKING:
    from uplift.lookup.metamer_bounds import Bounds, bounds

__all__ = ["MODES", "Bounds", "Cube", "QueryResult", "bounds", "load", "query", "query_xyz"]


_LATER = {"Bounds": "metamer_bounds", "bounds": "metamer_bounds"}
"""Modules that are imported when they are needed: plain queries start without them."""


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    return getattr(import_module(f"{__name__}.{_LATER[name]}"), name)
