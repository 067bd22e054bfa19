"""TOML text of tables, for files that people may read and edit. Tables hold values, and
tables only at the top.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

DIGITS = 9
"""Significant digits of numbers."""
Table = Mapping[str, Any]


def toml_text(values: Table) -> str:
    """Write values by their keys, then tables, then arrays of tables in their order.

    Keys get hyphens, and None is left out.

    >>> print(toml_text({"to_xyz": [0.5, 1.0], "light": {"name": "A", "file": None}}))
    to-xyz = [0.5, 1.0]
    <BLANKLINE>
    [light]
    name = "A"
    """
    return "\n".join(_lines(values))


def _lines(values: Table) -> Iterator[str]:
    tables = {}
    for name, value in values.items():
        key = name.replace("_", "-")
        if _is_table(value):
            tables[key] = value
        elif value is not None:
            yield f"{key} = {toml_value(value)}"
    for key, value in tables.items():
        is_single = isinstance(value, Mapping)
        for table in [value] if is_single else value:
            yield ""
            yield f"[{key}]" if is_single else f"[[{key}]]"
            yield from _lines(table)


def _is_table(value: object) -> bool:
    """Whether a value is a table, or a list of tables."""
    rows = value if isinstance(value, list) else [value]
    return isinstance(rows[0], Mapping) if rows else False


def toml_value(value: object) -> str:
    """Write a text, a number or an array; of a matrix one row a line.

    >>> print(toml_value('5" brush'), toml_value(np.array([[0.1, 2]])))
    "5\\U00000022 brush" [
      [0.1, 2.0],
    ]
    """
    if isinstance(value, str):
        return f'"{"".join(map(_escaped, value))}"'
    if isinstance(value, bool | int):
        return str(value).lower()
    if isinstance(value, float):
        return repr(float(f"{value:.{DIGITS}g}"))
    items = value if isinstance(value, list) else np.asarray(value).tolist()
    if items and isinstance(items[0], list):
        rows = [f"  {toml_value(row)}," for row in items]
        return "\n".join(["[", *rows, "]"])
    return f"[{', '.join(map(toml_value, items))}]"


def _escaped(letter: str) -> str:
    is_plain = letter.isprintable() and letter not in '"\\'
    return letter if is_plain else f"\\U{ord(letter):08x}"
