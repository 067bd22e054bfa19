"""Records, flat dictionaries with the same keys, as CSV."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from uplift.common.csv import csv_text
from uplift.common.files import write_text

Records = Sequence[Mapping[str, Any]]


def records_csv(records: Records) -> str:
    """Format records with the same keys as CSV, a row each."""
    header = list(records[0])
    return csv_text(header, ([record[key] for key in header] for record in records))


def write_csv(records: Records, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write them as a file. Raises `OutputError`."""
    write_text(records_csv(records), path, force=force)
