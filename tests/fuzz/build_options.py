"""Fuzz target: build options of any type and range, each as one line of JSON."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np

from tests.fuzz.mutate import Random
from tests.fuzz.target import Target
from uplift.pipeline.options import Options, check_memory

FIELDS = [field.name for field in dataclasses.fields(Options)]
LITERALS = (
    "nan", "inf", "-inf", "1e999", "1e308", "5e-324", "1e-12", "-1", "0", "1", "2", "9", "17", "64", "0.1", "0.5",
    "true", "null", "[]", "{}", '"auto"', '"D65"', '["D65"]', '["D65", "A"]', '["D65", 3]', '"srgb"', '"linear"',
    '"moments"', '"sigmoid"', '"none"', '"vision"', '"\\u0000"', '"\\ud800"', "9" * 400, "9" * 5000,
)  # fmt: skip
TYPES = (np.float32, np.float64, np.int64, np.bool_, complex)
"""Types that callers of the library may pass."""


def _generate(random: Random, path: Path) -> None:
    names = random.choice(FIELDS, size=int(random.integers(1, 3)), replace=False)
    values = [LITERALS[random.integers(len(LITERALS))] for _ in names]
    types = [int(random.integers(3 * len(TYPES))) for _ in names]
    lines = [f"{name}\t{kind}\t{value}" for name, value, kind in zip(names, values, types, strict=True)]
    path.write_text("\n".join(lines), encoding="utf-8")


def _parse(value: str, kind: int) -> Any:
    try:
        parsed = json.loads(value)
    except ValueError:  # numbers that JSON or Python does not have
        parsed = float(value) if len(value) < 4300 else 10**5000
    if kind < len(TYPES) and isinstance(parsed, int | float):
        try:
            with np.errstate(all="ignore"):
                return TYPES[kind](parsed)
        except (OverflowError, ValueError):
            return parsed
    return tuple(parsed) if isinstance(parsed, list) else parsed


def _use(path: Path) -> None:
    """Create the options; those that are accepted must be JSON values and be the same when read back."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").split("\n")]
    options = Options(**{name: _parse(value, int(kind)) for name, kind, value in rows})
    check_memory(options)
    recorded = json.loads(json.dumps(dataclasses.asdict(options), allow_nan=False))
    if Options(**{**recorded, "lights": tuple(recorded["lights"])}) != options:
        raise ValueError("other options when read back")


TARGET = Target("build options", _generate, _use)
