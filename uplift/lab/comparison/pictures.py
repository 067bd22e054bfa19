"""Figures of a comparison, and its page: box plots as in Kment 2011, figures 6.1 and
6.2, and error over cost.
"""

from collections.abc import Callable, Sequence
from itertools import product
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
from uplift.lab.comparison.compare import (
    HEADINGS,
    Comparison,
    RepresentationResult,
)
from uplift.lab.comparison.tuning import TunedFilter
from uplift.lab.panels import Panel, Point, family_colours, page_panel, write_panels

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
COSTS: dict[
    str, tuple[Callable[[RepresentationResult], float], Callable[[float], str]]
] = {
    "CPU time of a product": (lambda result: max(result.ns.median, 1.0), format_time),
    "floats stored of a surface": (lambda result: result.floats, "{:g}".format),
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
    return list(dict.fromkeys(result.name for result in comparison.results))


def cost_panels(comparison: Comparison) -> list[Panel]:
    """Return the panels of error over each cost, for each set of lights."""
    rows = names(comparison)

    def point(result: RepresentationResult, cost: float) -> Point:
        name = result.name
        error = max(result.statistics.q97_5, MIN_ERROR)
        colour = COLOURS.get(result.family, OTHER)
        return Point(rows.index(name), name, cost, error, colour, group=result.family)

    panels = []
    for (name, title), (axis, (cost, text)) in product(
        comparison.sets.items(), COSTS.items()
    ):
        results = sorted(comparison.of(name), key=lambda result: result.floats)
        points = [point(result, cost(result)) for result in results]
        panels.append(Panel(f"{capitalise(title)}, ΔE00 of 97.5 %", axis, text, points))
    return panels


def _families(comparison: Comparison) -> dict[str, str]:
    return family_colours((result.family for result in comparison.results), COLOURS)


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
            values = result.statistics
            colour = COLOURS.get(result.family, OTHER)
            low = max(values.q2_5, MIN_ERROR)
            axes.hlines(row, low, values.q97_5, color=colour, linewidth=1)
            width = values.q75 - values.q25
            axes.barh(row, width, left=values.q25, height=0.62, color=colour)
            ends = row - 0.31, row + 0.31
            axes.vlines(values.median, *ends, color="white", linewidth=1.4)
        axes.axvline(
            JUST_VISIBLE, color=INK, linewidth=0.8, linestyle=(0, (3, 2)), zorder=0
        )
        axes.set(xscale="log", xlabel="ΔE00")
        axes.set_yticks(range(len(results)), [result.name for result in results])
        axes.margins(y=0.01)
        axes.invert_yaxis()
        axes.xaxis.set_major_formatter("{x:g}")
        axes.minorticks_off()
        style_axes(axes)
        axes.yaxis.grid(visible=False)
        if titles:
            style_title(axes, capitalise(comparison.sets[name]))
    return figure


def render_comparison(comparison: Comparison, tuned: Sequence[TunedFilter] = ()) -> str:
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
    results = [result for result in comparison.results if result.name == name]
    lines = [("floats of a surface", f"{results[0].floats:.1f}")]
    for result in results:
        errors = (
            f"{format_error(result.statistics.mean)} / "
            f"{format_error(result.statistics.q97_5)}"
        )
        lines += [
            (f"{result.lights}: ΔE00, mean / 97.5 %", errors),
            (f"{result.lights}: floats of a light", f"{result.light_floats:.1f}"),
            (f"{result.lights}: product", format_time(result.ns.median)),
        ]
    return {"title": name, "family": results[0].family, "lines": lines}
