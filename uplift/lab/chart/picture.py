"""The chart as a figure for readers in a hurry, and as a page of panels with tooltips.

Of the cubes of this package a panel of the page shows those that no other cube of the
same kind and mode beats.
"""

from typing import Any

import numpy as np

from uplift.common.arrays import StrPath
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.pages.figure import (
    ACCENT,
    GREY,
    OTHER,
    PALE,
    new_figure,
    styled,
    write_png,
)
from uplift.extras.pages.format import (
    format_build_time,
    format_error,
    format_size,
    format_time,
)
from uplift.extras.pages.html import Tooltip, render
from uplift.extras.pages.scatter import Label, draw_labels
from uplift.lab.chart.results import (
    REFERENCE,
    Chart,
    Criterion,
    MethodResult,
    State,
    criteria,
)
from uplift.lab.panels import (
    Panel,
    Point,
    family_colours,
    fix_layout,
    page_panel,
    pareto_front,
)

COLOURS = {
    "uplift, moments with atlas": "#0b3c8c",
    "uplift, moments": "#4f9be8",
    "uplift, sigmoid with atlas": "#0a6b60",
    "uplift, sigmoid": "#3dbfa9",
    "uplift, C export": "#b8860b",
    "Burns 2019": "#5b7083",
    "Jakob 2019": "#d1495b",
    "Local-linear regression": "#a86f9c",
    "Mallett 2019": "#8e44ad",
    "Mean of metamers": "#c49a6c",
    "Meng 2015": "#8c5a2b",
    "Mitsuba 3": "#f08c2e",
    "Otsu 2018": "#d63fa0",
    "Smits 1999": "#7a9a1d",
}
"""Colours of families; those of other versions are dark grey."""
MODES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P"}
"""Markers of cubes of this package, by mode of lookup; other methods are stars."""
OURS = "uplift"
NAMES = {
    "smits1999-float32": "Smits 1999",
    "mallett2019-float32": "Mallett & Yuksel 2019",
    "mitsuba3-llvm": "Mitsuba 3, compiled",
    "jakob2019-table64": "Jakob & Hanika's table",
    "otsu2018": "Otsu 2018",
    "meng2015": "Meng 2015",
    "c-moments9-32-spectra": OURS,
}
"""Methods of the figure and their names in it; a chart without these shows all of its
methods.
"""
ATLAS = "c-moments9-32-atlas-spectra"
"""Cube of the figure whose error is that of the materials of its atlas."""
TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip, 1 nm",
    "coarse_round_trip": "round trip, 5 nm",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}
"""Columns of the table: headings by names of errors."""

DrawnPoint = tuple[str, tuple[float, float], str]
"""Name of a method, its time and error, and what the name is followed by."""


def drawn_results(criterion: Criterion, chart: Chart) -> list[MethodResult]:
    """Cubes of this package that none of the same kind and mode beats, then all other
    methods, above them.
    """
    groups: dict[tuple[str, str], dict[MethodResult, tuple[float, float]]] = {}
    others = []
    for result in chart.measured:
        point = criterion.point(result)
        if point is not None and result.build:
            groups.setdefault((result.family, result.mode), {})[result] = point
        elif point is not None:
            others.append(result)
    ours = []
    for group in groups.values():
        results = list(group)
        ours += [results[row] for row in pareto_front(list(group.values()))]
    return [*ours, *others]


def panel(criterion: Criterion, chart: Chart) -> Panel:
    """Return the panel of a criterion."""
    points = []
    for result in drawn_results(criterion, chart):
        place = criterion.point(result) or (1.0, 1.0)
        row = chart.results.index(result)
        style = COLOURS.get(result.family, OTHER), MODES.get(result.mode, "*")
        is_part = result.numbers[f"ns_{criterion.batch}_colours"] < criterion.batch
        is_named = not result.build and not result.method.endswith("-float32")
        points.append(
            Point(row, result.label, *place, *style, hollow=is_part, named=is_named)
        )
    title = f"{criterion.title}\n{criterion.unit}, {criterion.colours}"
    return Panel(title, criterion.axis, format_time, points)


def write_picture(chart: Chart, path: StrPath, *, force: bool = False) -> None:
    """Write the mean error of unseen materials over the time per RGB as PNG. Raises
    `OutputError`.
    """
    with styled():
        write_png(draw_picture(chart), path, force=force)


