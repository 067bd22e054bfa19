"""What several sections of a report's page share: swatches, tables, the cells of an entry's errors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from uplift.report.fidelity import Entries
from uplift.report.markup import Markup, element, joined, number, rows, triple
from uplift.report.numbers import swatches
from uplift.sensor import Sensor

SEEN, BAD = 1.0, 3.0
"""ΔE00 that one sees side by side, and that nobody overlooks."""
OWN = "trilinear weight of the voxel's corners that are based on the entry itself"

Pairs = Sequence[Sequence[tuple[str, str]]]
"""``#rrggbb`` as measured and as answered, for each light and entry."""


def pair(first: str, second: str, title: str | None = None) -> Markup:
    """A swatch of two colours that touch."""
    halves = (element("i", style=f"background:{code}") for code in (first, second))
    return element("span", *halves, class_="pair", title=title or f"{first} | {second}")


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


def pairs_of(found: Entries, lights: Sequence[Sensor]) -> Pairs:
    """Swatches under each light."""
    return [swatches(found, seen) for seen in lights]


def error_headings(found: Entries, lights: Sequence[Sensor], wanted: str) -> Iterator[Markup]:
    """Over `error_cells`; ``wanted`` is what the answers are held against, measured or stored."""
    yield right("worst", "largest ΔE00 under any of the lights", "descending")
    for seen in lights:
        yield right(seen.illuminant, f"{wanted} | answered under {seen.illuminant}, and their ΔE00")
    yield right("rms", f"rms over wavelength to the {wanted} spectrum")
    if found.rms_stored is not None and wanted != "stored":
        yield right("stored", "rms over wavelength to the spectrum that the cube stores for the entry")


def error_cells(found: Entries, row: int, pairs: Pairs, wanted: str) -> Iterator[Markup]:
    """The errors of one entry: the worst, under each light with its swatches, and rms."""
    yield _difference(float(found.worst[row]))
    for column, colours in enumerate(pairs):
        yield _difference(float(found.delta_e[row, column]), pair(*colours[row]))
    yield _rms(float(found.rms[row]))
    if found.rms_stored is not None and wanted != "stored":
        yield _rms(float(found.rms_stored[row]))


def name_cell(found: Entries, row: int, class_: str = "name") -> Markup:
    """An entry by name and linear RGB."""
    return element("td", found.names[row], element("small", triple(found.rgb[row])), class_=class_)


def own_cell(found: Entries, row: int) -> Markup | None:
    """How much of its voxel an entry has; None where no entry has any."""
    return None if found.own is None else number(f"{found.own[row]:.0%}", data_value=f"{found.own[row]:.9g}")


def _difference(value: float, swatch: Markup | None = None) -> Markup:
    shown = element("span", f"{value:.2f}", class_=severity(value))
    return number(joined([swatch, shown]), data_value=f"{value:.9g}")


def _rms(value: float) -> Markup:
    return number(f"{value:.4f}", data_value=f"{value:.9g}")
