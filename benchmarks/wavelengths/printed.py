"""Printed tables of Meyer 1988, from tests/reference."""

from __future__ import annotations

import csv
from collections.abc import Mapping

import numpy as np

from benchmarks.record import ROOT
from uplift.common.arrays import Array

CHANNELS = ("A", "C1", "C2")
Nodes = tuple[Array, Array]
"""Wavelengths (n,) and weights (n,)."""


def rows(name: str) -> list[dict[str, str]]:
    """Return the rows of a table of the paper."""
    path = ROOT / "tests" / "reference" / f"meyer1988_{name}.csv"
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def tables_1() -> Mapping[tuple[str, int], Nodes]:
    """Return tables 1a and 1b by channel and order; undefined orders are absent."""
    lines = rows("table1")
    keys = dict.fromkeys((row["channel"], int(row["order"])) for row in lines)
    return {key: _nodes(lines, "order", key[0], str(key[1])) for key in keys}


def table_2(row: str) -> tuple[list[Nodes], float]:
    """Return a row of table 2: the rules of the channels, and the error."""
    lines = rows("table2")
    error = next(float(one["error"]) for one in lines if one["row"] == row)
    return [_nodes(lines, "row", channel, row) for channel in CHANNELS], error


def _nodes(lines: list[dict[str, str]], key: str, channel: str, value: str) -> Nodes:
    own = [row for row in lines if row["channel"] == channel and row[key] == value]
    return tuple(np.array([float(row[part]) for row in own]) for part in ("wavelength", "weight"))
