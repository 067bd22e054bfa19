"""Contact sheets: all slices of constant blue of a cube, a panel for each quantity.

Status colours differ by at least 16 ΔE00 for protanopes, deuteranopes and tritanopes
(Machado et al. 2009), and the frequent regular nodes are inconspicuous.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, StrPath
from uplift.common.files import check_output
from uplift.common.text import pluralise
from uplift.cube.data import CubeData
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.images import exr, slices
from uplift.extras.pages.figure import HIGHLIGHT, check_suffix, matplotlib, write_figure
from uplift.extras.pages.marks import error_map, line, picture
from uplift.extras.pages.panels import Axis, Panel, draw

FORMATS = (".exr", ".png")
WIDTH = 5.0
"""Inches of a panel."""
DPI = 130
DECADES = 3
"""Decades of fitting distance below the threshold that colours span."""
STATUS = ("#f0e442", "#9bd4f5", "#53708a", "#00a878", HIGHLIGHT, "#6a1b4d")
"""Colours of every `Status` but absent, in its order."""


def write_sheet(data: CubeData, path: StrPath, *, force: bool = False) -> None:
    """Write the contact sheet of a cube: sRGB in a ``.png``, or linear RGB in a
    single-part ``.exr``.

    Panels show lattice RGB, fitting distance, status, and, of cubes that store them,
    standard error and round.
    """
    suffix = check_suffix(path, FORMATS)
    check_output(path, force=force)
    slices.check_slices(data)
    figure = draw_sheet(data)
    if suffix == ".png":
        write_figure(figure, path, force=force)
        return
    figure.canvas.draw()
    codes = np.asarray(figure.canvas.buffer_rgba())[..., :3]
    image = decode(codes / 255).astype(np.float32)
    channels = {letter: image[..., i] for i, letter in enumerate("RGB")}
    part = exr.make_part("sheet", exr.attributes(data), channels)
    exr.write_parts([part], path, force=force)


def draw_sheet(data: CubeData) -> Any:
    """Draw the sheet; every node has at least a pixel."""
    panels = [_rgb_panel(data), _distance_panel(data), _status_panel(data)]
    errors = data.points.standard_error
    if errors is not None:
        title = f"Standard error, ΔE00 under {data.error_illuminant}"
        mark = error_map(_tiles(data, errors), float(errors.max()))
        panels.append(Panel([mark], title))
    rounds = data.points.round
    if rounds is not None:
        panels.append(_round_panel(data, rounds))
    columns = 2 if len(panels) == 4 else 3
    pixels = math.ceil(math.sqrt(data.lattice.dim)) * (data.lattice.dim + 1)
    dpi = max(DPI, math.ceil(1.2 * pixels / WIDTH))
    title = _heading(data)
    return draw(panels, columns, WIDTH, legend="below", title=title, scale="", dpi=dpi)


def mosaic(slices: Array) -> Array:
    """Arrange square slices (dim, dim, dim, ...) in reading order, with a gap of NaN
    between them.
    """
    dim = len(slices)
    columns = math.ceil(math.sqrt(dim))
    rows = math.ceil(dim / columns)
    size = (rows * (dim + 1) - 1, columns * (dim + 1) - 1)
    tiles = np.full((*size, *slices.shape[3:]), np.nan)
    for number, plane in enumerate(slices):
        top, left = (dim + 1) * np.array(divmod(number, columns))
        tiles[top : top + dim, left : left + dim] = plane
    return tiles


def _tiles(data: CubeData, values: NDArray[Any]) -> Array:
    """Arrange values (n,) or colours (n, 3) of the nodes; absent ones are NaN."""
    present = data.points.present.reshape(-1, *[1] * (values.ndim - 1))
    shown = np.where(present, values, np.nan)
    return mosaic(slices.blue_slices(shown, data.lattice.dim))


def _colours(data: CubeData, colours: Array) -> Array:
    """Arrange encoded colours (n, 3) of the nodes on white."""
    return np.nan_to_num(_tiles(data, colours), nan=1.0)


def _rgb_panel(data: CubeData) -> Panel:
    directions = "red rises to the right, green upwards, blue from tile to tile"
    codes = _colours(data, encode(data.points.rgb))
    return Panel([picture(codes)], "Lattice RGB", Axis(directions))


def _distance_panel(data: CubeData) -> Panel:
    distance = data.points.distance
    low = data.threshold / 10**DECADES
    tiles = _tiles(data, np.maximum(distance, low))
    mark = error_map(tiles, data.threshold, lowest=low, over=HIGHLIGHT)
    over = pluralise(int((distance > data.threshold).sum()), "node")
    caption = f"over the threshold: {over}; largest {distance.max():.2g}"
    return Panel([mark], "Fitting distance", Axis(caption))


def _status_panel(data: CubeData) -> Panel:
    codes = matplotlib().colors.to_rgba_array([*STATUS, "white"])[:, :3]
    marks = [picture(_colours(data, codes[data.points.status]))]
    for colour, (label, count) in zip(
        STATUS, data.points.counts().items(), strict=False
    ):
        key = f"{label}: {count:,}"
        marks.append(line([], [], key, colour, marker="s", linestyle=""))
    return Panel(marks, "Status")


def _round_panel(data: CubeData, rounds: NDArray[Any]) -> Panel:
    last = max(int(rounds.max()), 1)
    is_unfitted = (rounds < 0) & data.points.present
    shown = np.where(rounds < 0, last + 1, rounds)
    mark = error_map(_tiles(data, shown), last, over=HIGHLIGHT)
    caption = f"fitted in no round: {pluralise(int(is_unfitted.sum()), 'node')}"
    return Panel([mark], "Round", Axis(caption))


def _heading(data: CubeData) -> str:
    model = data.model
    sensor = data.sensor
    facts = [f"{data.lattice.dim}³ nodes"]
    if data.is_sparse:
        facts = [f"{np.count_nonzero(data.points.present):,} of {facts[0]}"]
    facts += [
        f"{model.name}, {pluralise(model.count, 'coefficient')}",
        f"{sensor.space} under {sensor.illuminant}",
        pluralise(len(data.atlas.names), "atlas entry"),
        f"threshold {data.threshold:g}",
    ]
    return "  ·  ".join(facts)
