"""Tables of recipes: which paints a measured sample has, in which parts, and on which
ground.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.atlas.document import SourceLocation, read_document, truncate
from uplift.common.arrays import StrPath
from uplift.common.text import format_value
from uplift.extras.files.csv import is_decimal, parse_decimal
from uplift.extras.formats.delimited import split_rows
from uplift.extras.formats.tables.cells import parse_cell, parse_label, texts_of
from uplift.extras.paint.optics import MAX_THICKNESS
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
    location = document.location
    delimiter, rows = split_rows(document)
    start = next((at for at, row in enumerate(rows) if len(row) > 1), len(rows))
    # An empty column at the end stands for those that the table has not.
    width = max(map(len, rows), default=0) + 1
    texts = [[*texts_of(row), *[""] * (width - len(row))] for row in rows[start:]]
    head, *body = texts or [[""]]
    columns = find_columns(head, body, location)
    if not columns.paints:
        raise location.error(
            "no column has the parts of a paint",
            "name columns after the paints, and write their parts in each row",
            code="no-paints",
        )
    films = [head[columns.thickness], *(cells[columns.thickness] for cells in body)]
    unit = next(filter(None, map(_unit, films)), "")
    recipes = dict[str, Recipe]()
    for row, cells in zip(rows[start + 1 :], body, strict=True):
        here = location.at(row[0].line, cells[columns.name])
        recipe = _recipe(cells, columns, unit, delimiter, here)
        if recipe.name in recipes:
            raise here.error(
                f"two samples have the name {format_value(recipe.name)}",
                "name each measurement, such as 'a 1' and 'a 2'",
            )
        recipes[recipe.name] = recipe
    notes = list[str]()
    if columns.unused:
        labels = [truncate(label) or "(no label)" for label in columns.unused]
        notes.append(f"not used: {', '.join(labels)}")
    if unit:
        notes.append(f"thickness in {unit}")
    if columns.thickness < 0 and any(
        recipe.thickness == 1 for recipe in recipes.values()
    ):
        notes.append("no thickness is stated: that of all films is 1")
    has_spectra = any(parse_label(text) is not None for text in head)
    return RecipeTable(
        tuple(columns.paints),
        tuple(recipes.values()),
        location,
        has_spectra,
        tuple(notes),
    )


def _recipe(
    cells: Sequence[str],
    columns: Columns,
    unit: str,
    delimiter: str,
    location: SourceLocation,
) -> Recipe:
    """Return the recipe of a row, with a thickness in a unit."""
    parts = tuple(
        _parts(paint, cells[column], delimiter, location)
        for paint, column in columns.paints.items()
    )
    ground = cells[columns.ground]
    text = cells[columns.thickness]
    if columns.thickness >= 0 and any(parts) and bool(text) != bool(ground):
        raise location.error(
            "a film must have a thickness and a ground, got "
            f"{format_value(text)} and {format_value(ground)}",
            "name its ground (white, black, or a sample without paint); leave both "
            "empty for opaque samples",
        )
    thickness = 1.0 if ground else np.inf
    if text:
        thickness = _thickness(text, unit, location)
    return Recipe(
        cells[columns.name],
        parts,
        thickness,
        ground or "white",
        cells[columns.colour],
        location.line or 0,
    )


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
    return match[0].casefold().removesuffix("s") if match else ""


def _thickness(text: str, unit: str, location: SourceLocation) -> float:
    """Return a thickness in a unit, which its cell may replace by another one."""
    number = UNIT.sub("", text).strip()
    thickness = parse_decimal(number) if is_decimal(number) else np.nan
    if stated := _unit(text):
        thickness *= MICROMETRES[stated] / MICROMETRES[unit]
    if not 0 < thickness <= MAX_THICKNESS:
        raise location.error(
            f"thickness must be in (0, {MAX_THICKNESS:g}], got {format_value(text)}",
            "leave it empty for opaque samples",
        )
    return thickness
