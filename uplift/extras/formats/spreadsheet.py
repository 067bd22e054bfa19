"""Reader of spreadsheets (``.xlsx``, ``.xls``, ``.ods``), by the package
python-calamine.
"""

import functools
import io
import re
import zipfile
from dataclasses import replace
from typing import Any

from uplift.atlas.document import Document, one_line
from uplift.common.errors import AtlasError
from uplift.extras.files.csv import plain_cell
from uplift.extras.formats.measurements import Measurements, parsed_by
from uplift.extras.formats.tables.cells import Line, Row, trimmed
from uplift.extras.formats.tables.grid import Grid
from uplift.extras.formats.tables.read import NO_TABLE, read_grid

OLE = b"\xd0\xcf\x11\xe0"
"""First bytes of ``.xls``; the other ones are ZIP archives."""
MAX_CONTENT = 256 << 20
"""Bytes of all files of an archive after decompression."""
MAX_CELLS = 20_000_000
TAG = re.compile(rb"<(?:\w+:)?(row|c)\b([^>]*)")
"""A row or a cell of ``.xlsx``."""
PLACE = re.compile(rb"""\br\s*=\s*["']([A-Za-z]{0,8})(\d{1,12})["']""")
"""Where it lies, such as ``C7``."""
HINT = "save the sheet as a CSV table"


def read(document: Document) -> Measurements:
    """Read the first sheet that has a table of spectra."""
    _check_content(document)
    with parsed_by("python-calamine", "spreadsheets", document):
        import python_calamine as calamine

        book = calamine.CalamineWorkbook.from_filelike(io.BytesIO(document.data))
        names = list(book.sheet_names)
    problem = document.location.error(NO_TABLE, HINT, code="not-an-atlas")
    for name in names:
        try:
            rows = _rows(book, name, document)
            grid = Grid(rows, document.location, [name], may_group=True)
            table = read_grid(grid, document.stem)
            return replace(table, notes=(f"sheet: {name}", *table.notes))
        except AtlasError as error:
            if error.code != problem.code:
                raise
            problem = error
    raise problem


def _rows(book: Any, name: str, document: Document) -> list[Row]:
    with parsed_by("python-calamine", "spreadsheets", document):
        sheet = book.get_sheet_by_name(name)
        _check_cells(sheet.height, sheet.width, document)
        start = sheet.start[0] if sheet.start else 0
        lines = sheet.to_python(skip_empty_area=True)
    rows = list[Row]()
    for line, values in enumerate(lines, start + 1):
        texts = trimmed(list(map(_text, values)))
        if texts and not texts[0].startswith("#"):
            rows.append(Line(texts, line))
    return rows


def _text(value: Any) -> str:
    """Return the text of a cell; numbers with all their digits."""
    if isinstance(value, float):
        is_whole = value.is_integer() and abs(value) < 1e15
        return repr(int(value) if is_whole else value)
    return plain_cell(one_line(value))


def _check_content(document: Document) -> None:
    """Raise `AtlasError` for an archive that is damaged, or too large when it is
    decompressed.
    """
    if document.data.startswith(OLE):
        return
    left = MAX_CONTENT
    with (
        parsed_by("zipfile", "spreadsheets", document),
        zipfile.ZipFile(io.BytesIO(document.data)) as archive,
    ):
        for member in archive.infolist():
            with archive.open(member) as file:
                # the size that an archive states may be wrong
                content = file.read(left + 1)
            left -= len(content)
            if left < 0:
                raise document.location.error(
                    f"its content must not exceed {MAX_CONTENT:,} bytes", HINT
                )
            _check_cells(*_extent(content), document)


def _check_cells(height: int, width: int, document: Document) -> None:
    if height * width > MAX_CELLS:
        problem = (
            f"a sheet must have at most {MAX_CELLS:,} cells, got {height} × {width}"
        )
        raise document.location.error(problem, HINT)


def _extent(content: bytes) -> tuple[int, int]:
    """Return rows and columns with values of a sheet of ``.xlsx``. Opened by calamine,
    all its cells are allocated.
    """
    row = column = height = width = 0
    for kind, text in TAG.findall(content):
        place = PLACE.search(text)
        if kind == b"row":
            row = int(place[2]) if place else row + 1
            column = 0
            continue
        if place:
            row = int(place[2])
            column = functools.reduce(
                lambda sum, letter: 26 * sum + letter - 64, place[1].upper(), 0
            )
        else:
            column += 1
        if not text.endswith(b"/"):  # a format without a value
            height = max(height, row)
            width = max(width, column)
    return height, width
