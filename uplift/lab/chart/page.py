"""The chart as a self-contained HTML page with tooltips."""

from __future__ import annotations

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.legend import family_colours
from uplift.lab.chart.panels import all_panels
from uplift.lab.chart.picture import page_key, page_panels
from uplift.lab.chart.table import BATCH, Chart, MethodResult, State
from uplift.lab.chart.timing import REFERENCE
from uplift.viz.format import format_build_time, format_error, format_size, format_time
from uplift.viz.html import Tooltip

TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip, 1 nm",
    "coarse_round_trip": "round trip, 5 nm",
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
        key=page_key(chart),
        families=family_colours(result.family for result in chart.measured),
        tooltips=[_tooltip(result) for result in chart.results],
        facts=chart.facts,
        sources=list(dict.fromkeys(f"{result.family}: {result.source}" for result in chart.results)),
        panels=all_panels(chart),
        batches=chart.batches,
        chosen=max((batch for batch in chart.batches if batch <= REFERENCE), default=0),
        errors=ERRORS,
        not_measured=[result for result in chart.results if result.state != State.MEASURED],
    )


def _tooltip(result: MethodResult) -> Tooltip:
    measured = result.state == State.MEASURED
    return {"title": result.title, "family": result.family, "lines": _lines(result) if measured else []}


def _lines(result: MethodResult) -> list[tuple[str, str]]:
    numbers = result.numbers
    lines = []
    for size in sorted(int(match[1]) for name in numbers if (match := BATCH.fullmatch(name))):
        used = int(numbers[f"ns_{size}_colours"])
        fewer = f", timed with {used:,}" if used < size else ""
        lines.append((f"{size:,} per call{fewer}", f"{format_time(numbers[f'ns_{size}'])} each"))
    lines.append(("memory", format_size(numbers["bytes"])))
    for name in ("build", "load"):
        if f"{name}_s" in numbers:
            lines.append((name, format_build_time(numbers[f"{name}_s"])))
    lines.append(("errors", "mean / 99 % / largest"))
    lines += [
        (name, " / ".join(format_error(numbers[f"{error}_{kind}"]) for kind in ("mean", "p99", "max")))
        for error, name in ERRORS.items()
    ]
    count = f"{numbers['round_trip_colours']:g} colours, {numbers['unseen_spectra']:g} materials"
    lines.append(("test set", count))
    return lines + [("", text) for text in (result.build, result.ask, result.note) if text]
