"""Labels next to markers where they cover nothing, and the panels that they are placed
in.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Mask
from uplift.extras.pages.figure import GREY, INK, figure_text, new_figure

# Arguments of a legend.
LEGEND: dict[str, Any] = {
    "frameon": False,
    "alignment": "left",
    "fontsize": 9,
    "title_fontsize": 9,
    "labelspacing": 0.7,
}
FONT_MARGIN = 1.06  # share by which the font of a reader may be wider
_POINTS_PER_INCH = 72
# Points between a marker and its label without a line that joins them.
_MAX_DISTANCE = 14


@dataclass(frozen=True)
class Label:
    """A text next to the point (x, y) that it names; ``gid`` identifies it in an SVG
    file.
    """

    text: str
    point: tuple[float, float]
    colour: str
    bold: bool
    gid: str


def new_panels(
    rows: int, columns: int, panel: tuple[float, float], margins: Mapping[str, float]
) -> tuple[Any, Any]:
    """Create a figure with a renderer, so that positions are known at once, and its
    axes (rows, columns).

    ``panel`` is the size of a panel in inches, ``margins`` are those of
    ``subplots_adjust``.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = new_figure(columns * panel[0], rows * panel[1], layout=None)
    figure.subplots_adjust(**margins)
    FigureCanvasAgg(figure)
    return figure, figure.subplots(rows, columns, squeeze=False)


def style_title(axes: Any, title: str) -> None:
    """Set a bold title on the left."""
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold", color=INK)


def draw_labels(
    axes: Any,
    labels: Sequence[Label],
    markers: Array,
    line: Array,
    fontsize: float = 7.5,
) -> None:
    """Write the labels that have room next to the ``markers`` (M, 2) and the ``line``
    (k, 2), bold ones first.
    """
    if not labels:
        return
    labels = sorted(labels, key=lambda label: not label.bold)
    scale = _POINTS_PER_INCH / axes.figure.dpi

    def to_points(places: Any) -> Any:
        return scale * axes.transData.transform(places)

    segments = [np.geomspace(*ends, 40) for ends in pairwise(line)]
    line = to_points(np.concatenate([np.empty((0, 2)), *segments]))
    anchors = to_points([label.point for label in labels])
    markers = to_points(markers)
    texts = [
        axes.annotate(
            figure_text(label.text),
            (0, 0),
            xycoords="figure points",
            fontsize=fontsize,
            fontweight="bold" if label.bold else "normal",
            color=label.colour,
            gid=label.gid or None,
        )
        for label in labels
    ]
    renderer = axes.figure.canvas.get_renderer()
    sizes = (
        scale
        * np.array([text.get_window_extent(renderer).size for text in texts])
        * (FONT_MARGIN, 1)
    )
    panel = scale * axes.get_window_extent(renderer).extents
    corners = place_labels(anchors, sizes, np.concatenate([markers, line]), panel)
    for text, corner, size, anchor in zip(texts, corners, sizes, anchors, strict=True):
        if np.isnan(corner).any():
            text.remove()
            continue
        # Where fonts differ, the end of the text at the marker stays.
        is_left = corner[0] + size[0] < anchor[0]
        end = (corner[0] + size[0] * is_left, corner[1])
        text.set(position=end, horizontalalignment="right" if is_left else "left")
        text.xy = end
        nearest = np.clip(anchor, corner, corner + size)
        if np.linalg.norm(nearest - anchor) > _MAX_DISTANCE:
            style = {"arrowstyle": "-", "color": GREY, "linewidth": 0.5}
            axes.annotate(
                "", nearest, anchor, "figure points", "figure points", style, zorder=1
            )


DISTANCES = (6.0, 9.0, 14.0, 20.0, 28.0, 38.0)  # points between a marker and its label
CLEARANCE = (4.5, 2.5)  # points that labels keep from markers, sideways and upwards
_SIDEWAYS = product((1.0, -1.0), (0.0, 0.5, -0.5, 1.0, -1.0))
_ABOVE = [(0.0, 1.0), (0.5, 1.0), (-0.5, 1.0)]
_BELOW = [(0.0, -1.0), (0.5, -1.0), (-0.5, -1.0)]
DIRECTIONS = np.array([*_SIDEWAYS, *_ABOVE, *_BELOW])


def place_labels(anchors: Array, sizes: Array, markers: Array, panel: Array) -> Array:
    """Choose corners (L, 2) for labels in turn, each the nearest to its anchor that
    covers nothing; NaN for none.

    Labels have sizes (L, 2); they keep clear of one another, of markers (M, 2), and
    stay within a panel (4,).
    """
    placed = np.empty((0, 4))
    corners = np.full_like(anchors, np.nan)
    for row, (anchor, size) in enumerate(zip(anchors, sizes, strict=True)):
        options = np.concatenate(
            [_corners_around(anchor, size, distance) for distance in DISTANCES]
        )
        boxes = np.concatenate([options, options + size], axis=1)
        over_label = _overlaps(boxes, placed).any(axis=1)
        over_marker = _contains(boxes, markers).any(axis=1)
        outside = ((boxes[:, :2] < panel[:2]) | (boxes[:, 2:] > panel[2:])).any(axis=1)
        taken = outside | over_label | over_marker
        if not taken.all():
            first = int(taken.argmin())
            corners[row] = options[first]
            placed = np.concatenate([placed, boxes[first : first + 1]])
    return corners


def _corners_around(anchor: Array, size: Array, distance: float) -> Array:
    """Corners (16, 2) of a label at a distance from its anchor, in all directions."""
    return anchor + distance * DIRECTIONS + size * (np.sign(DIRECTIONS) - 1) / 2


def _overlaps(boxes: Array, others: Array) -> Mask:
    low = np.maximum(boxes[:, None, :2], others[None, :, :2])
    high = np.minimum(boxes[:, None, 2:], others[None, :, 2:])
    return np.asarray((high > low).all(axis=-1))


def _contains(boxes: Array, points: Array) -> Mask:
    near = (points > boxes[:, None, :2] - CLEARANCE) & (
        points < boxes[:, None, 2:] + CLEARANCE
    )
    return np.asarray(near.all(axis=-1))
