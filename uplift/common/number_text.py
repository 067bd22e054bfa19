"""Numbers as data files and command lines write them: ASCII digits with a decimal point."""

from __future__ import annotations

import re

__all__ = ["parse_float", "parse_whole"]

FLOAT = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?|[+-]?(?:inf|infinity|nan)", re.IGNORECASE)
WHOLE = re.compile(r"[+-]?[0-9]{1,18}")
"""Longer numbers do not fit into 64 bits, and Python takes long to convert thousands of digits."""


def parse_float(text: str) -> float:
    """Parse a number. Python also accepts digits of other scripts and underscores, which are errors in data.

    Parameters
    ----------
    text : str
        Text, with or without surrounding blanks.

    Returns
    -------
    float
        The number, which may be infinite or NaN.

    Raises
    ------
    ValueError
        The text is not a number.

    Examples
    --------
    >>> parse_float(" -1.5e3 ")
    -1500.0
    """
    text = text.strip()
    if not FLOAT.fullmatch(text):
        raise ValueError(f"not a number: {text[:40]!r}")
    return float(text)


def parse_whole(text: str) -> int:
    """Parse a whole number of at most 18 digits.

    Parameters
    ----------
    text : str
        Text, with or without surrounding blanks.

    Returns
    -------
    int
        The number.

    Raises
    ------
    ValueError
        The text is not a whole number, or has more digits.

    Examples
    --------
    >>> parse_whole("32")
    32
    """
    text = text.strip()
    if not WHOLE.fullmatch(text):
        raise ValueError(f"not a whole number: {text[:40]!r}")
    return int(text)
