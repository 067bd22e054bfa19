"""The arrays that a build computes for every node, and how each node was fitted."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Indices, Mask
from uplift.common.text import pluralise

NO_ENTRY = -1
"""Value of `PointTable.entry` at nodes that no atlas entry seeds."""
NOT_FITTED = -1
"""Value of `PointTable.round` at nodes that no round of growth fitted."""


class Status(IntEnum):
    """How a node was fitted."""

    ATLAS_PRIMARY = 0
    ATLAS_CORNER = 1
    REGULAR = 2
    IMPROVED = 3
    UNFITTED = 4
    UNREALISABLE = 5
    ABSENT = 6

    @property
    def label(self) -> str:
        """The name in lower-case words, such as ``"atlas primary"``."""
        return self.name.lower().replace("_", " ")


ABSENT_VALUES = {"status": int(Status.ABSENT), "entry": NO_ENTRY, "round": NOT_FITTED}
"""Values at absent nodes, by the name of the array; 0 in all others."""


@dataclass(frozen=True, eq=False, repr=False)
class PointTable:
    """Arrays over the n nodes of a lattice, in their order (blue fastest).

    ``coefficients`` (n, C) are the argument of ``model.from_storage``: float32 or,
    where single precision is not accurate enough, float64. ``rgb`` (n, 3) is the linear
    RGB that the stored spectrum evaluates to, and ``distance`` (n,) max |target RGB −
    rgb|. ``entry`` (n,) is the row of the atlas entry that seeds a node, −1 for none.
    ``round`` (n,), stored with ``debug=True`` only, is the round of growth that fitted
    the node, −1 for none. ``standard_error`` (n,) is the ΔE00 from the answer within
    which 68 % of measurements are expected, None if the atlas is too small to estimate
    it. Absent nodes have status ``ABSENT``, entry and round −1, and 0 everywhere else.
    """

    coefficients: NDArray[Any]
    rgb: NDArray[np.float32]
    distance: NDArray[np.float32]
    status: NDArray[np.uint8]
    entry: NDArray[np.int32]
    round: NDArray[np.int16] | None = None
    standard_error: NDArray[np.float32] | None = None

    def __repr__(self) -> str:
        coefficients = pluralise(self.coefficients.shape[-1], "coefficient")
        return f"PointTable({pluralise(len(self.status), 'node')}, {coefficients} each)"

    @cached_property
    def present(self) -> Mask:
        """(n,) True where a node has a spectrum: everywhere, unless the cube was built
        for a scene.
        """
        return self.status != Status.ABSENT

    def holds(self, points: Indices) -> Mask:
        """Whether all nodes of each row (n, K) are present: (n,)."""
        present: Mask = np.all(self.present[points], axis=1)
        return present

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The arrays by name, without those that are None."""
        names = [field.name for field in fields(self)]
        return {
            name: getattr(self, name)
            for name in names
            if getattr(self, name) is not None
        }

    def spread(self, numbers: Indices, size: int) -> "PointTable":
        """Return the table of ``size`` nodes whose rows, at the nodes ``numbers`` (n,),
        are those of this one.
        """
        columns = {}
        for name, rows in self.columns.items():
            shape = (size, *rows.shape[1:])
            absent = ABSENT_VALUES.get(name)
            # Pages of zeros take no memory before they are written.
            columns[name] = (
                np.zeros(shape, rows.dtype)
                if absent is None
                else np.full(shape, absent, rows.dtype)
            )
            columns[name][numbers] = rows
        return PointTable(**columns)

    def restricted_to(self, points: Indices) -> "PointTable":
        """Return the table with all nodes but some (k,) absent."""
        rows = {name: column[points] for name, column in self.columns.items()}
        return PointTable(**rows).spread(points, len(self.status))

    def filled(self, points: Indices, rows: Mapping[str, NDArray[Any]]) -> "PointTable":
        """Return the table with columns of ``rows`` at absent nodes ``points`` (k,);
        others keep `ABSENT_VALUES` there.

        Coefficients become float64 if those of the rows are.
        """
        columns = self.columns
        present = np.flatnonzero(self.present)  # the others take no memory
        for name, column in self.columns.items():
            added = rows.get(name, np.full(len(points), ABSENT_VALUES.get(name, 0)))
            kind = (
                np.result_type(column, added)
                if name == "coefficients"
                else column.dtype
            )
            columns[name] = np.concatenate([column[present], added]).astype(kind)
        return PointTable(**columns).spread(
            np.concatenate([present, points]), len(self.status)
        )

    def counts(self) -> dict[str, int]:
        """Count the nodes of each status, by `Status.label`."""
        numbers = np.bincount(self.status, minlength=len(Status))
        return {status.label: int(numbers[status]) for status in Status}
