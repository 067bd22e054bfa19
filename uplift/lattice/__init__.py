"""The lattice over RGB: axes, nodes, cells, neighbours, and the boxes around atlas entries."""

from __future__ import annotations

from uplift.lattice.lattice import CORNERS, Lattice, weighted_sum
from uplift.lattice.point_table import NO_ENTRY, NOT_FITTED, PointTable, Status

__all__ = ["CORNERS", "NOT_FITTED", "NO_ENTRY", "Lattice", "PointTable", "Status", "weighted_sum"]
