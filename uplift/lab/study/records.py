"""Records, flat dictionaries with the same keys, as CSV."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping, Sequence
from typing import Any

from uplift.common.files import write_text

Records = Sequence[Mapping[str, Any]]


def csv_text(records: Records) -> str:
    """A header, then a line each."""
    out = io.StringIO()
    writer = csv.DictWriter(out, list(records[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(records)
    return out.getvalue()


def write_csv(records: Records, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write them as a file. Raises `OutputError`."""
    write_text(csv_text(records), path, force=force)
