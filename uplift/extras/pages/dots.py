"""Dots: markers, and texts next to them that cover no marker, no line and no other
text.
"""

import io
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.extras.pages.figure import GREY, INK, figure_text

MARKER_SIZES = {"*": 9.5, "D": 5.5}
"""Points; others are 6.5 wide."""
LABEL_SIZE = 7.5
"""Points of the font of labels."""
CLEARANCE = 4.0
"""Points that labels keep from the middle of markers."""
DISTANCES = (6.0, 42.0)
"""Smallest and largest distance in points between a dot and its label."""
LEADER = 9.0
"""Distance in points from which a line joins a dot and its label."""


@dataclass(frozen=True)
class Dot:
    """A marker at (x, y), and the text next to it.

    ``marker`` is the name of one of matplotlib, ``key`` identifies the marker and its
    text in SVG as ``marker-KEY`` and ``label-KEY``. Bold texts are placed first; a text
    without room is left out.
    """

    x: float
    y: float
    text: str = ""
    colour: str = INK
    marker: str = "o"
    hollow: bool = False
    bold: bool = False
    key: str = ""
    size: float = 1.0


def draw_dot(axes: Any, dot: Dot) -> None:
    """Draw the marker of a dot."""
    face, edge = ("white", dot.colour) if dot.hollow else (dot.colour, "white")
    axes.plot(
        dot.x,
        dot.y,
        gid=f"marker-{dot.key}" if dot.key else None,
        zorder=3 if dot.bold else 2,
        linestyle="",
        marker=dot.marker,
        markersize=dot.size * MARKER_SIZES.get(dot.marker, 6.5),
        markerfacecolor=face,
        markeredgecolor=edge,
        markeredgewidth=1.2 * dot.size if dot.hollow else 0.5,
        clip_on=False,
    )


def write_labels(axes: Any, dots: Sequence[Dot]) -> None:
    """Write the texts of dots that have room, bold ones first. The layout of the figure
    must be fixed.
    """
    named = sorted((dot for dot in dots if dot.text), key=lambda dot: not dot.bold)
    if not named:
        return
    # Texts take the first free place of a fixed list, so equal figures have equal
    # texts. adjustText moves them by forces: its results vary, and cover markers.
    import textalloc

    point = axes.figure.dpi / 72
    width = axes.get_window_extent().width
    nearest, farthest = np.multiply(DISTANCES, point / width)
    curves = [_places(curve) for curve in axes.lines if _is_joined(curve)]
    axes.autoscale(enable=False)
    # It prints a line if no text has room.
    with redirect_stdout(io.StringIO()):
        _, _, texts, leaders = textalloc.allocate(
            axes,
            [dot.x for dot in named],
            [dot.y for dot in named],
            [figure_text(dot.text) for dot in named],
            x_scatter=[dot.x for dot in dots],
            y_scatter=[dot.y for dot in dots],
            scatter_sizes=[CLEARANCE * point] * len(dots),
            x_lines=[x for x, _ in curves] or None,
            y_lines=[y for _, y in curves] or None,
            textsize=LABEL_SIZE,
            fontweight=["bold" if dot.bold else "normal" for dot in named],
            textcolor=[dot.colour for dot in named],
            linecolor=GREY,
            linewidth=0.5,
            margin=0.003,
            min_distance=nearest,
            max_distance=farthest,
            nbr_candidates=1000,
            draw_all=False,
            va="bottom",
        )
    for dot, text, leader in zip(named, texts, leaders, strict=True):
        if text is not None and dot.key:
            text.set_gid(f"label-{dot.key}")
        if leader is not None and _length(leader) < LEADER * point:
            leader.remove()


def _is_joined(line: Any) -> bool:
    return line.get_linestyle() != "None" and len(line.get_xydata()) > 1


def _places(line: Any) -> Array:
    """Return the points (2, n) of a line in data, those of thresholds too."""
    pixels = line.get_transform().transform(line.get_xydata())
    places: Array = line.axes.transData.inverted().transform(pixels).T
    return places


def _length(line: Any) -> float:
    """Return the length of a straight line in pixels."""
    first, last = line.axes.transData.transform(line.get_xydata())
    return float(np.hypot(*(last - first)))
