"""The chart as one HTML page that needs nothing else: hover over a marker to see what stands for it."""

from __future__ import annotations

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.legend import OTHER, colours
from uplift.lab.chart.panels import PANELS, Panel
from uplift.lab.chart.table import Chart, MethodResult, State
from uplift.report.page_parts import note, right, table
from uplift.viz.document import Told, document, family_boxes, footer
from uplift.viz.format import format_build_time, format_error, format_size, format_time
from uplift.viz.markup import Markup, element, number

TITLE = "Spectral upsampling: speed against accuracy"
ERRORS = {
    "round_trip": "round trip",
    **{light: light for light in CHART_LIGHTS},
    "rms": "rms",
    "own_lights": "own, mean",
}


def page(chart: Chart, picture: Markup) -> str:
    """The whole HTML text around the picture, an ``svg`` element. The same chart gives the same text."""
    known = colours()
    families = dict.fromkeys(row.family for row in chart.measured)
    parts = [
        family_boxes({name: known.get(name, OTHER) for name in families}),
        element("div", picture, class_="picture"),
        _fronts(chart),
        _table(chart),
        _undrawn(chart),
        _footer(chart),
    ]
    return document(TITLE, _lead(chart), parts, [_told(row) for row in chart.rows])


def _lead(chart: Chart) -> str:
    return (
        f"{len(chart.measured)} ways from RGB to a reflectance spectrum, at the same colours and the same measured "
        "materials. Lower is nearer, left is quicker; nothing measured lies below the black line."
    )


def _fronts(chart: Chart) -> Markup:
    title = element("h2", "Pareto fronts")
    told = note("From the quickest to the nearest: each is notably nearer than all that are quicker.")
    tables = [element("div", element("h3", panel.title), _front(panel, chart)) for panel in PANELS]
    return element("section", title, told, element("div", *tables, class_="fronts"))


def _front(panel: Panel, chart: Chart) -> Markup:
    lines = [[row.title, *map(number, panel.told(row))] for row in panel.front(chart)]
    return table(["method", right("time"), right(panel.unit)], lines)


def _table(chart: Chart) -> Markup:
    headings = [
        element("th", "method"),
        right("time per RGB"),
        right("one a call"),
        right("bytes"),
        right("build"),
    ]
    headings += [right(name) for name in ERRORS.values()]
    told = note(
        "Time per RGB of many colours at once, or of one a call where a method takes no more. Errors are means: of the "
        "round trip in ΔE00 under D65; of unseen materials in ΔE00 under each light, and rms of reflectance; of the "
        "materials that cubes with an atlas were built from in ΔE00 over the five lights. Click a heading to sort."
    )
    lines = (_cells(row) for row in chart.measured)
    return element("section", element("h2", "Every method"), told, table(headings, lines, "sortable"))


def _cells(row: MethodResult) -> list[Markup]:
    numbers = row.numbers
    shown = [
        ("time_ns", format_time(numbers["time_ns"])),
        ("single_ns", format_time(numbers["single_ns"])),
        ("bytes", format_size(numbers["bytes"])),
        ("build_s", format_build_time(numbers.get("build_s"))),
        *((f"{key}_mean", format_error(numbers[f"{key}_mean"])) for key in ERRORS),
    ]
    cells = [element("td", row.title, element("small", row.note) if row.note else None, class_="name")]
    return cells + [number(told, data_value=f"{numbers.get(key, -1):.6g}") for key, told in shown]


def _undrawn(chart: Chart) -> Markup | None:
    rest = [row for row in chart.rows if row.state != State.MEASURED]
    if not rest:
        return None
    lines = [[row.title, element("td", row.state, class_="bad"), row.why] for row in rest]
    told = note("An answer is checked before it is timed; what is broken has no place among the quick.")
    return element("section", element("h2", "Not drawn"), told, table(["method", "", "why"], lines))


def _footer(chart: Chart) -> Markup:
    return footer(chart.facts, dict.fromkeys(f"{row.family}: {row.source}" for row in chart.rows))


def _told(row: MethodResult) -> Told:
    return {"title": row.title, "family": row.family, "lines": _lines(row)}


def _lines(row: MethodResult) -> list[tuple[str, str]]:
    numbers = row.numbers
    if row.state != State.MEASURED:
        return []
    lines = [("one colour a call", format_time(numbers["single_ns"]))]
    if "batch_ns" in numbers:
        lines.insert(
            0, (f"{numbers['batch_colours']:,.0f} at once", f"{format_time(numbers['batch_ns'])} each")
        )
    lines.append(("held", format_size(numbers["bytes"])))
    if "build_s" in numbers:
        lines.append(("build", format_build_time(numbers["build_s"])))
    lines.append(("errors", "mean / 99 % / largest"))
    lines += [
        (name, " / ".join(format_error(numbers[f"{key}_{kind}"]) for kind in ("mean", "p99", "max")))
        for key, name in ERRORS.items()
    ]
    lines.append(
        ("asked", f"{numbers['round_trip_colours']:g} colours, {numbers['unseen_spectra']:g} materials")
    )
    return lines + [(name, told) for name, told in (("", row.build), ("", row.ask), ("", row.note)) if told]
