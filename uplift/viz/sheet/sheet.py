"""Layout and composition of a contact sheet in numpy: one panel per quantity, one tile per blue slice."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.io.slices.slices import blue_slices
from uplift.viz.sheet.panels import BACKGROUND, Key, Panel, panels

PANEL = 640
"""Approximate width of a panel in pixels; sheets are 1000 to 2000 pixels wide."""
GAP = 3
"""Pixels between tiles."""
PANELS_PER_ROW = {3: 3, 4: 2, 5: 3}
"""Panels per row, by the number of panels."""
LINES = 3
"""Lines of the legend below every panel."""


class Label(NamedTuple):
    """Text that starts at pixel x and is centred on pixel y, ``size`` pixels high."""

    x: float
    y: float
    text: str
    size: float


@dataclass(frozen=True, eq=False)
class Sheet:
    """Linear RGB (height, width, 3), and the text to draw on it."""

    image: NDArray[np.float32]
    labels: tuple[Label, ...]


@dataclass(frozen=True)
class Layout:
    """Positions in pixels from the top left, for a number of panels with ``dim`` tiles each."""

    dim: int
    panels: int

    @property
    def columns(self) -> int:
        """Tiles per row of a panel."""
        return math.ceil(math.sqrt(self.dim))

    @property
    def rows(self) -> int:
        """Rows of tiles in a panel."""
        return math.ceil(self.dim / self.columns)

    @property
    def scale(self) -> int:
        """Width of a node in pixels."""
        return max(1, round(PANEL / (self.columns * self.dim)))

    @property
    def pitch(self) -> int:
        """Distance from tile to tile."""
        return self.dim * self.scale + GAP

    @property
    def panel(self) -> tuple[int, int]:
        """Width and height of a panel's tiles."""
        return self.columns * self.pitch - GAP, self.rows * self.pitch - GAP

    @property
    def em(self) -> int:
        """Height of the text; all spacing around it is a multiple."""
        return max(13, self.panel[0] // 48)

    @property
    def panels_per_row(self) -> int:
        """Panels per row of the sheet."""
        return PANELS_PER_ROW[self.panels]

    @property
    def block(self) -> tuple[int, int]:
        """Distance from panel to panel: title, tiles, legend and spacing."""
        return self.panel[0] + 3 * self.em, self.panel[1] + (5 + 2 * LINES) * self.em

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the sheet."""
        down = math.ceil(self.panels / self.panels_per_row)
        return self.panels_per_row * self.block[0] + self.em, down * self.block[1] + 4 * self.em

    def origin(self, panel: int) -> tuple[int, int]:
        """Return the top left pixel of a panel's tiles."""
        row, column = divmod(panel, self.panels_per_row)
        return 2 * self.em + column * self.block[0], 7 * self.em + row * self.block[1]

    def tile(self, panel: int, blue: int) -> tuple[int, int]:
        """Return the top left pixel of a tile; blue rises in reading order."""
        row, column = divmod(blue, self.columns)
        x, y = self.origin(panel)
        return x + column * self.pitch, y + row * self.pitch


def compose(data: CubeData) -> Sheet:
    """Compose the sheet. Every node is a square of ``Layout.scale`` pixels, in the order of `blue_slices`."""
    all_panels = panels(data)
    layout = Layout(data.lattice.dim, len(all_panels))
    width, height = layout.size
    image = np.full((height, width, 3), BACKGROUND, dtype=np.float32)
    labels = [_heading(data, layout)]
    for number, panel in enumerate(all_panels):
        _paint_tiles(image, layout, number, panel)
        _paint_keys(image, layout, number, panel.keys)
        labels += _captions(layout, number, panel)
    return Sheet(image, tuple(labels))


def _paint_tiles(image: NDArray[np.float32], layout: Layout, number: int, panel: Panel) -> None:
    for blue, plane in enumerate(blue_slices(panel.colours, layout.dim)):
        large = plane.repeat(layout.scale, axis=0).repeat(layout.scale, axis=1)
        _paint(image, layout.tile(number, blue), large)


def _paint_keys(image: NDArray[np.float32], layout: Layout, number: int, keys: tuple[Key, ...]) -> None:
    for key, position in zip(keys, _key_positions(layout, number), strict=False):
        width = _swatch_width(layout, key)
        strip = key.colours[np.arange(width) * len(key.colours) // width]
        _paint(image, position, np.broadcast_to(strip, (layout.em, width, 3)))


def _paint(image: NDArray[np.float32], corner: tuple[int, int], patch: Array) -> None:
    x, y = corner
    height, width = patch.shape[:2]
    image[y : y + height, x : x + width] = patch


def _key_positions(layout: Layout, number: int) -> Iterator[tuple[int, int]]:
    """Yield the top left pixels of keys below a panel: the left column, then the right one."""
    x, y = layout.origin(number)
    width, height = layout.panel
    for index in range(2 * LINES):
        half, line = divmod(index, LINES)
        yield x + half * width // 2, y + height + (1 + 2 * line) * layout.em


def _swatch_width(layout: Layout, key: Key) -> int:
    """Return the width of a key's swatch in pixels: a square, or a strip for a ramp."""
    return layout.em if len(key.colours) == 1 else 6 * layout.em


def _captions(layout: Layout, number: int, panel: Panel) -> Iterator[Label]:
    em = layout.em
    x, y = layout.origin(number)
    yield Label(x, y - em, panel.title, 1.2 * em)
    for key, (left, top) in zip(panel.keys, _key_positions(layout, number), strict=False):
        yield Label(left + _swatch_width(layout, key) + 0.6 * em, top + em / 2, key.text, em)


def _heading(data: CubeData, layout: Layout) -> Label:
    model, sensor = data.model, data.sensor
    facts = (
        f"{_present_of(data)}{data.lattice.dim}³ points",
        f"{model.name}, {model.count} coefficients",
        f"{sensor.space} under {sensor.illuminant}",
        f"{len(data.atlas.names)} atlas entries",
        f"threshold {data.threshold:g}",
    )
    return Label(2 * layout.em, 2.75 * layout.em, "  ·  ".join(facts), 1.4 * layout.em)


def _present_of(data: CubeData) -> str:
    """Return the number of present nodes if some are absent."""
    return "" if data.complete_cells is None else f"{np.count_nonzero(data.points.present):,} of "
