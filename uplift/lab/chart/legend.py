"""Colours, shapes and sizes of the markers of the chart, and their legend."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from uplift.lab.chart.methods import FAMILIES
from uplift.lab.chart.table import Chart
from uplift.viz.figure import GREY, OTHER, figure_text
from uplift.viz.format import format_size
from uplift.viz.scatter import FRONT_LINE, LEGEND, MARKER

SHAPES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P", "": "o"}
SIZES = (1e3, 1e6, 1e8)
MIN_BYTES, WIDTH_OF_KILOBYTE, EXPONENT = 300.0, 4.2, 0.085
"""Bytes of the smallest marker, width of a kilobyte in points, and the exponent of widths: areas grow by the sixth
root of the bytes."""
SINGLE: dict[str, Any] = {"markerfacecolor": "white", "markeredgewidth": 1.4}
"""Style of methods that accept one colour per call."""
WHISKER: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 1.6}


def family_colours(families: Iterable[str]) -> dict[str, str]:
    """``#rrggbb`` of the given families, each once; `OTHER` for families of other versions."""
    known = {family.name: family.colour for family in FAMILIES}
    return {name: known.get(name, OTHER) for name in families}


def marker_width(size: float) -> float:
    """Width of a marker, in points, for a number of bytes."""
    return WIDTH_OF_KILOBYTE * (max(size, MIN_BYTES) / 1e3) ** EXPONENT


def draw_legend(axes: Any, chart: Chart) -> None:
    """Fill a cell without axes."""
    families = family_colours(result.family for result in chart.measured)
    modes = [mode for mode in SHAPES if mode and any(result.mode == mode for result in chart.measured)]
    _draw_key(axes, (0.0, 1.0), "method", [(name, {"color": colour}) for name, colour in families.items()])
    _draw_key(
        axes, (0.42, 1.0), "lookup mode of uplift", [(name, {"marker": SHAPES[name]}) for name in modes]
    )
    sizes = [(format_size(size), {"markersize": marker_width(size)}) for size in SIZES]
    _draw_key(axes, (0.72, 1.0), "memory", sizes)
    lines = [
        ("one colour per call", {**SINGLE, "markeredgecolor": GREY}),
        ("Pareto front", FRONT_LINE),
        ("mean to 99 % to largest", WHISKER),
    ]
    _draw_key(axes, (0.42, 0.48), None, lines)


def _draw_key(
    axes: Any, corner: tuple[float, float], title: str | None, entries: Sequence[tuple[str, dict[str, Any]]]
) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], **(MARKER | style)) for _, style in entries]
    names = [figure_text(name) for name, _ in entries]
    key = axes.legend(handles, names, title=title, loc="upper left", bbox_to_anchor=corner, **LEGEND)
    axes.add_artist(key)
