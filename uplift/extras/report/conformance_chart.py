"""Chart of the conformance kit: 1,000 colours at which lookups of a cube go wrong."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.lattice.entry_boxes import EntryBoxes

COLUMNS = 40
ROWS = 25
COUNT = COLUMNS * ROWS
GREYS = 21
FURTHER = 120
"""Colours of each kind of which a cube has any number."""
ENTRIES = 24
"""Entries of which the chart has colours, at most."""
POSITIONS = {
    "centre": 0.0,
    "inside the box": 0.5,
    "inside the face": 0.99,
    "outside the face": 1.01,
}
"""Distances from the colour of an entry, where the face of its box is at 1."""
DARK = 0.03
"""Largest linear RGB of dark colours, of which half have a channel of 0: these are
nearest to colours that no reflectance has.
"""
SEED = 1


@dataclass(frozen=True, eq=False)
class Chart:
    """Patches in reading order: names, and linear RGB (1000, 3) in [0, 1], which single
    precision holds.
    """

    names: tuple[str, ...]
    rgb: Array


def make_chart(cube: CubeData) -> Chart:
    """Choose the colours of a cube: greys, corners, nodes, faces of cells, boxes of
    entries, edges of the gamut, dark colours, and random ones.

    They follow from the nodes and the entries of the cube alone.
    """
    names = []
    colours = []
    for name, colour in _colours(cube):
        names.append(name)
        colours.append(colour)
    rgb = np.array(colours[:COUNT], dtype=np.float32).clip(0, 1)
    return Chart(tuple(names[:COUNT]), rgb.astype(float))


def _colours(cube: CubeData) -> Iterator[tuple[str, Array]]:
    """Yield more names and colours than a chart has."""
    rng = np.random.default_rng(SEED)
    for value in np.linspace(0, 1, GREYS):
        yield f"grey {value:g}", np.full(3, value)
    for corner in np.ndindex(2, 2, 2):
        yield f"corner {_digits(corner)}", np.array(corner, dtype=float)
    yield from _entry_colours(cube.atlas.names, cube.entry_boxes, rng)
    nodes = cube.lattice.nodes
    size = cube.lattice.size
    for point in rng.choice(size, min(FURTHER, size), replace=False):
        place = np.array(np.unravel_index(point, (len(nodes),) * 3))
        yield f"node {_digits(place)}", nodes[place]
    for number, colour in enumerate(rng.random((FURTHER, 3))):
        axis = number % 3
        colour[axis] = rng.choice(nodes)
        yield f"face of a cell {number}", colour
    for number, colour in enumerate(rng.random((FURTHER, 3))):
        colour[number % 3] = number // 3 % 2
        yield f"edge of the gamut {number}", colour
    for number, colour in enumerate(rng.random((FURTHER, 3))):
        colour[number % 3] *= number // 3 % 2
        yield f"dark colour {number}", DARK * colour
    for number, colour in enumerate(rng.random((COUNT, 3))):
        yield f"random colour {number}", colour


def _entry_colours(
    names: tuple[str, ...], boxes: EntryBoxes, rng: np.random.Generator
) -> Iterator[tuple[str, Array]]:
    """Yield the colours of entries, and colours near the faces of their boxes, on rays
    through two random points of a face.
    """
    low, high = boxes.faces
    step = -(-len(names) // ENTRIES) or 1
    for entry in range(0, len(names), step):
        for ray in range(2):
            across = rng.uniform(-1, 1, 3)
            across /= np.abs(across).max()
            reach = np.where(across > 0, high[entry], low[entry]) - boxes.rgb[entry]
            for position, distance in POSITIONS.items():
                if ray and not distance:
                    continue
                colour = boxes.rgb[entry] + distance * np.abs(across) * reach
                yield f"{names[entry]}, {position} {ray + 1}", colour


def _digits(numbers: Iterable[int]) -> str:
    return " ".join(str(int(number)) for number in numbers)
