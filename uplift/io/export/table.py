"""The numbers that programs read: one array in single precision, laid out alike for all languages."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.cube import CubeData
from uplift.lattice import EntryBoxes
from uplift.models import Moments, Sigmoid
from uplift.models.moments import WARPS, warped

BIN_COUNT = 1024
"""Even bins of [0, 1]: few of them contain more than one node."""
TEXEL = 4
"""Rows are padded to whole texels of four channels."""
COLUMNS = 2048
"""Texels in a row of the table as an image: every graphics card that can run the program has textures of this width."""
MODES = ("spectra", "moments")

Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Table:
    """Numbers (n,), and the constants with which a program finds them."""

    numbers: Floats
    constants: dict[str, Any]

    def image(self) -> Floats:
        """Return the numbers as a little-endian image of (rows, COLUMNS, 4), filled up with zeros."""
        numbers = np.pad(self.numbers, (0, -len(self.numbers) % (COLUMNS * TEXEL)))
        return numbers.astype("<f4").reshape(-1, COLUMNS, TEXEL)


def make_table(data: CubeData, mode: str) -> Table:
    """Lay out a cube with all lattice points: sections by the constants that locate them.

    Rows hold multipliers, whose spectra are interpolated, in mode ``spectra``, or coefficients in mode ``moments``.
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
    numbers, offsets = concatenate({"ROWS": rows, **sections})
    constants = {
        "COUNT": model.count,
        "ENTRY_COUNT": data.entry_spectra.model.count,
        "STRIDE": stride,
        "DIM": data.lattice.dim,
        "LATTICE": size,
        "BIN_COUNT": BIN_COUNT,
        "SPECTRA": int(mode == "spectra"),
        **offsets,
        **_model_constants(model),
    }
    return Table(numbers, constants)


def concatenate(sections: Mapping[str, NDArray[Any]]) -> tuple[Floats, dict[str, int]]:
    """Return sections one after the other, filled up with zeros to whole texels, and the index where each begins."""
    ends = np.cumsum([section.size for section in sections.values()]).tolist()
    parts = [section.ravel() for section in sections.values()]
    numbers = np.concatenate([*parts, np.zeros(-ends[-1] % TEXEL)], dtype=np.float32)
    return numbers, dict(zip(sections, [0, *ends], strict=False))


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


def _model_constants(model: object) -> dict[str, float]:
    """Return the model, its wavelength range in nm, and the start and reciprocal length of the warped range."""
    if isinstance(model, Sigmoid):
        return {"SIGMOIDS": 1, "START": model.start, "END": model.end}
    assert isinstance(model, Moments)
    low, high = warped(model.warp, np.array([model.start, model.end])).tolist()
    terms = [number for term in WARPS[model.warp] for number in term]
    warp = {f"WARP_{number}": value for number, value in enumerate((*terms, 0.0, 0.0, 0.0)[:6])} if terms else {}
    constants = {"SIGMOIDS": 0, "WARPED": int(bool(terms)), "START": model.start, "END": model.end}
    return constants | warp | {"LOW": low, "SCALE": 1 / (high - low)}
