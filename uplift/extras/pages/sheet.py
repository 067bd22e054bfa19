"""Contact sheets: all slices of constant blue of a cube on one image.

One panel per quantity with one colour per node, one tile per blue slice, and a legend;
OpenEXR for colour work, PNG for viewing.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, StrPath
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write, check_output
from uplift.common.text import pluralise
from uplift.cube import CubeData
from uplift.extras.colour.srgb import encode
from uplift.extras.images import exr
from uplift.extras.images.exr import blue_slices
from uplift.extras.pages.figure import figure_text, matplotlib
from uplift.extras.pages.sheet_panels import BACKGROUND, panels

TEXT_GREY = 0.75  # linear grey of the text
# A power of two: division is exact, so the canvas of the text has the size of the sheet
DPI = 64
# The font comes with matplotlib.
STYLE: dict[str, Any] = {
    "family": "DejaVu Sans",
    "va": "center_baseline",
    "usetex": False,
    "parse_math": False,
}

Image = NDArray[np.float32]


def write_sheet(data: CubeData, path: StrPath, *, force: bool = False) -> None:
    """Write the contact sheet of a cube: linear RGB in a single-part ``.exr``, or sRGB
    in a ``.png``.

    Panels show lattice RGB, fitting distance, status, and, of cubes that store them,
    standard error and round.
    """
    check_sheet(path)
    check_output(path, force=force)
    exr.check_slices(data)
    sheet = compose(data)
    image = _draw_text(sheet.image, sheet.labels)
    if Path(path).suffix.lower() == ".exr":
        channels = {letter: image[..., i] for i, letter in enumerate("RGB")}
        exr.write_parts(
            [exr.make_part("sheet", exr.attributes(data), channels)], path, force=force
        )
        return
    matplotlib()
    from matplotlib.image import imsave

    codes = np.rint(255 * encode(image)).astype(np.uint8)
    # Without this entry matplotlib writes its own name and version.
    with atomic_write(path, force=force) as temporary:
        imsave(temporary, codes, format="png", metadata={"Software": "uplift"})


def check_sheet(path: StrPath) -> None:
    """Check the suffix of a contact sheet, which needs matplotlib."""
    if Path(path).suffix.lower() not in (".exr", ".png"):
        problem = "the name of a sheet must end in .exr or .png"
        hint = "name the file .exr or .png"
        raise OutputError(problem, path=path, hint=hint)
    matplotlib()


def _draw_text(image: Image, labels: tuple["Label", ...]) -> Image:
    """Draw the labels on the image (height, width, 3) in the font that comes with
    matplotlib.
    """
    matplotlib()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = image.shape[:2]
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="none")
    for label in labels:
        text = figure.text(
            label.x / width, 1 - label.y / height, figure_text(label.text), **STYLE
        )
        text.set_fontsize(label.size * 72 / DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    cover = np.asarray(canvas.buffer_rgba())[..., 3:] / np.float32(255)
    return image + cover * (np.float32(TEXT_GREY) - image)


# approximate width of a panel in pixels; a node has at least one, so panels of large
# lattices are wider
PANEL = 640
GAP = 3  # pixels between tiles
PANELS_PER_ROW = {3: 3, 4: 2, 5: 3}  # panels per row, by the number of panels
LINES = 3  # lines of the legend below every panel


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


class Layout:
    """Positions in pixels from the top left, for a number of panels with ``dim`` tiles
    each.
    """

    def __init__(self, dim: int, panels: int) -> None:
        self.dim = dim
        self.columns = math.ceil(math.sqrt(dim))  # tiles per row of a panel
        self.rows = math.ceil(dim / self.columns)
        self.scale = max(1, round(PANEL / (self.columns * dim)))  # width of a node
        self.pitch = dim * self.scale + GAP  # distance from tile to tile
        # width and height of a panel's tiles
        self.panel = (self.columns * self.pitch - GAP, self.rows * self.pitch - GAP)
        # height of the text; all spacing around it is a multiple
        self.em = max(13, self.panel[0] // 48)
        # Distance from panel to panel: title, tiles, legend and spacing
        self.block = (
            self.panel[0] + 3 * self.em,
            self.panel[1] + (5 + 2 * LINES) * self.em,
        )
        self.across = PANELS_PER_ROW[panels]
        self.size = (
            self.across * self.block[0] + self.em,
            math.ceil(panels / self.across) * self.block[1] + 4 * self.em,
        )

    def origin(self, panel: int) -> tuple[int, int]:
        """Return the top left pixel of a panel's tiles."""
        row, column = divmod(panel, self.across)
        return 2 * self.em + column * self.block[0], 7 * self.em + row * self.block[1]

    def tile(self, panel: int, blue: int) -> tuple[int, int]:
        """Return the top left pixel of a tile; blue rises in reading order."""
        row, column = divmod(blue, self.columns)
        x, y = self.origin(panel)
        return x + column * self.pitch, y + row * self.pitch

    def keys(self, panel: int) -> Iterator[tuple[int, int]]:
        """Yield the top left pixels of keys below a panel: the left column, then the
        right one.
        """
        x, y = self.origin(panel)
        for half, line in product(range(2), range(LINES)):
            yield (
                x + half * self.panel[0] // 2,
                y + self.panel[1] + (1 + 2 * line) * self.em,
            )


def compose(data: CubeData) -> Sheet:
    """Compose the sheet. Every node is a square of ``Layout.scale`` pixels, in the
    order of `blue_slices`.
    """
    all_panels = panels(data)
    layout = Layout(data.lattice.dim, len(all_panels))
    width, height = layout.size
    image = np.full((height, width, 3), BACKGROUND, dtype=np.float32)
    em = layout.em
    labels = [_heading(data, layout)]
    for number, panel in enumerate(all_panels):
        for blue, plane in enumerate(blue_slices(panel.colours, layout.dim)):
            large = plane.repeat(layout.scale, axis=0).repeat(layout.scale, axis=1)
            _paint(image, layout.tile(number, blue), large)
        x, y = layout.origin(number)
        labels.append(Label(x, y - em, panel.title, 1.2 * em))
        for key, (left, top) in zip(panel.keys, layout.keys(number), strict=False):
            # a square, or a strip for a ramp
            width = em if len(key.colours) == 1 else 6 * em
            strip = key.colours[np.arange(width) * len(key.colours) // width]
            _paint(image, (left, top), np.broadcast_to(strip, (em, width, 3)))
            labels.append(Label(left + width + 0.6 * em, top + em / 2, key.text, em))
    return Sheet(image, tuple(labels))


def _paint(image: NDArray[np.float32], corner: tuple[int, int], patch: Array) -> None:
    x, y = corner
    height, width = patch.shape[:2]
    image[y : y + height, x : x + width] = patch


def _heading(data: CubeData, layout: Layout) -> Label:
    model = data.model
    sensor = data.sensor
    points = data.points
    present = (
        ""
        if data.complete_cells is None
        else f"{np.count_nonzero(points.present):,} of "
    )
    facts = (
        f"{present}{data.lattice.dim}³ nodes",
        f"{model.name}, {pluralise(model.count, 'coefficient')}",
        f"{sensor.space} under {sensor.illuminant}",
        pluralise(len(data.atlas.names), "atlas entry"),
        f"threshold {data.threshold:g}",
    )
    return Label(2 * layout.em, 2.75 * layout.em, "  ·  ".join(facts), 1.4 * layout.em)
