"""The numbers that the kernel reads: one array in single precision, laid out alike for all languages."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.cube import CubeData
from uplift.lattice import EntryBoxes
from uplift.models import Moments, Sigmoid
from uplift.models.phase import WARPS

BIN_COUNT = 1024
"""Even bins of [0, 1]: few of them contain more than one node."""
TEXEL = 4
"""Rows are padded to whole texels of four channels."""
COLUMNS = 2048
"""Texels in a row of the table as an image: every graphics card that can run the kernel has textures of this width."""
MODES = ("spectra", "moments")

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Table:
    """Numbers, and the constants with which the kernel finds them.

    Parameters
    ----------
    numbers : ndarray, shape (n,)
        Rows of lattice points and entries, multipliers of entries, axis nodes, bins, lists of boxes, boxes.
    constants : mapping
        Values of the constants of `intrinsics`, but for ``WIDTH``.
    """

    numbers: Floats
    constants: dict[str, Any]

    def image(self) -> Floats:
        """Return the numbers as an image of (rows, COLUMNS, 4), filled up with zeros."""
        return as_image(self.numbers)

    def points(self) -> Floats:
        """Return the rows of lattice points as textures of (STRIDE / 4, red, green, blue, 4)."""
        dim, stride = self.constants["DIM"], self.constants["STRIDE"]
        rows = self.numbers[: dim**3 * stride].reshape(dim, dim, dim, -1, TEXEL)
        return np.moveaxis(rows, 3, 0)

    def others(self) -> Floats:
        """Return the numbers behind the rows of lattice points as an image of (rows, COLUMNS, 4)."""
        return as_image(self.numbers[self.constants["LATTICE"] * self.constants["STRIDE"] :])


def as_image(numbers: Floats) -> Floats:
    """Return numbers as an image of (rows, COLUMNS, 4), filled up with zeros.

    Parameters
    ----------
    numbers : ndarray, shape (n,)
        The numbers.

    Returns
    -------
    ndarray, shape (rows, COLUMNS, 4)
    """
    row = COLUMNS * TEXEL
    return np.pad(numbers, (0, -len(numbers) % row)).reshape(-1, COLUMNS, TEXEL)


def make_table(data: CubeData, mode: str) -> Table:
    """Lay out a cube with all lattice points.

    Parameters
    ----------
    data : CubeData
        The cube.
    mode : {"spectra", "moments"}
        Rows hold multipliers, whose spectra are interpolated, or coefficients.

    Returns
    -------
    Table
    """
    model, size = data.model, data.lattice.size
    stride = -(-(model.count + 1) // TEXEL) * TEXEL
    lists, tags = _lists(data.entry_boxes)
    stored = [data.points.coefficients, data.atlas.coefficients]
    if mode == "spectra":
        stored = [model.from_storage(coefficients) for coefficients in stored]
    rows = np.zeros((size + len(data.atlas.names), stride), dtype=np.float32)
    rows[:, : model.count] = np.concatenate(stored)
    rows[:size, model.count] = tags
    sections: dict[str, NDArray[Any]] = {
        "ENTRIES": data.entry_spectra.multipliers,
        "NODES": data.lattice.nodes.astype(np.float32),
        "BINS": _bins(data.lattice.nodes.astype(np.float32)),
        "LISTS": lists,
        "BOXES": _boxes(data.entry_boxes),
    }
    parts, offsets, end = [rows.ravel()], {}, rows.size
    for name, section in sections.items():
        offsets[name] = end
        parts.append(section.ravel())
        end += section.size
    parts.append(np.zeros(-end % TEXEL, dtype=np.float32))
    constants = {
        "COUNT": model.count,
        "ENTRY_COUNT": data.entry_spectra.model.count,
        "STRIDE": stride,
        "DIM": data.lattice.dim,
        "LATTICE": size,
        "BIN_COUNT": BIN_COUNT,
        **offsets,
        **_range(model),
    }
    return Table(np.concatenate(parts, dtype=np.float32), constants)


def _bins(nodes: Floats) -> Floats:
    """Return the last node up to the start of each bin, (BIN_COUNT + 1,)."""
    starts = np.arange(BIN_COUNT + 1) / np.float32(BIN_COUNT)
    last = np.searchsorted(nodes, starts, side="right") - 1
    return np.clip(last, 0, len(nodes) - 2).astype(np.float32)


def _lists(boxes: EntryBoxes) -> tuple[Floats, Floats]:
    """Return lists of entries, each after its length, and the position of each cell's list, 0 for none."""
    cells, entries = boxes.cells
    tags = np.zeros(boxes.lattice.size, dtype=np.float32)
    numbers, first, count = np.unique(cells, return_index=True, return_counts=True)
    lists = [0.0]
    for cell, start, length in zip(numbers.tolist(), first.tolist(), count.tolist(), strict=True):
        tags[cell] = len(lists)
        lists += [length, *entries[start : start + length].tolist()]
    return np.array(lists, dtype=np.float32), tags


def _boxes(boxes: EntryBoxes) -> Floats:
    """Return centres and reciprocals of the distances to the faces, (E, 9); 0 for no distance."""
    low, high = boxes.faces
    below, above = (
        np.divide(1, room, out=np.zeros_like(room), where=room > 0) for room in (boxes.rgb - low, high - boxes.rgb)
    )
    return np.concatenate([boxes.rgb, below, above], axis=1).astype(np.float32)


def _range(model: object) -> dict[str, float]:
    if isinstance(model, Sigmoid):
        return {"START": model.start, "END": model.end}
    assert isinstance(model, Moments)
    phase = model.phase
    low, high = WARPS[phase.warp](np.array([phase.start, phase.end])).tolist()
    return {"START": phase.start, "END": phase.end, "LOW": low, "SCALE": 1 / (high - low)}
