"""What pictures of error over cost share: axes, the Pareto front as a staircase, names beside markers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.viz.figure import GREY, INK, PALE
from uplift.viz.labels import place

POINTS = 72
"""An inch, whatever the resolution."""
BEHIND = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.6}
"""A label on top of a crowd can still be read."""
LED = 14
"""Points from a marker beyond which a line leads to its label."""


@dataclass(frozen=True)
class Name:
    """A ``text`` that stands beside the ``point`` (x, y) it names; ``gid`` is its name in an SVG file."""

    text: str
    point: tuple[float, float]
    colour: str
    bold: bool
    gid: str


def set_up(axes: Any, title: str, across: str) -> None:
    """Logarithmic axes, a grid behind, no frame."""
    axes.set(xscale="log", yscale="log", xlabel=across)
    axes.set_title(title, loc="left", fontsize=11, fontweight="bold", color=INK)
    axes.minorticks_off()
    axes.grid(color=PALE, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def pareto_steps(front: Array, right: float) -> Array:
    """A Pareto front (k, 2), from the left, as a staircase up to ``right``: who stands above it is beaten in both
    respects."""
    x = np.append(front[:, 0].repeat(2)[1:], right)
    return np.stack([x, front[:, 1].repeat(2)], axis=1)


def label(axes: Any, names: Sequence[Name], markers: Array, line: Array) -> None:
    """Write names where they cover least of the ``markers`` (M, 2) and of a ``line`` (k, 2)."""
    if not names:
        return
    scale = POINTS / axes.figure.dpi
    line = np.concatenate([np.geomspace(*pair, 40) for pair in pairwise(line)])
    anchors, markers, line = (
        scale * axes.transData.transform(points) for points in ([name.point for name in names], markers, line)
    )
    texts = [
        axes.annotate(
            name.text,
            (0, 0),
            xycoords="figure points",
            fontsize=7.5,
            fontweight="bold" if name.bold else "normal",
            color=name.colour,
            gid=name.gid,
            bbox=BEHIND,
        )
        for name in names
    ]
    renderer = axes.figure.canvas.get_renderer()
    sizes = scale * np.array([text.get_window_extent(renderer).size for text in texts])
    within = scale * axes.get_window_extent(renderer).extents
    corners = place(anchors, sizes, np.concatenate([markers, line]), within)
    for text, corner, size, anchor in zip(texts, corners, sizes, anchors, strict=True):
        text.set_position(corner)
        text.xy = tuple(corner)
        _lead(axes, np.clip(anchor, corner, corner + size), anchor)


def _lead(axes: Any, end: Array, start: Array) -> None:
    if np.linalg.norm(end - start) > LED:
        style = {"arrowstyle": "-", "color": GREY, "linewidth": 0.5}
        there = {"xycoords": "figure points", "textcoords": "figure points"}
        axes.annotate("", end, start, arrowprops=style, zorder=1, **there)
