"""The numbers that programs read: one array in single precision, laid out alike for all
languages.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Floats, Mask, Values
from uplift.common.errors import OptionError
from uplift.cube.data import CubeData
from uplift.lattice.entry_boxes import EntryBoxes
from uplift.lookup.refine import LEAST, MOST, REACH, SLOPE, STEEP, pull
from uplift.models.moments import WARPS, Moments, warped
from uplift.models.sigmoid import Sigmoid

BIN_COUNT = 1024
"""Even bins of [0, 1]: few of them contain more than one node."""
TEXEL = 4
"""Rows are padded to whole texels of four channels."""
COLUMNS = 2048
"""Texels in a row of the table as an image: every graphics card that can run the
program has textures of this width.
"""
PLACE = 5
"""Numbers of the place of a colour: weights of four nodes, and that of the lattice."""
MOVED_PLACE = 10
"""The same where answers may be moved: how far, from where, and by which share."""
WARP_NUMBERS = 6
"""Numbers of the two terms of a warp."""
MOVES = {
    "LEAST": LEAST,
    "SLOPE": SLOPE,
    "MOST": MOST,
    "STEEP": STEEP,
    "REACH": REACH,
}
"""Constants of `uplift.lookup.refine`, in the words of programs."""


@dataclass(frozen=True, eq=False)
class Table:
    """Numbers (n,), and the constants with which a program finds them."""

    numbers: Floats
    constants: dict[str, Any]

    def image(self) -> Floats:
        """Return the numbers as a little-endian image of (rows, COLUMNS, 4), filled up
        with zeros.
        """
        numbers = np.pad(self.numbers, (0, -len(self.numbers) % (COLUMNS * TEXEL)))
        return numbers.astype("<f4").reshape(-1, COLUMNS, TEXEL)


def check_complete(data: CubeData, name: str) -> None:
    """Raise `OptionError` for a cube that was built for a scene: programs, and pages
    with one, need all nodes.
    """
    if data.is_sparse:
        problem = (
            f"{name} needs all nodes, but the cube was built for the colours of a scene"
        )
        raise OptionError(
            problem, code="sparse-cube", hint="pass cube.fill_missing().data"
        )


def make_table(data: CubeData, mode: str) -> Table:
    """Lay out a cube with all lattice points: sections by the constants that locate
    them.

    Rows hold multipliers, whose spectra are interpolated, in mode ``spectra``, or
    coefficients in mode ``moments``.
    """
    model = data.model
    size = data.lattice.size
    stride = -(-(model.count + 1) // TEXEL) * TEXEL
    lists, tags = _lists(data, mode)
    stored = [data.points.coefficients, data.atlas.coefficients]
    if mode == "spectra":
        stored = [
            data.smoothed_multipliers(np.arange(size)),
            model.from_storage(data.atlas.coefficients),
        ]
    rows = np.zeros((size + len(data.atlas.names), stride), dtype=np.float32)
    rows[:, : model.count] = np.concatenate(stored)
    rows[:size, model.count] = tags
    sections: dict[str, Values] = {
        "ENTRIES": data.atlas.spectra.multipliers,
        "CELLS": _cells(data.lattice.nodes.astype(np.float32)),
        "BINS": _bins(data.lattice.nodes.astype(np.float32)),
        "LISTS": lists,
        "BOXES": _boxes(data.entry_boxes),
    }
    moving, how = ({}, {}) if data.inexact_cells is None else _moving(data)
    numbers, offsets = concatenate({"ROWS": rows, **sections, **moving})
    constants = {
        "COUNT": model.count,
        "ENTRY_COUNT": data.atlas.spectra.model.count,
        "STRIDE": stride,
        "DIM": data.lattice.dim,
        "LATTICE": size,
        "BIN_COUNT": BIN_COUNT,
        "SPECTRA": int(mode == "spectra"),
        "INEXACT": int(data.inexact_cells is not None),
        "PLACE": PLACE if data.inexact_cells is None else MOVED_PLACE,
        **how,
        **offsets,
        **model_constants(model),
    }
    return Table(numbers, constants)


def moved_cells(data: CubeData, mode: str) -> Mask:
    """Return the cells (dim³,) whose answers are moved to their colours: next to nodes
    that have not theirs.

    In mode ``moments`` these are all cells around corners of such cells.
    """
    if data.inexact_cells is None:
        return np.zeros(data.lattice.size, dtype=bool)
    if mode == "spectra":
        return data.inexact_cells
    return data.lattice.cells_around(data.lattice.corner_points(data.inexact_cells))


def concatenate(sections: Mapping[str, Values]) -> tuple[Floats, dict[str, int]]:
    """Return sections one after the other, each filled up with zeros to whole texels,
    and the index where each begins.
    """
    parts = [_texels(section.ravel()) for section in sections.values()]
    ends = np.cumsum([part.size for part in parts]).tolist()
    numbers = np.concatenate(parts, dtype=np.float32)
    return numbers, dict(zip(sections, [0, *ends], strict=False))


def _texels(numbers: Values) -> Values:
    """Fill numbers up with zeros to whole texels."""
    return np.pad(numbers, (0, -numbers.size % TEXEL))


def _cells(nodes: Floats) -> Floats:
    """Return the node below each cell of an axis, that above, 2 for the last cell, and
    the reciprocal of the step, (dim - 1, 4).

    Reciprocals are rounded up: a step times its reciprocal is not below 1.
    """
    step = np.diff(nodes)
    inverse = np.float32(1) / step
    next_one = np.nextafter(inverse, np.float32(np.inf))
    inverse = np.where(step * inverse < 1, next_one, inverse)
    above = np.append(nodes[1:-1], 2)
    return np.stack([nodes[:-1], above, inverse, 0 * step], axis=-1)


def _bins(nodes: Floats) -> Floats:
    """Return the last node up to the start of each bin, (BIN_COUNT + 1,)."""
    starts = np.arange(BIN_COUNT + 1) / np.float32(BIN_COUNT)
    last = np.searchsorted(nodes, starts, side="right") - 1
    return np.clip(last, 0, len(nodes) - 2).astype(np.float32)


def _lists(data: CubeData, mode: str) -> tuple[Floats, Floats]:
    """Return lists of entries, each after its length, and the position of each cell's
    list, 0 for none.

    Positions are negative in cells whose answers are moved; the list at 1 is then
    empty. In mode ``moments`` these are all cells around corners of inexact ones, whose
    positions have a fraction of 1/2.
    """
    cells, entries = data.entry_boxes.cells
    tags = np.zeros(data.lattice.size, dtype=np.float32)
    numbers, first, count = np.unique(cells, return_index=True, return_counts=True)
    lists = [0.0] if data.inexact_cells is None else [0.0, 0.0]
    for cell, start, length in zip(
        numbers.tolist(), first.tolist(), count.tolist(), strict=True
    ):
        tags[cell] = len(lists)
        lists += [length, *entries[start : start + length].tolist()]
    tags = np.where(moved_cells(data, mode), -np.maximum(tags, 1), tags)
    if data.inexact_corners is not None and mode == "moments":
        tags += np.where(data.inexact_corners, np.copysign(0.5, tags), 0)
    return np.array(lists, dtype=np.float32), tags


def _moving(data: CubeData) -> tuple[dict[str, Values], dict[str, Any]]:
    """Return sections and constants by which answers are moved to their colours
    (`uplift.lookup.refine`).

    ``FACETS`` are the normals of the object-colour solid, and half its width along
    each, around a grey of 1/2.
    """
    sensor = data.sensor
    problem = pull(data.model, sensor)
    half = len(data.solid.normals) // 2  # the others are opposite ones
    width = (data.solid.offsets[:half] + data.solid.offsets[half:]) / 2
    sections = {
        "PULL": np.concatenate([problem.weights, problem.shapes]).T,
        "SCALES": problem.scale,
        "LUMINANCE": sensor.rgb_to_xyz[1],
        "FACETS": np.column_stack([data.solid.normals[:half], width]),
    }
    first, _, step = sensor.range
    how = {
        "SAMPLES": len(sensor.wavelengths),
        "FIRST": first,
        "STEP": step,
        "FACET_COUNT": half,
    }
    return sections, how | {"MARGIN": data.threshold / 2} | MOVES


def _boxes(boxes: EntryBoxes) -> Floats:
    """Return for each axis the centre, the rest that it rounds off, and reciprocals of
    distances to the faces, (E, 3, 4); 0 for none.

    A cube without entries has one row of zeros: gcc warns of reads beyond the table,
    even where they are not reached.
    """
    if not len(boxes.rgb):
        return np.zeros((1, 3, 4), dtype=np.float32)
    low, high = boxes.faces
    below = _reciprocal(boxes.rgb - low)
    above = _reciprocal(high - boxes.rgb)
    centre = boxes.rgb.astype(np.float32)
    columns = (centre, boxes.rgb - centre, below, above)
    return np.stack(columns, axis=-1).astype(np.float32)


def _reciprocal(room: Array) -> Array:
    return np.divide(1, room, out=np.zeros_like(room), where=room > 0)


def model_constants(model: object) -> dict[str, float]:
    """Return the model, its wavelength range in nm, the terms of its warp, and the
    start and reciprocal length of the warped range.
    """
    if isinstance(model, Sigmoid):
        return {"SIGMOIDS": 1, "START": model.start, "END": model.end} | _warp(())
    assert isinstance(model, Moments)
    low, high = warped(model.warp, np.array([model.start, model.end])).tolist()
    return {
        "SIGMOIDS": 0,
        "START": model.start,
        "END": model.end,
        "LOW": low,
        "SCALE": 1 / (high - low),
        **_warp(tuple(chain.from_iterable(WARPS[model.warp]))),
    }


def _warp(terms: tuple[float, ...]) -> dict[str, float]:
    padded = (*terms, *[0.0] * WARP_NUMBERS)[:WARP_NUMBERS]
    words = {f"WARP_{number}": value for number, value in enumerate(padded)}
    return {"WARPED": int(bool(terms))} | words
