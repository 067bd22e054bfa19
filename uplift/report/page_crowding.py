"""The part of a report's page that speaks of entries which stand close to others."""

from __future__ import annotations

from uplift.report.assessment import Assessment
from uplift.report.crowding import Crowding
from uplift.report.page_parts import (
    error_cells,
    error_headings,
    name_cell,
    note,
    reach_cell,
    reach_heading,
    swatches_of,
    table,
)
from uplift.viz.format import pluralise
from uplift.viz.markup import Markup, element, joined


def crowding_section(found: Assessment) -> Markup | None:
    """Who crowds whom, and what that costs; None for a cube without entries."""
    if found.crowding is None:
        return None
    title = element("h2", "Crowding")
    if not found.crowding.entries.names:
        return element("section", title, element("p", "No entry has another within a lattice step."))
    return element(
        "section", title, _lost(found.crowding), _advice(found, found.crowding), _table(found, found.crowding)
    )


def crowding_told(found: Assessment, crowding: Crowding) -> tuple[str, str]:
    """A title, and what it means, for those in a hurry."""
    dim, count = found.data.lattice.dim, len(crowding.entries.names)
    if not count:
        return "No entry crowds", f"none has another within a lattice step at dim {dim}"
    title = f"{pluralise(count, 'entry', 'entries')} crowd" + ("s" if count == 1 else "")
    lost = f"; {len(crowding.lost):,} lost" if crowding.lost else ""
    return title, f"of {len(found.data.atlas.names):,}, within a lattice step of another at dim {dim}{lost}"


def _lost(crowding: Crowding) -> Markup | None:
    if not crowding.lost:
        return None
    told = "; ".join(f"{name} (that of {other})" for name, other in crowding.lost)
    return element(
        "p",
        element("span", "Lost, as an earlier entry has the same colour: ", class_="bad"),
        f"{told}. A cube answers a colour once; no dim parts these.",
    )


def _advice(found: Assessment, crowding: Crowding) -> Markup:
    wanted = "measured" if found.own else "stored"
    answered = (
        "with the spectrum stored for it" if not crowding.lost else "with its own spectrum, unless it is lost"
    )
    return joined(
        [
            element(
                "p",
                "These entries have another within a lattice step. ",
                element("code", "uplift build --dim auto"),
                " looks for the smallest dim with room for all.",
            ),
            note(
                f"Asked at its own colour an entry is answered {answered}; within its reach that leads over to "
                "what the lattice by itself, which close entries share, makes of the colours around. In each cell, "
                f"above: the answer at the entry's colour; below: the lattice by itself, there. ΔE00 and rms are "
                f"against the {wanted} spectrum; swatches: {wanted}, answered, lattice."
            ),
        ]
    )


def _table(found: Assessment, crowding: Crowding) -> Markup:
    entries = crowding.entries
    shown = swatches_of(entries, found.lights)
    wanted = "measured" if found.own else "stored"
    headings = [element("th", "entry"), reach_heading(), element("th", "nearest other")]
    headings += error_headings(found.lights, wanted)
    lines = (
        [
            name_cell(entries, row),
            reach_cell(entries, row),
            element(
                "td",
                crowding.nearest[row],
                element("small", f"{crowding.apart[row]:.2f} steps away"),
                class_="name",
            ),
            *error_cells(entries, row, shown, lattice=True),
        ]
        for row in range(len(entries.names))
    )
    return table(headings, lines, "sortable stacked")
