"""Figures of a comparison, and its page: box plots as in Kment 2011, figures 6.1 and
6.2, and error over cost.
"""

from collections.abc import Callable, Sequence
from itertools import product
from operator import itemgetter
from typing import Any

from uplift.common.arrays import StrPath
from uplift.extras.pages.figure import OTHER, write_figure
from uplift.extras.pages.format import capitalise, format_error, format_time
from uplift.extras.pages.html import Tooltip, render
from uplift.extras.pages.marks import boxes, line, threshold
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, page_svg
from uplift.extras.pages.pareto import family_colours, front_panel
from uplift.extras.papers.representations.compare import HEADINGS, Comparison, Row

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
COSTS: dict[Axis, Callable[[Row], float]] = {
    Axis("CPU time of a product", log=True, text=format_time): (
        lambda row: max(row["ns"], 1.0)
    ),
    Axis("floats stored of a surface", log=True): itemgetter("floats"),
}
BOX_SIZE = (4.1, 0.155)
"""Inches of the width of box plots, and of the height of a box."""
JUST_VISIBLE = 1.0
"""ΔE00 that is just visible side by side; the thesis prints smaller ones in bold."""


def names(comparison: Comparison) -> list[str]:
    """Return the names of the representations; their order numbers the markers."""
    return list(dict.fromkeys(row["representation"] for row in comparison.rows))


def cost_panels(comparison: Comparison) -> list[Panel]:
    """Return the panels of error over each cost, for each set of lights. The markers of
    a family are joined by a line.
    """
    rows = names(comparison)
    panels: list[Panel] = []
    for (name, title), (axis, cost) in product(comparison.sets.items(), COSTS.items()):
        families: dict[str, list[Dot]] = {}
        for row in sorted(comparison.of(name), key=itemgetter("floats")):
            error = max(row["q97_5"], MIN_ERROR)
            colour = COLOURS.get(row["family"], OTHER)
            short = row["representation"]
            key = f"{len(panels)}-{rows.index(short)}"
            dot = Dot(cost(row), error, short, colour, key=key)
            families.setdefault(row["family"], []).append(dot)
        dots = []
        joined = []
        for family, members in families.items():
            x = [dot.x for dot in members]
            y = [dot.y for dot in members]
            style: dict[str, Any] = {"gid": f"whisker-{members[0].key}", "zorder": 1}
            joined.append(line(x, y, family, members[0].colour, alpha=0.6, **style))
            dots += members
        heading = f"{capitalise(title)}, ΔE00 of 97.5 %"
        panels.append(front_panel(heading, axis, dots, marks=joined))
    return panels


def write_costs(comparison: Comparison, path: StrPath, *, force: bool = False) -> None:
    """Write the panels of error over cost as PNG. Raises `OutputError`."""
    figure = draw(cost_panels(comparison), len(COSTS), (4.8, 3.4), legend="below")
    write_figure(figure, path, force=force)


def box_panels(comparison: Comparison) -> list[Panel]:
    """Return box plots for each set of lights: quartiles, median, and 2.5 to 97.5 %."""
    visible = threshold(JUST_VISIBLE, axis="x")
    panels = []
    for name, title in comparison.sets.items():
        rows = comparison.of(name)
        quantiles = []
        for row in rows:
            low = max(row["q2_5"], MIN_ERROR)
            quartiles = row["q25"], row["median"], row["q75"]
            quantiles.append((low, *quartiles, row["q97_5"]))
        colours = [COLOURS.get(row["family"], OTHER) for row in rows]
        y = Axis(names=[row["representation"] for row in rows])
        x = Axis("ΔE00", log=True)
        marks = [boxes(quantiles, colours), visible]
        panels.append(Panel(marks, capitalise(title), x, y))
    return panels


def _box_size(comparison: Comparison) -> tuple[float, float]:
    width, height = BOX_SIZE
    return width, height * len(names(comparison)) + 0.9


def write_boxes(comparison: Comparison, path: StrPath, *, force: bool = False) -> None:
    """Write box plots of all sets of lights as PNG. Raises `OutputError`."""
    panels = box_panels(comparison)
    figure = draw(panels, len(panels), _box_size(comparison))
    write_figure(figure, path, force=force)


def render_comparison(comparison: Comparison, tuned: Sequence[Row] = ()) -> str:
    """Render the page of a comparison."""
    pictures = []
    for panel in cost_panels(comparison):
        pictures.append((f"{panel.title}, over {panel.x.label}", page_svg(panel)))
    size = _box_size(comparison)
    distributions = [
        (panel.title, page_svg(panel, size)) for panel in box_panels(comparison)
    ]
    families = [row["family"] for row in comparison.rows]
    return render(
        "extras/papers/representations/templates/page.html.j2",
        comparison=comparison,
        pictures=pictures,
        boxes=distributions,
        families=family_colours(families, COLOURS),
        tooltips=[_tooltip(name, comparison) for name in names(comparison)],
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
