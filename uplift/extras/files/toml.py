"""Values as TOML text, for files that people may read and edit."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

DIGITS = 9
"""Significant digits of numbers."""


def text_value(text: str) -> str:
    """Write a basic string.

    >>> print(text_value('5" brush'))
    "5\\U00000022 brush"
    """
    return f'"{"".join(map(_escaped, text))}"'


def _escaped(letter: str) -> str:
    is_plain = letter.isprintable() and letter not in '"\\'
    return letter if is_plain else f"\\U{ord(letter):08x}"


def number_value(value: float) -> str:
    """Write a number with `DIGITS` digits."""
    return repr(float(f"{value:.{DIGITS}g}"))


def row_value(values: Sequence[float] | ArrayLike) -> str:
    """Write numbers (n,) as an array."""
    numbers = np.asarray(values, dtype=float).tolist()
    return f"[{', '.join(map(number_value, numbers))}]"


def matrix_value(values: ArrayLike) -> str:
    """Write numbers (m, n) as an array of rows, one a line."""
    rows = [f"  {row_value(row)}," for row in np.asarray(values)]
    return "\n".join(["[", *rows, "]"])
