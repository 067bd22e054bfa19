"""CSV text: the writer of the project, and the reader of tables that it wrote.

A spreadsheet runs a cell that begins with ``=``, ``+``, ``-``, ``@`` or a tab as a formula. Such text is written with
an apostrophe before it, which spreadsheets hide; `plain_cell` takes it away again. Numbers, also those formatted as
text, stay as they are.
"""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from typing import Any

_FORMULA = re.compile(r"'*[=+\-@\t\r\n＝＋－＠]")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def write_csv(file: Any, rows: Iterable[Iterable[object]], *, quote_text: bool = False) -> None:
    """Write rows with LF line ends, each before the next is computed, to a text file or anything else with ``write``.

    Floats have all significant digits, None is an empty cell, and text is neutralised. With ``quote_text`` all text is
    quoted, which distinguishes a name such as ``1`` from a number.
    """
    writer = csv.writer(file, lineterminator="\n", quoting=csv.QUOTE_NONNUMERIC if quote_text else csv.QUOTE_MINIMAL)
    writer.writerows([_safe_cell(cell) for cell in row] for row in rows)


def csv_text(header: Sequence[object], rows: Iterable[Sequence[object]], *, quote_text: bool = False) -> str:
    """Format a table as CSV.

    >>> print(csv_text(["name", "value"], [["a, b", 0.1], ["=1+2", None]]), end="")
    name,value
    "a, b",0.1
    '=1+2,
    """
    text = io.StringIO()
    write_csv(text, (header, *rows), quote_text=quote_text)
    return text.getvalue()


def parse_csv(data: bytes) -> list[dict[str, str]]:
    """Parse a table with a line of column names, a dictionary for each row.

    `ValueError` for bytes that are not UTF-8 or CSV, and for rows that have not a cell for each name.
    """
    reader = csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline=""))
    try:
        rows = list(reader)
    except csv.Error as error:
        raise ValueError(str(error)) from error
    if any(None in row or None in row.values() for row in rows):
        raise ValueError("columns are missing, or lines differ in length")
    return rows


def plain_cell(cell: str) -> str:
    """Return a cell without the apostrophe that `write_csv` puts before a formula."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def _safe_cell(cell: object) -> Any:
    if not isinstance(cell, str):
        return cell
    if not cell.isascii():  # names of files that are not UTF-8
        cell = cell.encode(errors="backslashreplace").decode()
    return f"'{cell}" if _FORMULA.match(cell) and not _NUMBER.fullmatch(cell) else cell
