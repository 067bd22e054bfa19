"""Figures of a comparison, and its page: box plots as in Kment 2011, figures 6.1 and
6.2, and error over cost.
"""

from collections.abc import Callable, Sequence
from itertools import product
from operator import itemgetter
from typing import Any

from markupsafe import Markup

from uplift.common.arrays import StrPath
from uplift.extras.pages.figure import (
    INK,
    OTHER,
    new_figure,
    style_axes,
    styled,
    to_page_svg,
    write_png,
)
from uplift.extras.pages.format import capitalise, format_error, format_time
from uplift.extras.pages.html import Tooltip, render
from uplift.extras.pages.scatter import style_title
from uplift.lab.comparison.compare import HEADINGS, Comparison
from uplift.lab.panels import Panel, Point, family_colours, page_panel, write_panels
from uplift.lab.statistics import Row

COLOURS = {
    "point sampling": "#1f6fb4",
    "point sampling, filtered": "#35a7d8",
    "Riemann sums": "#d98200",
    "enhanced Riemann sums": "#8c4a00",
    "Sun's composite": "#c8323f",
    "Gaussian quadrature": "#12897b",
    "trigonometric moments": "#7b4fa3",
    "sigmoid": "#d05fa2",
    "linear model (PCA)": "#5a5a5a",
    "hero wavelengths": "#5b8c1f",
    "fitted wavelengths": "#0b3d91",
    "factor model": "#a67c00",
    "moments of cubes": "#4b2e83",
}
"""Colours of families; others are dark grey."""
MIN_ERROR = 1e-3
"""Smaller ΔE00 are not visible and are drawn here."""
COSTS: dict[str, tuple[Callable[[Row], float], Callable[[float], str]]] = {
    "CPU time of a product": (lambda row: max(row["ns"], 1.0), format_time),
    "floats stored of a surface": (lambda row: row["floats"], "{:g}".format),
}
"""Costs, and their texts, by title."""
BOX_SIZE = (4.1, 0.155)
"""Inches of the width of box plots, and of the height of a box."""
JUST_VISIBLE = 1.0
"""ΔE00 that is just visible side by side; the thesis prints smaller ones in bold."""
TITLE = "Representations of spectra"
SOURCES = (
    "Kment 2011, Spectral data representation techniques for realistic image "
    "synthesis: point sampling, Riemann sums "
    "and their enhancement, the lights and the statistics.",
    "Sun, Drew & Fracchia 1999: the composite model. Peercy 1993: linear models. "
    "Wilkie et al. 2014: hero wavelengths. "
    "Peters et al. 2019: trigonometric moments. Jakob & Hanika 2019: the sigmoid.",
)


def names(comparison: Comparison) -> list[str]:
    """Return the names of the representations; their order numbers the markers."""
    return list(dict.fromkeys(row["representation"] for row in comparison.rows))


def cost_panels(comparison: Comparison) -> list[Panel]:
    """Return the panels of error over each cost, for each set of lights."""
    rows = names(comparison)

    def point(row: Row, cost: float) -> Point:
        name = row["representation"]
        error = max(row["q97_5"], MIN_ERROR)
        colour = COLOURS.get(row["family"], OTHER)
        return Point(rows.index(name), name, cost, error, colour, group=row["family"])

    panels = []
    for (name, title), (axis, (cost, text)) in product(
        comparison.sets.items(), COSTS.items()
    ):
        results = sorted(comparison.of(name), key=itemgetter("floats"))
        points = [point(result, cost(result)) for result in results]
        panels.append(Panel(f"{capitalise(title)}, ΔE00 of 97.5 %", axis, text, points))
    return panels


def _families(comparison: Comparison) -> dict[str, str]:
    return family_colours((row["family"] for row in comparison.rows), COLOURS)


def write_costs(comparison: Comparison, path: StrPath, *, force: bool = False) -> None:
    """Write the panels of error over cost as PNG. Raises `OutputError`."""
    legend = {name: {"color": colour} for name, colour in _families(comparison).items()}
    write_panels(cost_panels(comparison), len(COSTS), path, legend, force=force)


def write_boxes(comparison: Comparison, path: StrPath, *, force: bool = False) -> None:
    """Write box plots of all sets of lights as PNG. Raises `OutputError`."""
    with styled():
        write_png(draw_boxes(comparison, list(comparison.sets)), path, force=force)


def page_boxes(comparison: Comparison) -> list[tuple[str, Markup]]:
    """Draw the box plots of each set of lights for a page."""
    pictures = []
    with styled():
        for name, title in comparison.sets.items():
            figure = draw_boxes(comparison, [name], titles=False)
            picture = to_page_svg(figure, f"Box plots under {title}")
            pictures.append((capitalise(title), picture))
    return pictures


def draw_boxes(
    comparison: Comparison, sets: Sequence[str], *, titles: bool = True
) -> Any:
    """Return the matplotlib figure of sets of lights side by side: quartiles, median,
    and 2.5 to 97.5 %.
    """
    width, height = BOX_SIZE
    figure = new_figure(width * len(sets), height * len(names(comparison)) + 0.9)
    cells = figure.subplots(1, len(sets), squeeze=False)[0]
    for axes, name in zip(cells, sets, strict=True):
        results = comparison.of(name)
        for row, result in enumerate(results):
            colour = COLOURS.get(result["family"], OTHER)
            low = max(result["q2_5"], MIN_ERROR)
            axes.hlines(row, low, result["q97_5"], color=colour, linewidth=1)
            width = result["q75"] - result["q25"]
            axes.barh(row, width, left=result["q25"], height=0.62, color=colour)
            ends = row - 0.31, row + 0.31
            axes.vlines(result["median"], *ends, color="white", linewidth=1.4)
        axes.axvline(
            JUST_VISIBLE, color=INK, linewidth=0.8, linestyle=(0, (3, 2)), zorder=0
        )
        axes.set(xscale="log", xlabel="ΔE00")
        axes.set_yticks(
            range(len(results)), [result["representation"] for result in results]
        )
        axes.margins(y=0.01)
        axes.invert_yaxis()
        axes.xaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()
        style_axes(axes)
        axes.yaxis.grid(visible=False)
        if titles:
            style_title(axes, capitalise(comparison.sets[name]))
    return figure


def render_comparison(comparison: Comparison, tuned: Sequence[Row] = ()) -> str:
    """Render the page of a comparison."""
    panels = enumerate(cost_panels(comparison))
    return render(
        "lab/comparison/templates/page.html.j2",
        title=TITLE,
        comparison=comparison,
        pictures=[
            (f"{panel.title}, over {panel.axis}", page_panel(panel, number))
            for number, panel in panels
        ],
        boxes=page_boxes(comparison),
        families=_families(comparison),
        tooltips=[_tooltip(name, comparison) for name in names(comparison)],
        sources=SOURCES,
        statistics=HEADINGS,
        tuned=tuned,
    )


def _tooltip(name: str, comparison: Comparison) -> Tooltip:
    rows = [row for row in comparison.rows if row["representation"] == name]
    lines = [("floats of a surface", f"{rows[0]['floats']:.1f}")]
    for row in rows:
        lights = row["lights"]
        errors = f"{format_error(row['mean'])} / {format_error(row['q97_5'])}"
        lines += [
            (f"{lights}: ΔE00, mean / 97.5 %", errors),
            (f"{lights}: floats of a light", f"{row['light_floats']:.1f}"),
            (f"{lights}: product", format_time(row["ns"])),
        ]
    return {"title": name, "family": rows[0]["family"], "lines": lines}
