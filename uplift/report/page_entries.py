"""The part of a report's page that speaks of the entries: the table, and the spectra of the worst."""

from __future__ import annotations

from uplift.report.assessment import Assessment
from uplift.report.fidelity import EntryErrors
from uplift.report.page_parts import (
    BAD,
    SEEN,
    Swatches,
    difference,
    error_cells,
    error_headings,
    name_cell,
    note,
    plain_cell,
    reach_cell,
    reach_heading,
    right,
    severity,
    swatches_of,
    table,
)
from uplift.report.page_spectra import small_multiples
from uplift.viz.format import pluralise
from uplift.viz.markup import Markup, element, joined, number


def entries_section(found: Assessment, worst: int) -> Markup:
    """Every entry, worst first; or why there is none."""
    title = element("h2", "Entries")
    if found.entries is None:
        return element("section", title, element("p", _why_none(found)))
    entries = found.entries
    shown = swatches_of(entries, found.lights)
    return element(
        "section",
        title,
        element("p", _about(found)),
        _outside(found),
        _absent(found),
        element("h3", "Under each light"),
        _by_light(found, entries),
        element("h3", "All of them" if worst >= len(entries.names) else f"The worst {worst}")
        if worst
        else None,
        small_multiples(found, entries, shown, worst) if worst else None,
        element("h3", "Entry by entry"),
        _note_on_entries(found, entries),
        _table(found, entries, shown),
    )


def _note_on_entries(found: Assessment, entries: EntryErrors) -> Markup:
    text = (
        "Swatches: measured on the left, answered on the right; what sRGB cannot show is less saturated there. "
        f"ΔE00 above {SEEN:g} is bold, above {BAD:g} orange. "
        "rms is between the answer and the measured spectrum"
    )
    if entries.lattice is not None:
        text += (
            ". Lattice: the worst ΔE00 of what the lattice by itself, the entry aside, makes of its colour. Reach: how "
            "far around, in lattice steps and in 8-bit codes, answers lead over from the one to the other"
        )
    elif entries.stated is not None:
        text += (
            ". Stated: the cube's standard error there; real: the ΔE00 that it turned out to be, both under "
            f"{found.data.error_illuminant}"
        )
    return note(f"{text}.")


def _why_none(found: Assessment) -> str:
    if found.absent:
        return f"The cube has no points for any entry of {', '.join(found.sources)}: nothing to compare."
    if found.sources:
        return f"{found.data.sensor.space} holds no entry of {', '.join(found.sources)}: nothing to compare."
    return (
        "The cube was built without an atlas, and none was given to judge it by: there is nothing to compare."
    )


def _about(found: Assessment) -> str:
    assert found.entries is not None
    count, files = pluralise(len(found.entries.names), "entry", "entries"), ", ".join(found.sources)
    if found.own:
        return f"The {count} of {files} that the cube was built from, each asked at its own RGB, worst first."
    return f"{count} of {files}, which the cube was not built from, each asked at its own RGB, worst first."


def _outside(found: Assessment) -> Markup | None:
    if found.own or not found.outside:
        return None  # of its own entries the failures have told
    return element("p", f"Not asked, being outside {found.data.sensor.space}: {', '.join(found.outside)}.")


def _absent(found: Assessment) -> Markup | None:
    if not found.absent:
        return None
    return element("p", f"Not asked, as the cube has no points for them: {', '.join(found.absent)}.")


def _by_light(found: Assessment, entries: EntryErrors) -> Markup:
    lines = []
    for column, (light, part) in enumerate(found.delta_e.items()):
        worst = int(entries.delta_e[:, column].argmax())
        numbers = [part.mean, part.median, part.p95, part.largest]
        line = [light, *(number(_shown(value)) for value in numbers), entries.names[worst]]
        if entries.delta_e_lattice is not None:
            lattice = entries.delta_e_lattice[:, column]
            line += [number(_shown(float(value))) for value in (lattice.mean(), lattice.max())]
        lines.append(line)
    headings = ["light", *map(right, ("mean", "median", "95 %", "max")), "worst entry"]
    if entries.delta_e_lattice is not None:
        headings += [
            right(f"lattice, {what}", "the lattice by itself against the measured")
            for what in ("mean", "max")
        ]
    return joined([_note_on_light(found, entries), table(headings, lines)])


def _shown(delta_e: float) -> Markup:
    return element("span", f"{delta_e:.3f}", class_=severity(delta_e))


def _note_on_light(found: Assessment, entries: EntryErrors) -> Markup | None:
    if entries.delta_e_lattice is None:
        return None
    lost = ", unless it is lost" if found.crowding is not None and found.crowding.lost else ""
    text = (
        "ΔE00 between answered and measured. At its own colour an entry is answered with the spectrum stored for "
        f"it{lost}: what is left is what {found.data.model.count} coefficients cannot say. On the right, what the "
        "lattice by itself makes of the same colours: that is how their surroundings are answered."
    )
    return note(text)


def _table(found: Assessment, entries: EntryErrors, shown: Swatches) -> Markup:
    headings = [
        element("th", "entry"),
        *error_headings(found.lights, "measured"),
        *_further_headings(found, entries),
    ]
    lines = (
        [
            name_cell(entries, row),
            *error_cells(entries, row, shown),
            *_further_cells(entries, row),
        ]
        for row in range(len(entries.names))
    )
    return table(headings, lines, "sortable")


def _further_headings(found: Assessment, entries: EntryErrors) -> list[Markup]:
    """Of own entries, what their surroundings are like; of others, how far the error was foreseen."""
    if entries.lattice is not None:
        return [
            right("lattice", "largest ΔE00 of the lattice by itself under any of the lights"),
            reach_heading(),
        ]
    if entries.stated is not None:
        light = found.data.error_illuminant
        return [
            right("stated", f"standard error, ΔE00 under {light}"),
            right("real", f"ΔE00 under {light}"),
        ]
    return []


def _further_cells(entries: EntryErrors, row: int) -> list[Markup]:
    if entries.worst_lattice is not None:
        return [difference(float(entries.worst_lattice[row])), reach_cell(entries, row)]
    if entries.stated is not None:
        return [plain_cell(float(entries.stated[row])), difference(float(entries.real[row]))]
    return []
