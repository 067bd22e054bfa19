"""What several sections of a report's page share: swatches, tables, the cells of an entry's errors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from uplift.colorimetry.sensor import Sensor
from uplift.report.charts import histogram_chart
from uplift.report.fidelity import EntryErrors
from uplift.report.json_export import swatches
from uplift.viz.format import format_rgb, format_scientific
from uplift.viz.histogram import Histogram
from uplift.viz.markup import Markup, element, joined, number, rows

SEEN, BAD = 1.0, 3.0
"""ΔE00 that one sees side by side, and that nobody overlooks."""

Swatches = Sequence[Sequence[tuple[str, ...]]]
"""`swatches` of each light, for each entry."""


def swatch(*codes: str) -> Markup:
    """Colours that touch, each ``#rrggbb``."""
    parts = (element("i", style=f"background:{code}") for code in codes)
    return element("span", *parts, class_="swatch", title=" | ".join(codes))


def note(text: str) -> Markup:
    """What a table or a chart needs to be read."""
    return element("p", text, class_="note")


def table(headings: Iterable[str], lines: Iterable[Iterable[str | None]], class_: str = "slim") -> Markup:
    """Headings and rows, each within reach of a narrow screen."""
    head = element("thead", rows([headings], "th"))
    return element(
        "div", element("table", head, element("tbody", rows(lines)), class_=class_), class_="scroll"
    )


def right(heading: str, title: str | None = None, sort: str | None = None) -> Markup:
    """A heading over numbers."""
    return element("th", heading, class_="number", title=title, aria_sort=sort)


def severity(delta_e: float) -> str | None:
    """The class of a ΔE00."""
    return "bad" if delta_e > BAD else "seen" if delta_e > SEEN else None


def figure(
    title: str, part: Histogram, label: str, *, top: int | None = None, limit: float | None = None
) -> Markup:
    """A histogram under its title and the few numbers that say most."""
    named = ("mean", part.mean), ("median", part.median), ("95 %", part.p95), ("max", part.largest)
    stated = (element("span", element("small", name), format_scientific(value)) for name, value in named)
    caption = element("figcaption", element("b", title), element("div", *stated, class_="stats"))
    return element("figure", caption, histogram_chart(part, label, top=top, threshold=limit))


def charts(figures: list[Markup]) -> Markup:
    """Figures, and what else may stand with them, in columns."""
    return element("div", *figures, class_="charts")


def swatches_of(found: EntryErrors, lights: Sequence[Sensor]) -> Swatches:
    """Swatches under each light."""
    return [swatches(found, seen) for seen in lights]


def error_headings(lights: Sequence[Sensor], wanted: str) -> Iterator[Markup]:
    """Over `error_cells`; ``wanted`` is what the answers are held against, measured or stored."""
    yield right("worst", "largest ΔE00 under any of the lights", "descending")
    for seen in lights:
        yield right(seen.illuminant, f"{wanted} | answered under {seen.illuminant}, and their ΔE00")
    yield right("rms", f"rms over wavelength to the {wanted} spectrum")


def error_cells(found: EntryErrors, row: int, shown: Swatches, *, lattice: bool = False) -> Iterator[Markup]:
    """The errors of one entry: the worst, under each light with its swatches, and rms.

    With ``lattice``, which own entries have, those of the lattice by itself stand below, and the cells sort by them.
    """
    below, rms = None, None
    if lattice:
        assert found.delta_e_lattice is not None
        assert found.rms_lattice is not None
        below, rms = found.delta_e_lattice[row].tolist(), float(found.rms_lattice[row])
    yield difference(float(found.worst[row]), below and max(below))
    for column, codes in enumerate(shown):
        seen = swatch(*codes[row][: 3 if lattice else 2])
        yield difference(float(found.delta_e[row, column]), below and below[column], seen)
    yield _cell("{:.4f}", float(found.rms[row]), rms)


def name_cell(found: EntryErrors, row: int) -> Markup:
    """An entry by name and linear RGB."""
    return element("td", found.names[row], element("small", format_rgb(found.rgb[row])), class_="name")


def reach_heading() -> Markup:
    """Over `reach_cell`."""
    return right(
        "reach", "lattice steps around the entry's colour within which answers lead over to its spectrum"
    )


def reach_cell(found: EntryErrors, row: int) -> Markup:
    """How far an own entry is felt, in lattice steps and in 8-bit codes."""
    assert found.reach is not None
    assert found.codes is not None
    reach = float(found.reach[row])
    shown = joined([f"{reach:.2f}", element("small", f"± {found.codes[row]:.1f} codes")])
    if not reach:
        shown = element("span", "lost", class_="bad")
    return number(shown, data_value=f"{reach:.9g}")


def plain_cell(value: float) -> Markup:
    """A cell of ΔE00 that is nobody's fault."""
    return _cell("{:.2f}", value, None)


def difference(value: float, below: float | None = None, seen: Markup | None = None) -> Markup:
    """A cell of ΔE00, after its swatch; another ``below`` it, by which the cell then sorts."""
    return _cell("{:.2f}", value, below, seen, graded=True)


def _cell(
    form: str, value: float, below: float | None, seen: Markup | None = None, *, graded: bool = False
) -> Markup:
    shown = [
        element("span", form.format(part), class_=severity(part) if graded else None)
        for part in (value, below)
        if part is not None
    ]
    figures = element("span", *shown, class_="stack") if below is not None else shown[0]
    return number(joined([seen, figures]), data_value=f"{value if below is None else below:.9g}")
