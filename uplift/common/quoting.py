"""Received values in messages: one line, shortened, without control characters."""

from __future__ import annotations

__all__ = ["format_value", "shorten"]

MAX_LENGTH = 40
"""Characters of a received value in a message."""


def format_value(value: object) -> str:
    """Format a received value for a message.

    Parameters
    ----------
    value : object
        Any value.

    Returns
    -------
    str
        Its representation, at most `MAX_LENGTH` characters of it.

    Examples
    --------
    >>> print(format_value("a" * 100))
    'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa…
    """
    try:
        return shorten(repr(value))
    except ValueError:  # Python does not print integers of more than 4300 digits
        return "an integer of thousands of digits"
    except RecursionError:
        return "a deeply nested value"


def shorten(text: str) -> str:
    """Return at most `MAX_LENGTH` characters of a text, and an ellipsis if it has more."""
    return text if len(text) <= MAX_LENGTH else f"{text[:MAX_LENGTH]}…"
