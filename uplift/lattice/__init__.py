"""The lattice over RGB: axes, nodes, cells, neighbours, and the boxes around atlas entries."""

from __future__ import annotations

from uplift.lattice.lattice import CORNERS, Lattice, Status, weighted_sum

__all__ = ["CORNERS", "Lattice", "Status", "weighted_sum"]
