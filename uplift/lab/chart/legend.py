"""Colours and shapes of the markers of the chart, and their legend."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from uplift.lab.chart.methods import FAMILIES
from uplift.lab.chart.table import Chart
from uplift.viz.figure import GREY, OTHER, figure_text
from uplift.viz.scatter import FRONT_LINE, LEGEND, MARKER

SHAPES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P"}
"""Markers of cubes of this package, by mode of lookup."""
OTHER_SHAPE = "*"
"""Marker of all other methods."""
WIDTHS = {OTHER_SHAPE: 9.5, "o": 6.5, "^": 6.5, "s": 6.0, "D": 5.5, "P": 7.0}
"""Widths of markers in points."""
BAR: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 5, "solid_capstyle": "butt"}
"""Style of a colour in the legend, which no marker has."""
SINGLE: dict[str, Any] = {"markerfacecolor": "white", "markeredgewidth": 1.2}
"""Style of methods that are too slow for the number of colours, and were timed with fewer per call."""
WHISKER: dict[str, Any] = {"linestyle": "-", "marker": "none", "linewidth": 1.6}


def family_colours(families: Iterable[str]) -> dict[str, str]:
    """``#rrggbb`` of the given families, each once; `OTHER` for families of other versions."""
    known = {family.name: family.colour for family in FAMILIES}
    return {name: known.get(name, OTHER) for name in families}


def marker_style(mode: str) -> dict[str, Any]:
    """Shape and size of the marker of a mode; the empty mode is that of other methods."""
    shape = SHAPES.get(mode, OTHER_SHAPE)
    return {"marker": shape, "markersize": WIDTHS[shape]}


def draw_legend(axes: Any, chart: Chart) -> None:
    """Fill a cell without axes: colours, and the meanings of shapes and lines."""
    families = family_colours(result.family for result in chart.measured)
    colours = [(name, BAR | {"color": colour}) for name, colour in families.items()]
    _draw_key(axes, (0.0, 1.0), "method", colours)
    draw_shapes(axes, chart, (0.46, 1.0))


def draw_shapes(axes: Any, chart: Chart, corner: tuple[float, float]) -> None:
    """Draw the meanings of shapes and lines with the upper left corner at a position of the cell."""
    modes = [mode for mode in SHAPES if any(result.mode == mode for result in chart.measured)]
    single = SINGLE | {"markeredgecolor": GREY}
    entries = [(f"uplift, mode {mode}", marker_style(mode)) for mode in modes]
    entries += [
        ("another method", marker_style("")),
        ("timed with fewer colours per call", marker_style("") | single),
        ("Pareto front", FRONT_LINE),
        ("mean to 99 % to largest", WHISKER),
    ]
    _draw_key(axes, corner, None, entries)


def _draw_key(
    axes: Any, corner: tuple[float, float], title: str | None, entries: Sequence[tuple[str, dict[str, Any]]]
) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], **(MARKER | style)) for _, style in entries]
    names = [figure_text(name) for name, _ in entries]
    key = axes.legend(handles, names, title=title, loc="upper left", bbox_to_anchor=corner, **LEGEND)
    axes.legend_ = None
    axes.add_artist(key)
