"""The tables of docs/representations.md."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from benchmarks.page import table
from benchmarks.representations.closed import Closed
from benchmarks.representations.thesis import Printed
from uplift.lab.comparison.filters import NONE, Tuned
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.lab.comparison.recommend import cheapest
from uplift.lab.comparison.statistics import HEADINGS, Statistics
from uplift.lab.comparison.style import heading
from uplift.viz.format import format_error, format_time

TARGETS = (2.0, 1.0, 0.5)
TABLE = 81
"""Floats of a light that is not represented, but kept as its 5 nm table."""
NUMBERS = {"smooth": "6.1", "spiky": "6.2"}
Thesis = Mapping[tuple[str, str], Printed]


def advice(comparisons: Iterable[Comparison]) -> str:
    """The cheapest for each set of lights and target."""
    rows = [
        [title, *(_cheapest(found, name, target) for target in TARGETS)]
        for found in comparisons
        for name, title in found.sets.items()
    ]
    return table(
        "Model no more than a scene needs",
        "`uplift compare --target`: of all whose 97.5 % quantile stays within the target, the one that stores least of "
        "a surface, then of a light, then is the nearest (in brackets: the floats of a surface, and of a light). The "
        "second line leaves out what needs the whole table of the light.",
        ["lights", *(f"ΔE00 {target:g}" for target in TARGETS)],
        rows,
    )


def _cheapest(found: Comparison, lights: str, target: float) -> str:
    compact = Comparison(
        found.facts, found.sets, tuple(row for row in found.rows if row.light_floats < TABLE)
    )
    told = (_named(cheapest(part, lights, target)) for part in (found, compact))
    return "<br>".join(told)


def _named(row: RepresentationResult | None) -> str:
    return f"{row.name} ({row.floats:.3g}, {row.light_floats:.3g})" if row else "none"


def ranked(found: Comparison, name: str, thesis: Thesis) -> str:
    """One set of lights, ours beside tables 6.1 and 6.2."""
    number = NUMBERS.get(name)
    rows = []
    for row in found.of(name):
        printed = thesis.get((name, row.name))
        told = [f"{printed.mean:.3f}", f"{printed.q97_5:.3f}"] if printed else ["", ""] if number else []
        shown = f"**{row.name}**" if row.statistics.mean < 1 else row.name
        cost = [f"{row.floats:.3g}", f"{row.light_floats:.3g}", format_time(row.ns.median)]
        rows.append([shown, *_statistics(row.statistics), *told, *cost])
    beside = f" *Thesis* is its table {number}, on other surfaces." if number else ""
    return table(
        heading(found.sets[name]),
        f"ΔE00, ranked by mean; bold where the mean is below 1.{beside}",
        ["", *HEADINGS, *(("thesis: mean", "97.5 %") if number else ()), "floats", "of a light", "product"],
        rows,
    )


def closed(rows: Sequence[Closed], thesis: Thesis) -> str:
    """Both readings of Riemann sums, beside the thesis."""
    return table(
        "Riemann sums at the thesis's word",
        "Mean ΔE00 where the cells are disjoint, as in the tables above, and where a sample of the 5 nm table that "
        "lies on a border counts in both cells, as eq. 5.3 of the thesis reads.",
        ["lights", "", "disjoint", "closed", "thesis"],
        [
            [
                row.lights,
                row.name,
                *(f"{one.mean:.3f}" for one in (row.disjoint, row.closed, thesis[row.key])),
            ]
            for row in rows
        ],
    )


def filters(
    tuned: Sequence[Tuned], lights: str, title: str, thesis: Mapping[tuple[str, int, str], Printed]
) -> str:
    """Ours beside table A.1 or A.2."""
    bare = {one.count: one.statistics.mean for one in tuned if one.kind == NONE and one.lights == lights}
    rows = []
    for one in tuned:
        if one.lights == lights:
            printed = thesis[lights, one.count, one.kind]
            rows.append(
                [
                    str(one.count),
                    one.kind,
                    f"{one.statistics.mean:.3f}",
                    f"{one.statistics.deviation:.3f}",
                    _change(one.statistics.mean, bare[one.count]),
                    one.told,
                    f"{printed.mean:.3f}",
                    _change(printed.mean, thesis[lights, one.count, NONE].mean),
                    printed.parameters,
                ]
            )
    rows.sort(key=lambda row: (int(row[0]), float(row[2])))
    number = "A.1" if lights == "smooth" else "A.2"
    return table(
        f"Low-pass filters, {title}",
        f"Point sampling after the best filter of each kind; *thesis* is table {number}.",
        ["samples", "filter", "mean", "σ", "change", "parameters", "thesis: mean", "change", "parameters"],
        rows,
    )


def _change(mean: float, bare: float) -> str:
    return "" if mean == bare else f"{100 * (mean / bare - 1):+.0f} %"


def _statistics(found: Statistics) -> list[str]:
    return [format_error(value) for value in found]
