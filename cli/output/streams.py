"""Standard streams that work anywhere: closed ones, and terminals that lack characters.

A stream that the caller closed is opened again, so that no other file takes its place: standard output and input such
that each use is an error, standard error on the null device. A character that the encoding of a stream lacks is
replaced by a stand-in, such as ``d`` for Δ, or by its escape.
"""

from __future__ import annotations

import codecs
import contextlib
import errno
import io
import os
import sys

MODES = {0: os.O_WRONLY, 1: os.O_RDONLY, 2: os.O_WRONLY}
"""Mode in which the null device takes the place of a closed descriptor."""
STAND_INS = {
    "Δ": "d", "λ": "lambda", "φ": "phi", "µ": "u", "μ": "u", "·": "*", "×": "x", "°": " deg", "≤": "<=", "≥": ">=",
    "±": "+-", "−": "-", "–": "-", "—": "-", "…": "...", "“": '"', "”": '"', "‘": "'", "’": "'", "→": "->",
    "³": "^3", "²": "^2", "⁻": "^-",
    **dict(zip("▁▂▃▄▅▆▇█", ".:-=+*#@", strict=True)),
}  # fmt: skip
"""ASCII text for characters that uplift prints."""
SHAPES = ((0x2500, 0x257F, "-"), (0x2580, 0x259F, "#"), (0x2800, 0x28FF, "*"))
"""First and last code point, and stand-in, of lines, blocks and the dots of spinners."""
ERRORS = "uplift-stand-ins"
"""Name of the handler of encoding errors."""
ASCII = "uplift-ascii"
"""ASCII under another name: click writes UTF-8 to streams whose encoding is named ASCII."""


def prepare_streams() -> None:
    """Open closed streams, and set stand-ins for characters that a stream cannot encode."""
    for descriptor in MODES:
        _reopen(descriptor)
    if sys.stdin is None:
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stdout is None:
        sys.stdout = open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    if sys.stderr is None:
        sys.stderr = open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    codecs.register(_find_ascii)
    codecs.register_error(ERRORS, stand_in)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            is_ascii = codecs.lookup(stream.encoding).name == "ascii"
            stream.reconfigure(encoding=ASCII if is_ascii else None, errors=ERRORS)


def stand_in(error: UnicodeError) -> tuple[str, int]:
    """Return the stand-in for characters that cannot be encoded, and the position after them."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_ascii, error.object[error.start : error.end])), error.end


def finish_stdout() -> None:
    """Write what standard output still holds. Raises OSError, and drops the text, if that fails."""
    try:
        sys.stdout.flush()
    except OSError:
        drop_stdout()
        raise


def drop_stdout() -> None:
    """Send what standard output still holds to the null device, as the interpreter writes it at its end."""
    with contextlib.suppress(OSError, ValueError, io.UnsupportedOperation):
        descriptor = sys.stdout.fileno()
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, descriptor)
        os.close(null)
        sys.stdout.flush()


def _reopen(descriptor: int) -> None:
    try:
        os.fstat(descriptor)
    except OSError as error:
        if error.errno == errno.EBADF:
            os.open(os.devnull, MODES[descriptor])  # takes the lowest free number, which is this one


def _find_ascii(name: str) -> codecs.CodecInfo | None:
    if name.replace("_", "-") != ASCII:
        return None
    ascii_codec = codecs.lookup("ascii")
    return codecs.CodecInfo(*ascii_codec, ascii_codec.incrementalencoder, ascii_codec.incrementaldecoder, name=ASCII)


def _ascii(character: str) -> str:
    if character in STAND_INS:
        return STAND_INS[character]
    code = ord(character)
    for first, last, shape in SHAPES:
        if first <= code <= last:
            return shape
    import unicodedata

    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return plain or character.encode("ascii", "backslashreplace").decode()
