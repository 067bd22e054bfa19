"""Contact sheets: all slices of constant blue of a cube on one image.

One panel per quantity with one colour per node, one tile per blue slice, and a legend;
OpenEXR for colour work, PNG for viewing. The palettes are suitable for colour-vision
deficiencies: a ramp of one hue, dark to light, and orange as highlight. Status colours
differ by at least 16 ΔE00 for protanopes, deuteranopes and tritanopes (Machado et al.
2009), and the frequent regular nodes are inconspicuous.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Mask, StrPath
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write, check_output
from uplift.common.text import pluralise
from uplift.cube import CubeData
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.images import exr
from uplift.extras.images.exr import blue_slices
from uplift.extras.pages.figure import figure_text, matplotlib

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


# Linear grey, on which both bright colours and black are visible. Absent nodes have
# this colour.
BACKGROUND = 0.03
DECADES = 3  # decades of fitting distance below the threshold that the ramp spans

KEY_STEPS = np.linspace(0, 1, 64)  # positions along a ramp in a legend


def _linear(*codes: str) -> Array:
    """Return linear RGB (k, 3) of hexadecimal sRGB codes."""
    return decode(np.array([list(bytes.fromhex(code)) for code in codes]) / 255)


RAMP = _linear("0b1d51", "20509a", "3f8fc5", "8fc7e0", "e6f4f7")
HIGHLIGHT = _linear("ff5a00")
# Colours of every `Status` but absent, in its order. Unfitted nodes have the highlight
# colour.
STATUS = _linear("f0e442", "9bd4f5", "53708a", "00a878", "ff5a00", "6a1b4d")


@dataclass(frozen=True, eq=False)
class Key:
    """A swatch of linear RGB (k, 3), a ramp if k > 1, and its meaning."""

    colours: Array
    text: str


@dataclass(frozen=True, eq=False)
class Panel:
    """A quantity: its title, linear RGB (n, 3) of the nodes, and its legend."""

    title: str
    colours: NDArray[np.floating]
    keys: tuple[Key, ...]


def panels(data: CubeData) -> tuple[Panel, ...]:
    """Return panels of lattice RGB, fitting distance and status, and of standard error
    and round if available.
    """
    quantities = [_rgb_panel(data), _distance_panel(data), _status_panel(data)]
    if data.points.standard_error is not None:
        quantities.append(
            _error_panel(data.points.standard_error, data.error_illuminant)
        )
    if data.points.round is not None:
        quantities.append(
            _round_panel(data.points.round, data.points.round[data.points.present] < 0)
        )
    present = data.points.present[:, None]

    def on_background(panel: Panel) -> Panel:
        background = panel.colours.dtype.type(BACKGROUND)
        return replace(panel, colours=np.where(present, panel.colours, background))

    return tuple(map(on_background, quantities))


def _rgb_panel(data: CubeData) -> Panel:
    ramps = KEY_STEPS[:, None, None] * np.eye(3)
    directions = (
        "red rises to the right",
        "green rises upwards",
        "blue rises from tile to tile",
    )
    keys = tuple(Key(ramps[:, i], direction) for i, direction in enumerate(directions))
    return Panel("Lattice RGB", data.points.rgb, keys)


def _distance_panel(data: CubeData) -> Panel:
    within = np.clip(data.points.distance / data.threshold, 10.0**-DECADES, 1)
    over = data.points.distance > data.threshold
    low = data.threshold / 10**DECADES
    high = data.threshold
    exceeding = (
        f"over the threshold: {_count(over)}; largest distance "
        f"{data.points.distance.max():.2g}"
    )
    keys = (
        Key(_ramp(KEY_STEPS), f"{low:g} or less to {high:g}, logarithmic"),
        Key(HIGHLIGHT, exceeding),
    )
    return Panel(
        "Fitting distance", _highlight_where(over, 1 + np.log10(within) / DECADES), keys
    )


def _status_panel(data: CubeData) -> Panel:
    counts = data.points.counts().items()
    keys = (
        Key(colour[None], f"{label}: {count:,}")
        for colour, (label, count) in zip(STATUS, counts, strict=False)
    )
    return Panel(
        "Status", np.append(STATUS, STATUS[:1], axis=0)[data.points.status], tuple(keys)
    )


def _error_panel(errors: NDArray[np.float32], light: str) -> Panel:
    key = Key(_ramp(KEY_STEPS), f"0 to {errors.max():.2g} ΔE00 under {light}")
    return Panel("Standard error", _ramp(errors / errors.max()), (key,))


def _round_panel(rounds: NDArray[np.int16], not_fitted: Mask) -> Panel:
    none = rounds < 0
    last = max(int(rounds.max()), 0)
    keys = (
        Key(_ramp(KEY_STEPS), f"0 to {last}"),
        Key(HIGHLIGHT, f"fitted in no round: {_count(not_fitted)}"),
    )
    return Panel("Round", _highlight_where(none, rounds / max(last, 1)), keys)


def _count(mask: Mask) -> str:
    return pluralise(int(mask.sum()), "node")


def _highlight_where(mask: Mask, position: Array) -> Array:
    return np.where(mask[:, None], HIGHLIGHT, _ramp(position))


def _ramp(position: Array) -> Array:
    """Return linear RGB (n, 3) for positions (n,) from dark, 0, to light, 1."""
    anchors = np.linspace(0, 1, len(RAMP))
    return np.stack(
        [np.interp(position, anchors, column) for column in RAMP.T], axis=-1
    )
