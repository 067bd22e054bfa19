"""Text that came from elsewhere, made safe to show: names in files, file names, arguments.

A name may hold characters that a terminal obeys (escape sequences, carriage returns), that reorder a line (marks of
writing direction) or that have no encoding (lone surrogates). `printable` writes them as escapes, as Python does in a
literal, so that a text is one line and looks like what it is.
"""

from __future__ import annotations

import re

__all__ = ["json_escapes", "printable"]

_UNPRINTABLE = (
    "[\x00-\x1f\x7f-\x9f"  # controls, among them the newline
    "\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"  # direction, line breaks, invisible
    "\ud800-\udfff\U000e0000-\U000e007f]"  # no encoding; invisible
)
_SHORT = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}


def printable(text: str) -> str:
    """Escape the characters that a terminal would obey or cannot show.

    Parameters
    ----------
    text : str
        Any text.

    Returns
    -------
    str
        One line without control characters, marks of writing direction, and lone surrogates.

    Examples
    --------
    >>> printable("red\\x1b[2J\\nΔE00")
    'red\\\\x1b[2J\\\\nΔE00'
    """
    return text if text.isprintable() else re.sub(_UNPRINTABLE, _python_escape, text)


def json_escapes(text: str) -> str:
    """Escape the same characters in JSON text, which keeps its meaning.

    Parameters
    ----------
    text : str
        JSON on one or more lines. Its strings hold such characters, and nothing else of it does but line breaks.

    Returns
    -------
    str
        JSON of the same values.

    Examples
    --------
    >>> json_escapes('"\\u202e"') == '"' + "\\\\u202e" + '"'
    True
    """
    return text if text.isprintable() else re.sub(_UNPRINTABLE, _json_escape, text)


def _python_escape(match: re.Match[str]) -> str:
    code = ord(match[0])
    if match[0] in _SHORT:
        return _SHORT[match[0]]
    return f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def _json_escape(match: re.Match[str]) -> str:
    code = ord(match[0])
    if match[0] in _SHORT:  # between values; within strings the encoder has escaped them
        return match[0]
    if code < 0x10000:
        return f"\\u{code:04x}"
    high, low = divmod(code - 0x10000, 0x400)
    return f"\\u{0xD800 + high:04x}\\u{0xDC00 + low:04x}"
