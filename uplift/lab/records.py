"""Records of measurements: JSON with the environment, and CSV."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath
from uplift.common.csv import csv_text
from uplift.common.files import write_text
from uplift.lab.timing import environment

Records = Sequence[Mapping[str, Any]]
"""Dictionaries with equal keys."""


def records_csv(records: Records) -> str:
    """Format records as CSV with a header line."""
    header = list(records[0])
    return csv_text(header, ([record[key] for key in header] for record in records))


def write_csv(records: Records, path: StrPath, *, force: bool = False) -> None:
    """Write records to a CSV file. Raises `OutputError`."""
    write_text(records_csv(records), path, force=force)


def write_record(path: Path, command: str, **figures: Any) -> None:
    """Write figures with the command that measures them; ``environment`` is that of this process by default."""
    content = {"command": command, "environment": environment(), **figures}
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False, default=to_json)
    path.write_text(text + "\n", encoding="utf-8")


def to_json(value: Any) -> Any:
    """Convert a dataclass, or a number or array of numpy."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"cannot store {type(value).__name__}")
