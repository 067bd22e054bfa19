"""Text of many numbers at once, the shortest decimals that give the same float."""

import numpy as np

from uplift.common.arrays import Array

FEW = 1024
"""Numbers up to which the import of pydantic would take longer."""
LEAST_PLAIN = 1e-4
"""Least positive number that Python writes without an exponent."""
LEAST_LARGE = 1e16
"""Least number that Python writes with a positive exponent."""


def number_rows(values: Array, separator: str = ",") -> list[str]:
    """Format rows (n, k) of floats, n and k > 0, as `repr` does.

    The JSON of pydantic is ten times as fast. It has the same digits, but exponents
    only for smaller and larger numbers than Python.

    >>> number_rows(np.array([[0.1, 2e-7], [1, np.inf]]))
    ['0.1,2e-07', '1.0,inf']
    """
    if values.size <= FEW:
        return [separator.join(map(repr, row)) for row in values.tolist()]
    from pydantic_core import to_json

    text = to_json(values.tolist()).decode()
    if separator != ",":
        text = text.replace(",", separator)
    rows = text[2:-2].split(f"]{separator}[")
    alike = (values.min(axis=1) >= LEAST_PLAIN) & (values.max(axis=1) < LEAST_LARGE)
    for row in np.flatnonzero(~alike):
        rows[row] = separator.join(map(repr, values[row].tolist()))
    return rows
