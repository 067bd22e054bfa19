"""Files as text with source locations, and steps that all readers share."""

import hashlib
import os
from dataclasses import dataclass
from functools import cached_property

from uplift.common.arrays import StrPath
from uplift.common.errors import AtlasError
from uplift.common.files import read_bytes, recognise
from uplift.common.text import parse_float, printable, shorten

MAX_BYTES = 64 << 20
"""Largest file that is read, some 100,000 entries."""
UTF_16_START = 16
"""Bytes by which UTF-16 without a byte-order mark is recognised."""
READABLE = (
    "export a table (CSV, text or a spreadsheet), a CGATS, CxF3, TM-27 or JCAMP-DX "
    "file, or an ENVI library"
)
EXPORT = "export the file again, or export a CSV table"


@dataclass(frozen=True)
class SourceLocation:
    """Path, line (counted from 1) and entry that an error refers to, as far as they are
    known.
    """

    path: str | None = None
    line: int | None = None
    entry: str | None = None

    def at(self, line: int | None = None, entry: str | None = None) -> "SourceLocation":
        """Return the location of another line or entry of the same file."""
        return SourceLocation(self.path, line or self.line, entry or self.entry)

    def error(self, problem: str, hint: str, *, code: str | None = None) -> AtlasError:
        """Create an error at this location."""
        entry = None if self.entry is None else truncate(self.entry)
        return AtlasError(
            problem, code=code, path=self.path, line=self.line, entry=entry, hint=hint
        )


@dataclass(frozen=True)
class Document:
    """A file."""

    path: str
    location: SourceLocation
    """The file as a whole."""
    name: str
    """Its base name, with characters that are not text as escapes."""
    data: bytes
    digest: str
    """SHA-256 of its bytes, in hexadecimal digits."""

    @property
    def stem(self) -> str:
        """Name of the file without its suffix, valid as the name of an entry."""
        return os.path.splitext(self.name)[0].strip() or "spectrum"

    @cached_property
    def text(self) -> str:
        """The content as text with LF line ends: UTF-16, UTF-8, or else Latin-1.

        Raises `AtlasError` if it is empty, has a NUL character, or is damaged UTF-16.
        """
        data = self.data
        encoding = _utf_16(data)
        hint = "save the atlas as UTF-8 text"
        # Every sequence of bytes is valid Latin-1, so this is the last encoding that is
        # tried.
        try:
            text = data.decode(encoding or "utf-8-sig")
        except UnicodeDecodeError:
            if encoding is not None:
                raise self.location.at(1).error(
                    "the UTF-16 text is damaged", hint
                ) from None
            text = data.decode("latin-1")
        if kind := recognise(data):
            if kind != "text":
                problem = f"must be a file of spectra, got {kind}"
                raise self.location.error(problem, READABLE, code="not-spectra")
        elif "\0" in text:
            line = text[: text.index("\0")].count("\n") + 1
            raise self.location.at(line).error(
                "binary data (a NUL character) instead of text", READABLE
            )
        if not text.strip():
            raise self.location.error(
                "the file is empty", "name a file that contains atlas entries"
            )
        return text.replace("\r\n", "\n").replace("\r", "\n")

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text; line n of an editor is ``lines[n - 1]``."""
        return self.text.split("\n")


def _utf_16(data: bytes) -> str | None:
    """Return the encoding of UTF-16 text, with or without a byte-order mark; None for
    others.
    """
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    if len(data) < UTF_16_START or len(data) % 2:
        return None
    # One byte of every ASCII character in UTF-16 is 0: the first one if the order of
    # bytes is big-endian.
    even = data[:UTF_16_START:2]
    odd = data[1:UTF_16_START:2]
    if all(even) and not any(odd):
        return "utf-16-le"
    return "utf-16-be" if all(odd) and not any(even) else None


def read_document(path: StrPath) -> Document:
    """Read a file. Raise `AtlasError` if it is missing, unreadable or too large."""
    data = read_bytes(
        path,
        AtlasError,
        limit=MAX_BYTES,
        hint="name a file, or an atlas that shipped_atlases() lists",
    )
    path = os.fspath(path)
    digest = hashlib.sha256(data).hexdigest()
    return Document(
        path, SourceLocation(path), printable(os.path.basename(path)), data, digest
    )


def parse_number(token: str, location: SourceLocation, label: str) -> float:
    """Parse a number as data files write it; an error names it by ``label``. Raise
    `AtlasError`.
    """
    try:
        return parse_float(token)
    except ValueError:
        problem = (
            f"{label} '{truncate(token)}' is not a number"
            if token.strip()
            else f"{label} is empty"
        )
        raise location.error(problem, "write a plain number such as 0.125") from None


def check_scale(scale: float, label: str, location: SourceLocation) -> float:
    """Return the divisor of the values that a file states. Raise `AtlasError` unless it
    is positive and finite.
    """
    if not 0 < scale < float("inf"):
        problem = f"{label} must be positive and finite, got {scale:g}"
        raise location.error(problem, "write 100 for percent, 1 for values in [0, 1]")
    return scale


def one_line(text: object) -> str:
    """Return a text, empty for None, with every run of blanks and line breaks as one
    blank.
    """
    return "" if text is None else " ".join(str(text).replace("\0", " ").split())


def truncate(text: str) -> str:
    """Shorten text to one line for a message."""
    return shorten(one_line(text))


def without_unit(token: str) -> str:
    """Return ``380.0`` for ``380.0 nm``."""
    return token.strip().removesuffix("nm").rstrip()
