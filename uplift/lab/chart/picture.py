"""The chart as a figure, a row of panels for each number of colours per call, and as a page with tooltips.

Of the cubes of this package a panel shows those that no other cube of the same kind and mode beats."""

from typing import Any

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.arrays import StrPath
from uplift.lab.chart.table import BATCH, REFERENCE, Chart, Criterion, MethodResult, State, criteria
from uplift.lab.panels import Panel, Point, family_colours, page_panel, pareto_front, write_panels
from uplift.viz.figure import OTHER
from uplift.viz.format import format_build_time, format_error, format_size, format_time
from uplift.viz.html import Tooltip, render

COLOURS = {
    "uplift, moments with atlas": "#0b3c8c",
    "uplift, moments": "#4f9be8",
    "uplift, sigmoid with atlas": "#0a6b60",
    "uplift, sigmoid": "#3dbfa9",
    "uplift, C export": "#b8860b",
    "Jakob 2019": "#d1495b",
    "Mallett 2019": "#8e44ad",
    "Meng 2015": "#8c5a2b",
    "Mitsuba 3": "#f08c2e",
    "Otsu 2018": "#d63fa0",
    "Smits 1999": "#7a9a1d",
}
"""Colours of families; those of other versions are dark grey."""
MODES = {"spectra": "o", "moments": "^", "refined": "s", "nearest": "D", "bulk": "P"}
"""Markers of cubes of this package, by mode of lookup; other methods are stars."""
SHOWN = 3
"""Panels of each number of colours per call in the figure; pages show all."""
TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip, 1 nm",
    "coarse_round_trip": "round trip, 5 nm",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}
"""Columns of the table: headings by names of errors."""


def drawn_results(criterion: Criterion, chart: Chart) -> list[MethodResult]:
    """Cubes of this package that none of the same kind and mode beats, then all other methods, above them."""
    groups: dict[tuple[str, str], dict[MethodResult, tuple[float, float]]] = {}
    others = []
    for result in chart.measured:
        point = criterion.point(result)
        if point is not None and result.build:
            groups.setdefault((result.family, result.mode), {})[result] = point
        elif point is not None:
            others.append(result)
    ours = [list(group)[row] for group in groups.values() for row in pareto_front(list(group.values()))]
    return [*ours, *others]


def panel(criterion: Criterion, chart: Chart) -> Panel:
    """Return the panel of a criterion."""
    points = []
    for result in drawn_results(criterion, chart):
        time, error = criterion.point(result) or (1.0, 1.0)
        points.append(
            Point(
                chart.results.index(result),
                result.label,
                time,
                error,
                COLOURS.get(result.family, OTHER),
                MODES.get(result.mode, "*"),
                hollow=result.numbers[f"ns_{criterion.batch}_colours"] < criterion.batch,
                named=not result.build and not result.method.endswith("-float32"),
            )
        )
    title = f"{criterion.title}\n{criterion.unit}, {criterion.colours}"
    return Panel(title, criterion.axis, format_time, points)


def legend(chart: Chart) -> dict[str, dict[str, Any]]:
    """Return the styles of the legend by name: colours of families, markers of modes, and lines."""
    families = family_colours((result.family for result in chart.measured), COLOURS)
    return {
        **{name: {"color": families[name], "marker": "o" if name.startswith("uplift") else "*"} for name in families},
        **{f"mode {mode}": {"marker": marker} for mode, marker in MODES.items()},
        "timed with fewer colours": {"marker": "*", "markerfacecolor": "white"},
    }


def write_picture(chart: Chart, path: StrPath, *, force: bool = False) -> None:
    """Write the figure of a chart as PNG. Raises `OutputError`."""
    panels = [panel(criterion, chart) for batch in chart.batches for criterion in criteria(batch)[:SHOWN]]
    write_panels(panels, SHOWN, path, legend(chart), force=force)


def write_panel(chart: Chart, criterion: Criterion, path: StrPath, *, force: bool = False) -> None:
    """Write one panel as PNG, as wide as a phone. Raises `OutputError`."""
    write_panels([panel(criterion, chart)], 1, path, {}, force=force)


def render_chart(chart: Chart) -> str:
    """Render the page of a chart."""
    compared = [criterion for batch in chart.batches for criterion in criteria(batch)]
    pictures = [(criterion, page_panel(panel(criterion, chart), number)) for number, criterion in enumerate(compared)]
    return render(
        "lab/chart/templates/page.html.j2",
        title=TITLE,
        chart=chart,
        pictures=pictures,
        families=family_colours((result.family for result in chart.measured), COLOURS),
        tooltips=[_tooltip(result) for result in chart.results],
        facts=chart.facts,
        sources=list(dict.fromkeys(f"{result.family}: {result.source}" for result in chart.results)),
        chosen=max((batch for batch in chart.batches if batch <= REFERENCE), default=0),
        errors=ERRORS,
        not_measured=[result for result in chart.results if result.state != State.MEASURED],
    )


def _tooltip(result: MethodResult) -> Tooltip:
    numbers, lines = result.numbers, []
    if result.state == State.MEASURED:
        sizes = sorted(int(match[1]) for match in map(BATCH.fullmatch, numbers) if match)
        lines = [(f"{size:,} per call", f"{format_time(numbers[f'ns_{size}'])} each") for size in sizes]
        lines += [("set-up", format_build_time(numbers["setup_s"])), ("memory", format_size(numbers["bytes"]))]
        lines.append(("errors", "mean / 99 % / largest"))
        for error, name in ERRORS.items():
            values = (numbers[f"{error}_{kind}"] for kind in ("mean", "p99", "max"))
            lines.append((name, " / ".join(map(format_error, values))))
        lines += [("", text) for text in (result.build, result.call, result.note) if text]
    return {"title": result.title, "family": result.family, "lines": lines}
