"""The part of a report's page that speaks of the entries: the table, and the spectra of the worst."""

from __future__ import annotations

from uplift.lattice import Status
from uplift.report.assessment import Assessment
from uplift.report.charts import ACCENT, BAND, INK, spectra_chart
from uplift.report.fidelity import Entries
from uplift.report.markup import Markup, counted, element, joined, number, triple
from uplift.report.page_parts import (
    BAD,
    OWN,
    SEEN,
    Pairs,
    error_cells,
    error_headings,
    name_cell,
    note,
    own_cell,
    pair,
    pairs_of,
    right,
    severity,
    table,
)


def entries_section(found: Assessment, worst: int) -> Markup:
    """Every entry, worst first; or why there is none."""
    title = element("h2", "Entries")
    if found.entries is None:
        return element("section", title, element("p", _why_none(found)))
    entries = found.entries
    pairs = pairs_of(entries, found.lights)
    return element(
        "section",
        title,
        element("p", _about(found)),
        _outside(found),
        element("h3", "Under each light"),
        _by_light(found, entries),
        element("h3", "All of them" if worst >= len(entries.names) else f"The worst {worst}")
        if worst
        else None,
        _small_multiples(found, entries, pairs, worst) if worst else None,
        element("h3", "Entry by entry"),
        _note_on_entries(entries),
        _table(found, entries, pairs),
    )


def _note_on_entries(entries: Entries) -> Markup:
    text = (
        f"Swatches: measured on the left, answered on the right. ΔE00 above {SEEN:g} is bold, above {BAD:g} orange. "
        "rms is between the answer and the measured spectrum"
    )
    if entries.stored is not None:
        text += (
            f"; stored: between the answer and the spectrum that the cube stores for the entry. Own: {OWN}"
        )
    return note(f"{text}.")


def _why_none(found: Assessment) -> str:
    if found.sources:
        return f"{found.data.sensor.space} holds no entry of {', '.join(found.sources)}: nothing to compare."
    return (
        "The cube was built without an atlas, and none was given to judge it by: there is nothing to compare."
    )


def _about(found: Assessment) -> str:
    assert found.entries is not None
    count, files = counted(len(found.entries.names), "entry", "entries"), ", ".join(found.sources)
    if found.own:
        return f"The {count} of {files} that the cube was built from, each asked at its own RGB, worst first."
    return f"{count} of {files}, which the cube was not built from, each asked at its own RGB, worst first."


def _outside(found: Assessment) -> Markup | None:
    if found.own or not found.outside:
        return None  # of its own entries the failures have told
    return element("p", f"Not asked, being outside {found.data.sensor.space}: {', '.join(found.outside)}.")


def _by_light(found: Assessment, entries: Entries) -> Markup:
    lines = []
    for column, (light, part) in enumerate(found.delta_e.items()):
        worst = int(entries.delta_e[:, column].argmax())
        numbers = [part.mean, part.median, part.p95, part.largest]
        line = [light, *(number(_shown(value)) for value in numbers), entries.names[worst]]
        if entries.delta_e_stored is not None:
            stored = entries.delta_e_stored[:, column]
            line += [number(_shown(float(value))) for value in (stored.mean(), stored.max())]
        lines.append(line)
    headings = ["light", *map(right, ("mean", "median", "95 %", "max")), "worst entry"]
    if entries.delta_e_stored is not None:
        headings += [
            right(f"stored, {what}", "the stored spectrum against the measured") for what in ("mean", "max")
        ]
    return joined([_note_on_light(entries), table(headings, lines)])


def _shown(delta_e: float) -> Markup:
    return element("span", f"{delta_e:.3f}", class_=severity(delta_e))


def _note_on_light(entries: Entries) -> Markup | None:
    if entries.delta_e_stored is None:
        return None
    text = (
        "ΔE00 between answered and measured; on the right, between the spectrum stored for the entry and the measured "
        "one: what the model's coefficients cannot say, whatever the lattice."
    )
    return note(text)


def _small_multiples(found: Assessment, entries: Entries, pairs: Pairs, worst: int) -> Markup:
    figures = (_figure(found, entries, row, pairs) for row in range(min(worst, len(entries.names))))
    return joined([_key(entries), element("div", *figures, class_="grid")])


def _figure(found: Assessment, entries: Entries, row: int, pairs: Pairs) -> Markup:
    stored = None if entries.stored is None else entries.stored[row]
    strips = [
        element(
            "span",
            pair(*pairs[column][row]),
            element("span", seen.illuminant),
            element("b", f"{value:.2f}", class_=severity(value) or "plain"),
        )
        for column, (seen, value) in enumerate(zip(found.lights, entries.delta_e[row].tolist(), strict=True))
    ]
    name = element("b", entries.names[row], title=triple(entries.rgb[row]))
    return element(
        "figure",
        element("figcaption", name, element("small", f"rms {entries.rms[row]:.4f}")),
        element("div", *strips, class_="strip"),
        spectra_chart(found.data.sensor.wavelengths, entries.wanted[row], entries.answered[row], stored),
    )


def _key(entries: Entries) -> Markup:
    lines: list[tuple[str, str, float, str | None]] = [
        ("measured", BAND, 5, None),
        ("answered", ACCENT, 1.8, None),
    ]
    if entries.stored is not None:
        lines.append(("stored for the entry", INK, 1.8, "2 2.6"))
    parts = [
        element(
            "span",
            element(
                "svg",
                element(
                    "path",
                    d="M0 4H34",
                    stroke=colour,
                    stroke_width=str(width),
                    stroke_dasharray=dash,
                    fill="none",
                ),
                viewBox="0 0 34 8",
            ),
            name,
            class_="key",
        )
        for name, colour, width, dash in lines
    ]
    end = "Reflectance over wavelength in nm; below each light, ΔE00. Swatches: measured on the left, answered right."
    return element("p", *parts, element("br"), end, class_="note")


def _table(found: Assessment, entries: Entries, pairs: Pairs) -> Markup:
    headings = [element("th", "entry"), *error_headings(entries, found.lights, "measured")]
    headings += [
        *([] if entries.own is None else [right("own", OWN)]),
        element("th", "voxel", title="its corners, by status"),
    ]
    lines = (
        [
            name_cell(entries, row),
            *error_cells(entries, row, pairs, "measured"),
            own_cell(entries, row),
            _corners(entries, row),
        ]
        for row in range(len(entries.names))
    )
    return table(headings, lines, "sortable")


def _corners(entries: Entries, row: int) -> Markup:
    """The eight corners of the entry's voxel, by status."""
    kinds = zip(Status, entries.corners[row].tolist(), strict=True)
    stated = (f"{count} {status.label.removeprefix('atlas ')}" for status, count in kinds if count)
    return element("td", element("small", ", ".join(stated)), class_="corners")
