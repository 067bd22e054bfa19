"""The part of a report's page that speaks of entries which share a voxel."""

from __future__ import annotations

from uplift.report.assessment import Assessment
from uplift.report.crowding import Crowd
from uplift.report.markup import Markup, element
from uplift.report.page_parts import (
    OWN,
    error_cells,
    error_headings,
    name_cell,
    note,
    own_cell,
    pairs_of,
    right,
    table,
)


def crowding_section(found: Assessment) -> Markup | None:
    """Voxels that several entries share, and what that costs each; None for a cube without entries."""
    if not found.data.atlas.names:
        return None
    title = element("h2", "Crowding")
    if not found.crowds:
        return element("section", title, element("p", "Every entry has a voxel to itself."))
    wanted = "measured" if found.own else "stored"
    told = (
        f"Entries in one voxel share its eight corners; a larger dim "
        f"parts them. ΔE00 and rms are between the answer and the {wanted} spectrum."
    )
    first = found.crowds[0].entries
    headings = ["voxel, linear RGB", "entry", *error_headings(first, found.lights, wanted), right("own", OWN)]
    lines = [line for crowd in found.crowds for line in _crowd(found, crowd, wanted)]
    return element("section", title, note(told), table(headings, lines, ""))


def _crowd(found: Assessment, crowd: Crowd, wanted: str) -> list[list[Markup | None]]:
    """A row an entry; the first has the voxel, which stands for all."""
    entries, pairs = crowd.entries, pairs_of(crowd.entries, found.lights)
    ranges = (
        f"{letter} {low:.4f}–{high:.4f}" for letter, low, high in zip("RGB", *crowd.bounds, strict=True)
    )
    place = ", ".join(map(str, crowd.cell))
    voxel = element(
        "td",
        place,
        *(element("small", part) for part in ranges),
        rowspan=len(entries.names),
        class_="voxel",
    )
    lines: list[list[Markup | None]] = [
        [
            name_cell(entries, row, "name inner"),
            *error_cells(entries, row, pairs, wanted),
            own_cell(entries, row),
        ]
        for row in range(len(entries.names))
    ]
    lines[0].insert(0, voxel)
    return lines
