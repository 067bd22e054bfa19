"""CSV text: the one writer of the project."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

__all__ = ["csv_text"]


def csv_text(header: Sequence[object], rows: Iterable[Sequence[object]], *, quote_text: bool = False) -> str:
    """Format a table as CSV with LF line ends.

    Parameters
    ----------
    header : sequence
        Cells of the first row.
    rows : iterable of sequence
        Cells of the other rows. Floats are written with all significant digits, None as an empty cell.
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
    writer = csv.writer(
        text, lineterminator="\n", quoting=csv.QUOTE_NONNUMERIC if quote_text else csv.QUOTE_MINIMAL
    )
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()
