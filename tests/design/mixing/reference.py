"""Published and measured mixtures of tests/reference, as pairs of linear RGB, shares and linear RGB."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from uplift.common.arrays import Array
from uplift.lookup import Cube

FOLDER = Path(__file__).parents[2] / "reference"

Mixtures = tuple[Array, Array, Array]
"""Pairs (n, 2, 3), shares (n, 2) and mixtures (n, 3)."""


def rows(name: str) -> list[list[str]]:
    """Return the fields of a table without comments and header."""
    lines = (FOLDER / name).read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines if not line.startswith("#")][1:]


def paint_mixtures(first: tuple[str, ...] = (), second: str = "") -> Mixtures:
    """Return the mixtures of acrylics of paint_mixtures.csv.

    Those of paints whose name starts with one of ``first`` and paints whose name ends with ``second``, by default all.
    """
    table = rows("paint_mixtures.csv")
    masstones = {row[0]: [float(x) for x in row[3:]] for row in table if row[0] == row[1]}

    def wanted(one: str, other: str) -> bool:
        return (not first or one.startswith(first)) and other.endswith(second)

    kept = [
        row for row in table if row[0] != row[1] and (wanted(row[0], row[1]) or wanted(row[1], row[0]))
    ]
    share = np.array([float(row[2]) for row in kept])
    return (
        np.array([[masstones[row[0]], masstones[row[1]]] for row in kept]),
        np.stack([1 - share, share], axis=1),
        np.array([[float(x) for x in row[3:]] for row in kept]),
    )


def published_mixtures(tool: str, cube: Cube) -> Mixtures:
    """Return the mixtures that a tool publishes (published_mixtures.csv)."""
    kept = [row for row in rows("published_mixtures.csv") if row[0] == tool]
    share = np.array([float(row[3]) for row in kept])
    codes = np.array([[_codes(row[column]) for column in (1, 2, 4)] for row in kept])
    linear = cube.decode(codes)
    return linear[:, :2], np.stack([1 - share, share], axis=1), linear[:, 2]


def _codes(text: str) -> list[int]:
    return [int(text[i : i + 2], 16) for i in (1, 3, 5)]
