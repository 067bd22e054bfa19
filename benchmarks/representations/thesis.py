"""Printed tables of Kment 2011."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass

from benchmarks.record import ROOT

REFERENCE = ROOT / "tests" / "reference"


@dataclass(frozen=True)
class Printed:
    """Printed errors of a representation, or of a filter with its ``parameters``."""

    mean: float
    deviation: float
    q97_5: float | None = None
    parameters: str = ""


def tables() -> dict[tuple[str, str], Printed]:
    """Return tables 6.1 and 6.2, by lights and representation."""
    return {
        (row["lights"], row["representation"]): Printed(
            float(row["mean"]), float(row["deviation"]), float(row["q97_5"])
        )
        for row in _rows("representations_kment2011.csv")
    }


def filters() -> dict[tuple[str, int, str], Printed]:
    """Return tables A.1 and A.2, by lights, samples and kind of filter."""
    return {
        (row["lights"], int(row["samples"]), row["filter"]): Printed(
            float(row["mean"]), float(row["deviation"]), None, row["parameters"].replace(";", ",")
        )
        for row in _rows("filters_kment2011.csv")
    }


def _rows(name: str) -> Iterator[dict[str, str]]:
    with (REFERENCE / name).open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(line for line in file if not line.startswith("#"))
