"""The lattice over RGB: axes, nodes, cells, neighbours, and the boxes around atlas entries."""

from __future__ import annotations

from uplift.lattice.lattice import CORNERS, Lattice, Status, mix

__all__ = ["CORNERS", "Lattice", "Status", "mix"]
