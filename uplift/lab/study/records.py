"""Records, dictionaries with equal keys, as CSV."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from uplift.common.arrays import StrPath
from uplift.common.csv import csv_text
from uplift.common.files import write_text

Records = Sequence[Mapping[str, Any]]


def records_csv(records: Records) -> str:
    """Format records as CSV with a header line."""
    header = list(records[0])
    return csv_text(header, ([record[key] for key in header] for record in records))


def write_csv(records: Records, path: StrPath, *, force: bool = False) -> None:
    """Write records to a CSV file. Raises `OutputError`."""
    write_text(records_csv(records), path, force=force)
