"""A comparison as one HTML page that needs nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from uplift.lab.comparison.cost import numbered
from uplift.lab.comparison.filters import Tuned
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.lab.comparison.statistics import HEADINGS, Statistics
from uplift.lab.comparison.style import families, heading
from uplift.report.page_parts import note, right, table
from uplift.viz.document import Told, document, family_boxes, footer
from uplift.viz.format import format_error, format_time
from uplift.viz.markup import Markup, element, number

TITLE = "Representations of spectra"
SOURCES = (
    "Kment 2011, Spectral data representation techniques for realistic image synthesis: point sampling, Riemann sums "
    "and their enhancement, the lights and the statistics.",
    "Sun, Drew & Fracchia 1999: the composite model. Peercy 1993: linear models. Wilkie et al. 2014: hero wavelengths. "
    "Peters et al. 2019: trigonometric moments. Jakob & Hanika 2019: the sigmoid.",
)


def page(found: Comparison, pictures: Mapping[str, Markup], tuned: Sequence[Tuned] = ()) -> str:
    """The whole HTML text; ``pictures`` are those of `pictures.DRAWN`. The same comparison gives the same text."""
    parts = [
        family_boxes(families(found.rows)),
        element("div", pictures["cost"], class_="picture"),
        element(
            "section",
            element("h2", "Distributions"),
            note("Boxes from 25 to 75 %, the median within, whiskers from 2.5 to 97.5 %."),
            element("div", pictures["boxes"], class_="picture"),
        ),
        *(_ranked(title, found.of(name)) for name, title in found.sets.items()),
        *(_filters(name, title, tuned) for name, title in found.sets.items() if tuned),
        footer(found.facts, SOURCES),
    ]
    return document(TITLE, _lead(found), parts, _told(found))


def _lead(found: Comparison) -> str:
    return (
        f"{len(numbered(found))} ways to hold spectra in a renderer. Each multiplies the same lights with the same "
        "measured surfaces; errors are ΔE00 to products of densely sampled data. Lower is nearer, left is cheaper."
    )


def _ranked(title: str, rows: Sequence[RepresentationResult]) -> Markup:
    told = note("Ranked by mean ΔE00. Click a heading to sort.")
    headings = [element("th", "representation"), *map(right, (*HEADINGS, "floats", "of a light", "product"))]
    return element(
        "section", element("h2", heading(title)), told, table(headings, map(_cells, rows), "sortable")
    )


def _cells(row: RepresentationResult) -> list[Markup]:
    floats = [number(f"{value:.1f}", data_value=f"{value:.6g}") for value in (row.floats, row.light_floats)]
    time = number(format_time(row.ns.median), data_value=f"{row.ns.median:.6g}")
    name = element("td", row.name, element("small", row.family), class_="name")
    return [name, *_statistics(row.statistics), *floats, time]


def _statistics(found: Statistics) -> list[Markup]:
    return [number(format_error(value), data_value=f"{value:.6g}") for value in found]


def _filters(name: str, title: str, tuned: Sequence[Tuned]) -> Markup:
    told = note("Point sampling after the best low-pass filter of each kind, found by grid search.")
    headings = [element("th", text) for text in ("samples", "filter", "parameters")]
    lines = [
        [str(one.count), one.kind, one.told, *_statistics(one.statistics)]
        for one in tuned
        if one.lights == name
    ]
    head = element("h2", f"Low-pass filters, {title}")
    return element("section", head, told, table([*headings, *map(right, HEADINGS)], lines))


def _told(found: Comparison) -> list[Told]:
    """What hovering tells of each representation, in the order of `numbered`."""
    return [_told_of(name, found) for name in numbered(found)]


def _told_of(name: str, found: Comparison) -> Told:
    rows = [row for row in found.rows if row.name == name]
    lines = [("floats of a surface", f"{rows[0].floats:.1f}")]
    for row in rows:
        told = f"{format_error(row.statistics.mean)} / {format_error(row.statistics.q97_5)}"
        lines += [
            (f"{row.lights}: ΔE00, mean / 97.5 %", told),
            (f"{row.lights}: floats of a light", f"{row.light_floats:.1f}"),
            (f"{row.lights}: product", format_time(row.ns.median)),
        ]
    return {"title": name, "family": rows[0].family, "lines": lines}
