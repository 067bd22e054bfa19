"""What the markers of the chart mean: colours, shapes, sizes, and the key to them."""

from __future__ import annotations

from typing import Any

from uplift.lab.chart.methods import FAMILIES
from uplift.lab.chart.table import Chart
from uplift.viz.figure import GREY, INK
from uplift.viz.format import format_size

SHAPES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P", "": "o"}
SIZES = (1e3, 1e6, 1e8)
NARROWEST, KILOBYTE, GROWTH = 300.0, 4.2, 0.085
"""Bytes below which markers do not shrink, points that a kilobyte is wide, and the power of the bytes that widths grow
by: areas grow by the sixth root."""
ALONE: dict[str, Any] = {"markerfacecolor": "white", "markeredgewidth": 1.4}
"""Of a method that takes one colour a call."""
FRONT: dict[str, Any] = {"linestyle": "-", "marker": "none", "color": INK, "linewidth": 1.1}
WHISKER: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 1.6}
PLAIN: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 8,
    "color": GREY,
    "markeredgecolor": "white",
}
STYLE: dict[str, Any] = {
    "frameon": False,
    "alignment": "left",
    "fontsize": 9,
    "title_fontsize": 9,
    "labelspacing": 0.7,
}
OTHER = "#444444"
"""Of a family that this version does not know."""

Entries = list[tuple[str, dict[str, Any]]]


def colours() -> dict[str, str]:
    """``#rrggbb`` of every family."""
    return {family.name: family.colour for family in FAMILIES}


def width(size: float) -> float:
    """Points that a marker is wide for so many bytes."""
    return KILOBYTE * (max(size, NARROWEST) / 1e3) ** GROWTH


def legend(axes: Any, chart: Chart) -> None:
    """Fill a cell without axes."""
    known, alone = colours(), {**ALONE, "markeredgecolor": GREY}
    families = dict.fromkeys(row.family for row in chart.measured)
    modes = [mode for mode in SHAPES if mode and any(row.mode == mode for row in chart.measured)]
    _key(axes, (0.0, 1.0), "method", [(name, {"color": known.get(name, OTHER)}) for name in families])
    _key(axes, (0.42, 1.0), "mode of ours", [(name, {"marker": SHAPES[name]}) for name in modes])
    _key(
        axes, (0.72, 1.0), "bytes held", [(format_size(size), {"markersize": width(size)}) for size in SIZES]
    )
    rest = [("asked one colour a call", alone), ("Pareto front", FRONT), ("mean to 99 % to largest", WHISKER)]
    _key(axes, (0.42, 0.48), None, rest)


def _key(axes: Any, corner: tuple[float, float], title: str | None, entries: Entries) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], **(PLAIN | own)) for _, own in entries]
    names = [name for name, _ in entries]
    key = axes.legend(handles, names, title=title, loc="upper left", bbox_to_anchor=corner, **STYLE)
    axes.add_artist(key)
