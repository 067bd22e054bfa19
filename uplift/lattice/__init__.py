"""The lattice over RGB: nodes, cells, neighbours, the boxes around atlas entries, and
the table of the nodes.
"""

from uplift.lattice.entry_boxes import (
    MARGIN,
    NO_ROWS,
    BoxHits,
    EntryBoxes,
    Nodes,
    OutsideBoxes,
)
from uplift.lattice.lattice import (
    AXES,
    CORNERS,
    NEIGHBOURS,
    Lattice,
    axis_nodes,
    weighted_sum,
)
from uplift.lattice.point_table import (
    ABSENT_VALUES,
    NO_ENTRY,
    NOT_FITTED,
    PointTable,
    Status,
)

__all__ = [
    "ABSENT_VALUES",
    "AXES",
    "CORNERS",
    "MARGIN",
    "NEIGHBOURS",
    "NOT_FITTED",
    "NO_ENTRY",
    "NO_ROWS",
    "BoxHits",
    "EntryBoxes",
    "Lattice",
    "Nodes",
    "OutsideBoxes",
    "PointTable",
    "Status",
    "axis_nodes",
    "weighted_sum",
]
