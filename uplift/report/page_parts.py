"""What several sections of a report's page share: swatches, tables, the cells of an entry's errors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from uplift.lattice import Status
from uplift.report.fidelity import Entries
from uplift.report.markup import Markup, element, joined, number, rows, triple
from uplift.report.numbers import swatches
from uplift.sensor import Sensor

SEEN, BAD = 1.0, 3.0
"""ΔE00 that one sees side by side, and that nobody overlooks."""

Pairs = Sequence[Sequence[tuple[str, str]]]
"""``#rrggbb`` as measured and as answered, for each light and entry."""


def chip(code: str) -> Markup:
    """A swatch of one colour, ``#rrggbb``."""
    return element("i", class_="chip", style=f"background:{code}", title=code)


def pair(first: str, second: str, title: str | None = None) -> Markup:
    """A swatch of two colours that touch."""
    halves = (element("i", style=f"background:{code}") for code in (first, second))
    return element("span", *halves, class_="pair", title=title or f"{first} | {second}")


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


def pairs_of(found: Entries, lights: Sequence[Sensor]) -> Pairs:
    """Swatches under each light."""
    return [swatches(found, seen) for seen in lights]


def error_headings(found: Entries, lights: Sequence[Sensor], wanted: str) -> Iterator[Markup]:
    """Over `error_cells`; ``wanted`` is what the answers are held against, measured or stored."""
    yield right("worst", "largest ΔE00 under any of the lights", "descending")
    for seen in lights:
        yield right(seen.illuminant, f"{wanted} | answered under {seen.illuminant}, and their ΔE00")
    yield right(f"rms to {wanted}")
    if found.rms_stored is not None and wanted != "stored":
        yield right("to stored", "rms to the spectrum that the cube stores for the entry")
    yield element("th", "voxel", title="what the eight corners of its voxel are")


def error_cells(found: Entries, row: int, pairs: Pairs, wanted: str) -> Iterator[Markup]:
    """The errors of one entry: the worst, under each light with its swatches, rms, and its voxel."""
    yield _difference(float(found.worst[row]))
    for column, colours in enumerate(pairs):
        yield _difference(float(found.delta_e[row, column]), pair(*colours[row]))
    yield _rms(float(found.rms[row]))
    if found.rms_stored is not None and wanted != "stored":
        yield _rms(float(found.rms_stored[row]))
    yield element("td", *_voxel(found, row))


def name_cell(found: Entries, row: int) -> Markup:
    """An entry by name and linear RGB."""
    return element("td", found.names[row], element("small", triple(found.rgb[row])), class_="name")


def _difference(value: float, swatch: Markup | None = None) -> Markup:
    shown = element("span", f"{value:.2f}", class_=severity(value))
    return number(joined([swatch, shown]), data_value=f"{value:.9g}")


def _rms(value: float) -> Markup:
    return number(f"{value:.4f}", data_value=f"{value:.9g}")


def _voxel(found: Entries, row: int) -> Iterator[str]:
    if found.own is not None:
        yield f"{found.own[row]:.0%} own"
    kinds = zip(Status, found.corners[row].tolist(), strict=True)
    stated = ", ".join(f"{count} {status.label.removeprefix('atlas ')}" for status, count in kinds if count)
    yield element("small", stated)
