"""Storage of measurements: docs/data/NAME.json, which `make docs` turns into docs/NAME.md."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from uplift.lab.timing import environment

ROOT = Path(__file__).parents[1]
DATA = ROOT / "docs" / "data"


def write(name: str, command: str, **figures: Any) -> None:
    """Write figures with the command that measures them; ``environment`` is that of this process by default."""
    content = {"command": command, "environment": environment(), **figures}
    text = json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False, default=to_json)
    (DATA / f"{name}.json").write_text(text + "\n", encoding="utf-8")


def to_json(value: Any) -> Any:
    """Convert a dataclass, or a number or array of numpy."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"cannot store {type(value).__name__}")
