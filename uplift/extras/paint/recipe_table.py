"""Tables of recipes: which paints a measured sample has, in which parts, and on which
ground.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uplift.atlas.document import SourceLocation, read_document, truncate
from uplift.common.arrays import StrPath
from uplift.common.text import format_value
from uplift.extras.files.csv import (
    find_delimiter,
    is_decimal,
    parse_decimal,
    split_line,
)
from uplift.extras.formats.tables.cells import parse_cell, parse_label
from uplift.extras.paint.coats import MAX_THICKNESS
from uplift.extras.paint.paint_columns import (
    LENGTH,
    MICROMETRES,
    Columns,
    find_columns,
)

UNIT = re.compile(rf"(?<![^\W\d_])({LENGTH})(?![^\W_])", re.IGNORECASE)
THOUSANDS = re.compile(r"[1-9]\d{0,2},\d{3}")


@dataclass(frozen=True)
class Recipe:
    """A row of a table of recipes."""

    name: str
    parts: tuple[float, ...]
    thickness: float
    """Infinite for an opaque sample."""
    ground: str
    colour: str
    line: int

    @property
    def is_ground(self) -> bool:
        """Whether it is the ground of others, without paint."""
        return not any(self.parts)


@dataclass(frozen=True)
class RecipeTable:
    """The recipes of a file, with the names of its paints."""

    paints: tuple[str, ...]
    recipes: tuple[Recipe, ...]
    location: SourceLocation
    has_spectra: bool
    """Whether it has columns of wavelengths as well."""
    notes: tuple[str, ...]
    """How the content was understood."""


def read_recipes(path: StrPath) -> RecipeTable:
    """Read a table of recipes: a header row, and a row per sample."""
    document = read_document(path)
    lines = document.text.splitlines()
    content = [
        (number, line)
        for number, line in enumerate(lines, start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    delimiter = find_delimiter(line for _, line in content)
    rows = [(number, split_line(line, delimiter)) for number, line in content]
    location = document.location
    start, head = next(
        ((at, row) for at, (_, row) in enumerate(rows) if len(row) > 1), (0, [])
    )
    width = max((len(row) for _, row in rows), default=1)
    head = [*head, *[""] * (width - len(head))]
    padded = [
        (number, [*row, *[""] * (width - len(row))])
        for number, row in rows[start + 1 :]
        if any(row)
    ]
    columns = find_columns(head, [row for _, row in padded], location)
    if not columns.paints:
        raise location.error(
            "no column has the parts of a paint",
            "name columns after the paints, and write their parts in each row",
            code="no-paints",
        )
    films = [_cell(cells, columns.thickness) for _, cells in padded]
    label = _cell(head, columns.thickness)
    unit = next(filter(None, map(_unit, (label, *films))), "")
    recipes = tuple(_recipes(padded, columns, unit, delimiter, location))
    has_spectra = any(parse_label(text) is not None for text in head)
    notes = list[str]()
    if columns.unused:
        labels = [truncate(label) or "(no label)" for label in columns.unused]
        notes.append(f"not used: {', '.join(labels)}")
    if unit:
        notes.append(f"thickness in {unit}")
    if columns.thickness is None and any(
        np.isfinite(recipe.thickness) for recipe in recipes
    ):
        notes.append("no thickness is stated: that of all films is 1")
    return RecipeTable(
        tuple(columns.paints), recipes, location, has_spectra, tuple(notes)
    )


def _recipes(
    rows: Sequence[tuple[int, Sequence[str]]],
    columns: Columns,
    unit: str,
    delimiter: str,
    location: SourceLocation,
) -> Iterator[Recipe]:
    """Yield the recipes of rows, with thicknesses in a unit."""
    names = set[str]()
    for line, cells in rows:
        name = cells[columns.name]
        here = location.at(line, name)
        if name in names:
            raise here.error(
                f"two samples have the name {format_value(name)}",
                "name each measurement, such as 'a 1' and 'a 2'",
            )
        names.add(name)
        parts = tuple(
            _parts(paint, cells[column], delimiter, here)
            for paint, column in columns.paints.items()
        )
        ground = _cell(cells, columns.ground)
        text = _cell(cells, columns.thickness)
        is_stated = columns.thickness is not None and any(parts)
        if is_stated and bool(text) != bool(ground):
            raise here.error(
                "a film must have a thickness and a ground, got "
                f"{format_value(text)} and {format_value(ground)}",
                "name its ground (white, black, or a sample without paint); leave both "
                "empty for opaque samples",
            )
        thickness = 1.0 if ground else np.inf
        if text:
            thickness = _thickness(text, unit, here)
        yield Recipe(
            name,
            parts,
            thickness,
            ground or "white",
            _cell(cells, columns.colour),
            line,
        )


def _cell(cells: Sequence[str], column: int | None) -> str:
    return "" if column is None else cells[column]


def _parts(paint: str, text: str, delimiter: str, location: SourceLocation) -> float:
    parts = parse_cell(text) if text else 0.0
    # Next to commas between cells, that of "1,250" may be of thousands or of decimals.
    is_ambiguous = delimiter == "," and THOUSANDS.fullmatch(text)
    if is_ambiguous or parts is None or not 0 <= parts < np.inf:
        raise location.error(
            f"parts of {format_value(paint)} must be finite and at least 0, got "
            f"{format_value(text)}",
            "write 1250 or 1.25, or delete the column if it is not a paint",
            code="invalid-parts",
        )
    return parts


def _unit(text: str) -> str:
    """Return the unit of length in a text, empty without one."""
    match = UNIT.search(text)
    return match[0].casefold() if match else ""


def _thickness(text: str, unit: str, location: SourceLocation) -> float:
    """Return a thickness in a unit, which its cell may replace by another one."""
    number = UNIT.sub("", text).strip()
    thickness = parse_decimal(number) if is_decimal(number) else np.nan
    if stated := _unit(text):
        thickness *= _micrometres(stated) / _micrometres(unit)
    if not 0 < thickness <= MAX_THICKNESS:
        raise location.error(
            f"thickness must be in (0, {MAX_THICKNESS:g}], got {format_value(text)}",
            "leave it empty for opaque samples",
        )
    return thickness


def _micrometres(unit: str) -> float:
    return MICROMETRES[unit.removesuffix("s")]
