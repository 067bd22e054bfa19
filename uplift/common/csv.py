"""CSV text: the one writer of the project.

A spreadsheet runs a cell that begins with ``=``, ``+``, ``-``, ``@`` or a tab as a formula. Such text is written with
an apostrophe before it, which spreadsheets hide; `plain_cell` takes it away again. Numbers, also those formatted as
text, stay as they are.
"""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence
from typing import Any, Protocol

__all__ = ["CsvWriter", "csv_text", "plain_cell"]

_FORMULA = re.compile(r"'*[=+\-@\t\r\n＝＋－＠]")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_NEUTRALISED = re.compile(r"'+[=+\-@\t\r\n＝＋－＠]")


class _Writable(Protocol):
    def write(self, text: str, /) -> object: ...


class CsvWriter:
    """Writer of rows with LF line ends, to an open text file.

    Parameters
    ----------
    file : text file
        The file, opened with ``newline=""``.
    quote_text : bool
        Quote all text, which distinguishes a name such as ``1`` from a number.

    Examples
    --------
    >>> text = io.StringIO()
    >>> CsvWriter(text).write(["=1+2", -1.5, None])
    >>> text.getvalue()
    "'=1+2,-1.5,\\n"
    """

    def __init__(self, file: _Writable, *, quote_text: bool = False) -> None:
        self._writer = csv.writer(
            file, lineterminator="\n", quoting=csv.QUOTE_NONNUMERIC if quote_text else csv.QUOTE_MINIMAL
        )

    def write(self, row: Iterable[object]) -> None:
        """Write a row.

        Parameters
        ----------
        row : iterable
            Cells. Floats are written with all significant digits, None as an empty cell. Text is neutralised.
        """
        self._writer.writerow([_safe_cell(cell) for cell in row])


def csv_text(header: Sequence[object], rows: Iterable[Sequence[object]], *, quote_text: bool = False) -> str:
    """Format a table as CSV with LF line ends.

    Parameters
    ----------
    header : sequence
        Cells of the first row.
    rows : iterable of sequence
        Cells of the other rows, as for `CsvWriter.write`.
    quote_text : bool
        Quote all text, which distinguishes a name such as ``1`` from a number.

    Returns
    -------
    str

    Examples
    --------
    >>> print(csv_text(["name", "value"], [["a, b", 0.1], ["c", None]]), end="")
    name,value
    "a, b",0.1
    c,
    """
    text = io.StringIO()
    writer = CsvWriter(text, quote_text=quote_text)
    writer.write(header)
    for row in rows:
        writer.write(row)
    return text.getvalue()


def plain_cell(cell: str) -> str:
    """Return a cell without the apostrophe that `CsvWriter` puts before a formula.

    Parameters
    ----------
    cell : str
        A cell as read.

    Returns
    -------
    str
        The text that was written.

    Examples
    --------
    >>> plain_cell("'=1+2"), plain_cell("it's")
    ('=1+2', "it's")
    """
    return cell[1:] if _NEUTRALISED.match(cell) else cell


def _safe_cell(cell: object) -> Any:
    if not isinstance(cell, str):
        return cell
    if not cell.isascii():  # names of files that are not UTF-8
        cell = cell.encode(errors="backslashreplace").decode()
    return f"'{cell}" if _FORMULA.match(cell) and not _NUMBER.fullmatch(cell) else cell
