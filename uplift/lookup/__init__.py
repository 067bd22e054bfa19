"""Asking a cube. Starts in the time that numpy takes: neither the fit nor colour-science is needed."""

from __future__ import annotations

from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import MODES
from uplift.lookup.query import QueryResult, query

__all__ = ["MODES", "Cube", "QueryResult", "load", "query"]
