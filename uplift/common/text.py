"""Text from elsewhere: made safe to show, shortened for messages, and parsed as numbers
or JSON.
"""

import decimal
import json
import math
import re
from collections.abc import Sequence
from typing import Any

MAX_LENGTH = 40
"""Characters of a received value in a message."""
MAX_LISTED = 6
"""Names in a message."""
_UNPRINTABLE = re.compile(
    "[\x00-\x1f\x7f-\x9f"  # controls, among them the newline
    # direction, line breaks, invisible
    "\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e007f]"  # no encoding; invisible
)
_FLOAT = re.compile(
    r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?|[+-]?(?:inf|infinity|nan)",
    re.IGNORECASE,
)
_WHOLE = re.compile(
    r"[+-]?[0-9]{1,18}"
)  # fits into 64 bits; Python takes long to convert thousands of digits


def printable(text: str) -> str:
    r"""Escape what a terminal would obey or cannot show: controls, marks of writing
    direction, lone surrogates.

    >>> printable("red\x1b[2J\nΔE00")
    'red\\x1b[2J\\nΔE00'
    """
    if text.isprintable():
        return text
    return _UNPRINTABLE.sub(
        lambda match: match[0].encode("unicode_escape").decode(), text
    )


def json_escapes(text: str) -> str:
    """Escape the same characters in JSON text, which keeps its meaning. Line breaks
    between values stay.
    """
    if text.isprintable():
        return text
    # Within strings the encoder has escaped line breaks and tabs.
    return _UNPRINTABLE.sub(
        lambda match: match[0] if match[0] in "\n\r\t" else json.dumps(match[0])[1:-1],
        text,
    )


def format_value(value: object) -> str:
    """Return the representation of a received value for a message, at most `MAX_LENGTH`
    characters of it.
    """
    try:
        return shorten(repr(value))
    except ValueError:  # Python does not print integers of more than 4300 digits
        return "an integer of thousands of digits"
    except RecursionError:
        return "a deeply nested value"


def shorten(text: str) -> str:
    """Return at most `MAX_LENGTH` characters of a text, and an ellipsis if
    it has more.
    """
    return text if len(text) <= MAX_LENGTH else f"{text[:MAX_LENGTH]}…"


def listed(names: Sequence[str]) -> str:
    """Join the first `MAX_LISTED` names, and count the others: 'a, b, c, d, e, f and 2
    more'.
    """
    more = f" and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else ""
    return ", ".join(names[:MAX_LISTED]) + more


def round_up(value: float) -> float:
    """Round a bound up to two digits.

    >>> round_up(1.2301), round_up(0.5)
    (1.3, 0.5)
    """
    return float(
        decimal.Context(
            prec=2, rounding=decimal.ROUND_CEILING
        ).create_decimal_from_float(value)
    )


def pluralise(count: int, noun: str) -> str:
    """Format a count with its noun.

    >>> pluralise(1, "entry"), pluralise(1500, "entry"), pluralise(2, "box")
    ('1 entry', '1,500 entries', '2 boxes')
    >>> pluralise(24, "array")
    '24 arrays'
    """
    if count == 1:
        return f"1 {noun}"
    stem = re.sub("(?<![aeo])y$", "ie", noun)
    return f"{count:,} {stem}{'es' if noun.endswith(('ch', 'x')) else 's'}"


def parse_float(text: str) -> float:
    """Parse a number, which may be infinite or NaN; `ValueError` otherwise.

    Python also accepts digits of other scripts and underscores, which are errors in
    data.
    """
    text = text.strip()
    if not _FLOAT.fullmatch(text):
        raise ValueError(f"not a number: {text[:40]!r}")
    return float(text)


def parse_whole(text: str) -> int:
    """Parse a whole number of at most 18 ASCII digits; `ValueError` otherwise."""
    text = text.strip()
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"not a whole number: {text[:40]!r}")
    return int(text)


MAX_DEPTH = 32
"""Deepest nesting of tables and lists."""
TOO_DEEP = f"tables and lists must not nest more than {MAX_DEPTH} levels deep"


def parse_json(text: str) -> Any:
    """Parse JSON; `ValueError` for text that is not JSON, not finite, not Unicode, or
    beyond the limits.
    """
    try:
        value = json.loads(text, parse_constant=_finite, parse_float=_finite)
    except RecursionError:
        raise ValueError(TOO_DEEP) from None
    check_values(value)
    return value


def check_values(value: object, depth: int = 0) -> None:
    """Raise `ValueError` if parsed values nest too deeply for recursive code or have
    lone surrogates.
    """
    if isinstance(value, str):
        value.encode()  # raises ValueError for lone surrogates
    elif isinstance(value, dict | list):
        if depth == MAX_DEPTH:
            raise ValueError(TOO_DEEP)
        for each in (*value, *value.values()) if isinstance(value, dict) else value:
            check_values(each, depth + 1)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"numbers must be finite, got {text[:40]}")
    return value
