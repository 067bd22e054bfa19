"""CSV text: the writer of the project, the reader of tables that it wrote, and the
parts of readers of others.

A spreadsheet runs a cell that begins with ``=``, ``+``, ``-``, ``@`` or a tab as a
formula. Such text is written with an apostrophe before it, which spreadsheets hide;
`plain_cell` takes it away again. Numbers, also those formatted as text, stay as they
are.
"""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any

from uplift.common.files import decode_text
from uplift.common.text import parse_float

DELIMITERS = (";", "\t", ",", " ")
"""Delimiters of cells. The last one stands for any number of blanks."""
_FORMULA = re.compile(r"'*[=+\-@\t\r\n＝＋－＠]")
_DECIMAL_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)


def write_csv(
    file: Any, rows: Iterable[Iterable[object]], *, quote_text: bool = False
) -> None:
    """Write rows with LF line ends, each before the next is computed, to a text file or
    anything else with ``write``.

    Floats have all significant digits, None is an empty cell, and text is neutralised.
    With ``quote_text`` all text is quoted, which distinguishes a name such as ``1``
    from a number.
    """
    writer = csv.writer(
        file,
        lineterminator="\n",
        quoting=csv.QUOTE_NONNUMERIC if quote_text else csv.QUOTE_MINIMAL,
    )
    for row in rows:
        writer.writerow([_safe_cell(cell) for cell in row])


def csv_text(
    header: Sequence[object],
    rows: Iterable[Sequence[object]],
    *,
    quote_text: bool = False,
) -> str:
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

    `ValueError` for bytes that are not text or CSV, and for rows that have not a cell
    for each name.
    """
    reader = csv.DictReader(io.StringIO(decode_text(data), newline=""))
    try:
        rows = list(reader)
    except csv.Error as error:
        raise ValueError(str(error)) from error
    if any(None in row or None in row.values() for row in rows):
        raise ValueError("columns are missing, or lines differ in length")
    return rows


def parse_decimal(text: str) -> float:
    """Parse a number with a decimal point or a decimal comma, which may be infinite or
    NaN; `ValueError` otherwise.

    >>> parse_decimal("0.25"), parse_decimal("0,25"), parse_decimal("-1,5e-3")
    (0.25, 0.25, -0.0015)
    """
    return parse_float(text if "." in text else _DECIMAL_COMMA.sub(".", text))


def is_decimal(text: str) -> bool:
    """Whether `parse_decimal` accepts a text.

    >>> is_decimal("0,5"), is_decimal("0,5,1"), is_decimal("0.5,1"), is_decimal("red")
    (True, False, False, False)
    """
    try:
        parse_decimal(text)
    except ValueError:
        return False
    return True


def find_delimiter(lines: Iterable[str]) -> str:
    """Return the one of `DELIMITERS` that splits most numbers off lines, and few other
    cells.

    Of lines without numbers it is the first one that they have, of lines without any a
    semicolon.

    >>> lines = ("400,5;0,3", "0,2 0,3 0,4", "0.2, 0.3, 0.4", '"0,2","0,3"', "r,g")
    >>> [find_delimiter([line]) for line in lines]
    [';', ' ', ',', ',', ',']
    """
    lines = list(lines)
    text = "\n".join(lines)
    present = [mark for mark in DELIMITERS if mark in text] or DELIMITERS[:1]

    def score(delimiter: str) -> tuple[int, int]:
        cells = list(chain.from_iterable(split_line(line, delimiter) for line in lines))
        numbers = sum(map(is_decimal, cells))
        return numbers, -len(cells) if numbers else int(len(cells) > len(lines))

    return present[0] if len(present) == 1 else max(present, key=score)


def split_line(line: str, delimiter: str) -> list[str]:
    """Split a line into cells without the blanks around them, and without empty cells
    at the end.

    `ValueError` for a cell that is too long.

    >>> split_line('"deep, red"; 0,2 ;;', ";"), split_line("  0,2   0,3", " ")
    (['deep, red', '0,2'], ['0,2', '0,3'])
    """
    try:
        cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error as error:
        raise ValueError(str(error)) from error
    cells = [cell.strip() for cell in cells]
    if delimiter == " ":
        return [cell for cell in cells if cell]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def plain_cell(cell: str) -> str:
    """Return a cell without the apostrophe that `write_csv` puts before a formula."""
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell) else cell


def _safe_cell(cell: object) -> Any:
    if not isinstance(cell, str):
        return cell
    if not cell.isascii():  # names of files that are not UTF-8
        cell = cell.encode(errors="backslashreplace").decode()
    return f"'{cell}" if _FORMULA.match(cell) and not _NUMBER.fullmatch(cell) else cell
