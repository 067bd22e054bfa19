"""Tables of recipes: which paints a measured sample has, in which parts, and on which
ground.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from uplift.atlas import SourceLocation, read_document
from uplift.common.arrays import StrPath
from uplift.common.text import format_value
from uplift.extras.files.csv import find_delimiter, parse_decimal, split_line
from uplift.extras.formats.tables.cells import parse_label
from uplift.extras.formats.tables.grid import NAME_LABELS, plain_label
from uplift.extras.paint.coats import MAX_THICKNESS

COLOUR_LABELS = ("colour", "color", "hex", "srgb")
OTHER_LABELS = frozenset(
    (
        "l", "l*", "a*", "b*", "c*", "h", "h*", "x", "y", "z", "r", "g", "rgb",
        "date", "time", "comment", "notes", "description", "instrument", "operator",
    )
)  # fmt: skip
"""Columns that are not paints, in lower case."""


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
    head = next((row for _, row in rows if len(row) > 1), [])
    columns = _columns(head, rows, location)
    if not columns.paints:
        raise location.error(
            "no column has the parts of a paint",
            "name columns after the paints, and write their parts in each row",
            code="no-paints",
        )
    start = next(at for at, (_, row) in enumerate(rows) if row is head) + 1
    recipes = tuple(_recipes(rows[start:], columns, location))
    has_spectra = any(parse_label(text) is not None for text in head)
    return RecipeTable(tuple(columns.paints), recipes, location, has_spectra)


@dataclass(frozen=True)
class _Columns:
    """Positions of columns."""

    count: int
    name: int
    thickness: int | None
    ground: int | None
    colour: int | None
    paints: dict[str, int]


def _columns(
    head: Sequence[str],
    rows: Sequence[tuple[int, Sequence[str]]],
    location: SourceLocation,
) -> _Columns:
    labels = [plain_label(text) for text in head]
    names = [labels.index(label) for label in NAME_LABELS if label in labels]
    name = names[0] if names else 0
    paints: dict[str, int] = {}
    for column, label in enumerate(labels):
        is_known = label in ("thickness", "ground", *NAME_LABELS, *COLOUR_LABELS)
        is_other = head[column].strip().casefold() in OTHER_LABELS or not label
        is_wavelength = parse_label(head[column]) is not None
        if column == name or is_known or is_other or is_wavelength:
            continue
        cells = [
            row[column] for _, row in rows if row is not head and column < len(row)
        ]
        if any(cells) and not any(map(_is_number, cells)):
            continue
        if head[column] in paints:
            raise location.error(
                f"two columns have the name {format_value(head[column])}",
                "rename one of the paints",
            )
        paints[head[column]] = column
    colours = [labels.index(label) for label in COLOUR_LABELS if label in labels]
    return _Columns(
        len(head),
        name,
        labels.index("thickness") if "thickness" in labels else None,
        labels.index("ground") if "ground" in labels else None,
        colours[0] if colours else None,
        paints,
    )


def _is_number(cell: str) -> bool:
    try:
        parse_decimal(cell)
    except ValueError:
        return False
    return True


def _recipes(
    rows: Sequence[tuple[int, Sequence[str]]],
    columns: _Columns,
    location: SourceLocation,
) -> Iterator[Recipe]:
    names = set[str]()
    for line, row in rows:
        cells = [*row, *[""] * (columns.count - len(row))]
        name = cells[columns.name]
        if name in names:
            raise location.at(line, name).error(
                f"two samples have the name {format_value(name)}", "rename one of them"
            )
        names.add(name)
        ground = _cell(cells, columns.ground)
        here = location.at(line, name)
        yield Recipe(
            name,
            tuple(
                _parts(paint, cells[column], here)
                for paint, column in columns.paints.items()
            ),
            _thickness(cells, columns, ground, here),
            ground or "white",
            _cell(cells, columns.colour),
            line,
        )


def _cell(cells: Sequence[str], column: int | None) -> str:
    return "" if column is None else cells[column]


def _parts(paint: str, text: str, location: SourceLocation) -> float:
    parts = parse_decimal(text or "0") if _is_number(text or "0") else np.nan
    if not 0 <= parts < np.inf:
        raise location.error(
            f"parts of {format_value(paint)} must be finite and at least 0, got "
            f"{format_value(text)}",
            "correct them, or delete the column if it is not a paint",
            code="invalid-parts",
        )
    return parts


def _thickness(
    cells: Sequence[str], columns: _Columns, ground: str, location: SourceLocation
) -> float:
    """Return the thickness of a film: that of the others of an unknown one is 1."""
    text = _cell(cells, columns.thickness)
    if not text:
        return 1.0 if ground else np.inf
    problem = f"thickness must be in (0, {MAX_THICKNESS:g}], got {format_value(text)}"
    error = location.error(problem, "leave it empty for opaque samples")
    try:
        thickness = parse_decimal(text)
    except ValueError:
        raise error from None
    if not 0 < thickness <= MAX_THICKNESS:
        raise error
    if not ground:
        raise location.error(
            f"a film of thickness {thickness:g} has no ground",
            "name its ground: white, black, or a sample without paint",
        )
    return thickness
