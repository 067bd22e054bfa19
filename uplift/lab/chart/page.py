"""The chart as a self-contained HTML page with tooltips."""

from __future__ import annotations

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.legend import family_colours
from uplift.lab.chart.panels import PANELS
from uplift.lab.chart.picture import page_panels
from uplift.lab.chart.table import Chart, MethodResult, State
from uplift.viz.format import format_build_time, format_error, format_size, format_time
from uplift.viz.tooltip import Tooltip

TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}
"""Columns of the table: headings by names of errors."""


def render_chart(chart: Chart) -> str:
    """Render the page of a chart.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    str
        The HTML text. Equal charts give equal text.
    """
    from uplift.viz.html import render

    return render(
        "lab/chart/templates/page.html.j2",
        title=TITLE,
        chart=chart,
        pictures=page_panels(chart),
        families=family_colours(result.family for result in chart.measured),
        tooltips=[_tooltip(result) for result in chart.results],
        facts=chart.facts,
        sources=list(dict.fromkeys(f"{result.family}: {result.source}" for result in chart.results)),
        panels=PANELS,
        errors=ERRORS,
        not_measured=[result for result in chart.results if result.state != State.MEASURED],
    )


def _tooltip(result: MethodResult) -> Tooltip:
    measured = result.state == State.MEASURED
    return {"title": result.title, "family": result.family, "lines": _lines(result) if measured else []}


def _lines(result: MethodResult) -> list[tuple[str, str]]:
    numbers = result.numbers
    lines = []
    if "batch_ns" in numbers:
        lines.append(
            (f"{numbers['batch_colours']:,.0f} per call", f"{format_time(numbers['batch_ns'])} each")
        )
    lines.append(("one colour per call", format_time(numbers["single_ns"])))
    lines.append(("memory", format_size(numbers["bytes"])))
    if "build_s" in numbers:
        lines.append(("build", format_build_time(numbers["build_s"])))
    lines.append(("errors", "mean / 99 % / largest"))
    lines += [
        (name, " / ".join(format_error(numbers[f"{error}_{kind}"]) for kind in ("mean", "p99", "max")))
        for error, name in ERRORS.items()
    ]
    count = f"{numbers['round_trip_colours']:g} colours, {numbers['unseen_spectra']:g} materials"
    lines.append(("test set", count))
    return lines + [("", text) for text in (result.build, result.ask, result.note) if text]