def draw_picture(chart: Chart) -> Any:
    """Return the matplotlib figure of `write_picture`: every method has its name, this
    package the only colour.
    """
    compared = criteria(reference_batch(chart))
    unseen = compared[1]
    drawn = _drawn_points(chart, unseen, compared[4])
    figure = new_figure(9, 5.2)
    figure.set_dpi(130)
    axes = figure.subplots()
    largest = max(1.0, *(error for _, (_, error), _ in drawn))
    axes.set(xscale="log", ylim=(-0.02, 1.12 * largest))
    axes.set_xlabel(f"{unseen.axis}, {unseen.colours}", fontsize=11)
    axes.set_ylabel(f"mean {unseen.unit} of unseen materials", fontsize=11)
    axes.tick_params(labelsize=11)
    axes.minorticks_off()
    axes.spines[["top", "right"]].set_visible(False)
    axes.xaxis.set_major_formatter(lambda value, _: format_time(value))
    axes.axhspan(0, 1, color=PALE, alpha=0.45, linewidth=0)
    axes.annotate(
        "just visible: 1",
        (0.99, 1),
        xycoords=("axes fraction", "data"),
        ha="right",
        va="top",
        color=GREY,
        size=11,
    )
    labels = []
    for name, place, what in drawn:
        colour = ACCENT if name == OURS else GREY
        face = "white" if what else None
        axes.plot(
            *place,
            "o",
            color=colour,
            markerfacecolor=face,
            markersize=9,
            markeredgewidth=2,
            clip_on=False,
        )
        text = f" {name}{what}  {place[1]:.2f} "  # blanks, as markers are large
        labels.append(Label(text, place, colour, name == OURS, ""))
    axes.margins(x=0.09)
    axes.set_title(
        f"Smallest error on unseen materials: {_two_best(drawn)}",
        loc="left",
        fontsize=13,
        fontweight="bold",
        pad=12,
    )
    fix_layout(figure)
    markers = np.array([label.point for label in labels]).reshape(-1, 2)
    draw_labels(axes, labels, markers, np.empty((0, 2)), fontsize=12)
    return figure


def _drawn_points(
    chart: Chart, unseen: Criterion, of_atlas: Criterion
) -> list[DrawnPoint]:
    """Return the methods that the figure shows, the atlas at its own materials too."""
    named = [result for result in chart.measured if result.method in NAMES]
    drawn: list[DrawnPoint] = []
    for result in named or chart.measured:
        if point := unseen.point(result):
            drawn.append((NAMES.get(result.method, result.title), point, ""))
    for result in chart.measured:
        if result.method == ATLAS and (point := of_atlas.point(result)):
            drawn.append((OURS, point, " with the atlas, its own materials"))
    return drawn


def _two_best(drawn: list[DrawnPoint]) -> str:
    """Return the two smallest errors of unseen materials, with their times."""
    errors = []
    for name, (time, error), what in drawn:
        if not what:
            errors.append((error, name, format_time(time)))
    texts = [f"{name}, {error:.2f} in {time}" for error, name, time in sorted(errors)]
    return "\nthe next: ".join(texts[:2])


def reference_batch(chart: Chart) -> int:
    """Return the colours per call of the figure, which the page shows at first."""
    return max((batch for batch in chart.batches if batch <= REFERENCE), default=0)


def render_chart(chart: Chart) -> str:
    """Render the page of a chart."""
    compared: list[Criterion] = []
    for batch in chart.batches:
        compared += criteria(batch)
    sources = (f"{result.family}: {result.source}" for result in chart.results)
    pictures = [
        (criterion, page_panel(panel(criterion, chart), number))
        for number, criterion in enumerate(compared)
    ]
    return render(
        "lab/chart/templates/page.html.j2",
        title=TITLE,
        chart=chart,
        pictures=pictures,
        families=family_colours((result.family for result in chart.measured), COLOURS),
        tooltips=[_tooltip(chart, result) for result in chart.results],
        sources=list(dict.fromkeys(sources)),
        chosen=reference_batch(chart),
        errors=ERRORS,
        not_measured=[
            result for result in chart.results if result.state != State.MEASURED
        ],
    )


def _tooltip(chart: Chart, result: MethodResult) -> Tooltip:
    numbers = result.numbers
    lines = []
    if result.state == State.MEASURED:
        for size in chart.batches:
            if (name := f"ns_{size}") in numbers:
                time = format_time(numbers[name])
                lines.append((f"{size:,} per call", f"{time} each"))
        lines += [
            ("set-up", format_build_time(numbers["setup_s"])),
            ("memory", format_size(numbers["bytes"])),
            ("errors", "mean / 99 % / largest"),
        ]
        for error, name in ERRORS.items():
            values = (numbers[f"{error}_{kind}"] for kind in ("mean", "p99", "max"))
            lines.append((name, " / ".join(map(format_error, values))))
        lines += [
            ("", text) for text in (result.build, result.call, result.note) if text
        ]
    return {"title": result.title, "family": result.family, "lines": lines}
