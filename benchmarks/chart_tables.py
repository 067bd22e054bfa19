"""Tables of the chart."""

from __future__ import annotations

from benchmarks.page import table
from uplift.lab.chart.panels import PANELS
from uplift.lab.chart.table import Chart, MethodResult, State
from uplift.viz.format import format_build_time, format_error, format_size, format_time

ERRORS = ("round_trip", "A", "FL2", "FL7", "FL11", "LED-B3", "rms", "own_lights")


def fronts(chart: Chart) -> str:
    return table(
        "Pareto fronts",
        "Of each panel, from the quickest to the nearest.",
        ["panel", "method", "time", "mean error"],
        [
            [panel.title if row is front[0] else "", row.title, *panel.told(row)]
            for panel in PANELS
            for front in [panel.front(chart)]
            for row in front
        ],
    )


def methods(chart: Chart) -> str:
    return table(
        "Every method",
        "CPU time of all threads per RGB, many at once and one a call: median, least and most in brackets. Errors are "
        "means, the round trip's with its 99 % and its largest; those under lights are of unseen materials, *own* that "
        "of the materials that cubes with an atlas were built from, mean of the five lights.",
        [
            "method",
            "at once",
            "one a call",
            "held",
            "build",
            "round trip",
            *ERRORS[1:-1],
            "own",
            "colours",
            "materials",
            "notes",
        ],
        [_cells(row) for row in chart.measured],
    )


def undrawn(chart: Chart) -> str:
    rest = [row for row in chart.rows if row.state != State.MEASURED]
    return table(
        "Not drawn",
        "An answer is checked before it is timed."
        if rest
        else "Nothing was broken, and nothing was missing.",
        ["method", "", "why"],
        [[row.title, row.state, row.why] for row in rest],
    )


def _cells(row: MethodResult) -> list[str]:
    numbers = row.numbers
    trip = " / ".join(format_error(numbers[f"round_trip_{kind}"]) for kind in ("mean", "p99", "max"))
    return [
        row.title,
        _spread(row, "batch"),
        _spread(row, "single"),
        format_size(numbers["bytes"]),
        format_build_time(numbers.get("build_s")),
        trip,
        *(format_error(numbers[f"{key}_mean"]) for key in ERRORS[1:]),
        f"{numbers['round_trip_colours']:,.0f}",
        f"{numbers['unseen_spectra']:,.0f}",
        row.note,
    ]


def _spread(row: MethodResult, kind: str) -> str:
    if f"{kind}_ns" not in row.numbers:
        return ""
    median, least, most = (format_time(row.numbers[f"{kind}_ns{end}"]) for end in ("", "_least", "_most"))
    return f"{median} ({least}–{most})"
