"""Queries of a cube with numpy alone: neither the fit, JAX nor colour-science is imported."""

from __future__ import annotations

from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import MODES
from uplift.lookup.query import QueryResult, query, query_xyz

__all__ = ["MODES", "Cube", "QueryResult", "load", "query", "query_xyz"]
