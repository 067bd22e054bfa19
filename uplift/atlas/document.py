"""Files with source locations, and parsing of numbers with errors that name the location."""

from __future__ import annotations

import dataclasses
import hashlib
import os
from dataclasses import dataclass
from functools import cached_property

from uplift.common.arrays import StrPath
from uplift.common.errors import AtlasError
from uplift.common.files import read_bytes
from uplift.common.text import parse_float, printable

MAX_QUOTED = 40
"""Characters of an invalid token or name that a message quotes."""


MAX_BYTES = 64 << 20
"""Largest file that is read, some 100,000 entries."""

UTF_16_START = 16
"""Bytes by which UTF-16 without a byte-order mark is recognised."""


@dataclass(frozen=True)
class SourceLocation:
    """Path, line (counted from 1) and entry that an error refers to, as far as they are known."""

    path: str | None = None
    line: int | None = None
    entry: str | None = None

    def at(self, line: int) -> SourceLocation:
        """Return the location of another line of the same entry."""
        return dataclasses.replace(self, line=line)

    def after(self, text: str) -> SourceLocation:
        """Return the location after ``text``, which starts here."""
        return self.at((self.line or 1) + text.count("\n")) if "\n" in text else self

    def error(self, problem: str, hint: str, *, code: str | None = None) -> AtlasError:
        """Create an error at this location."""
        entry = None if self.entry is None else truncate(self.entry)
        return AtlasError(problem, code=code, path=self.path, line=self.line, entry=entry, hint=hint)


@dataclass(frozen=True)
class Document:
    """A file; ``digest`` is the SHA-256 (hex) of its bytes."""

    path: str
    data: bytes
    digest: str

    @property
    def name(self) -> str:
        """Base name of the file, with characters that are not text as escapes."""
        return printable(os.path.basename(self.path))

    @property
    def stem(self) -> str:
        """Name of the file without its suffix, valid as the name of an entry."""
        return os.path.splitext(self.name)[0].strip() or "spectrum"

    @cached_property
    def text(self) -> str:
        """The content as text with LF line ends: UTF-16, UTF-8, or else Latin-1. Raises `AtlasError` for others."""
        location = SourceLocation(self.path)
        text = _decode(self.data, location)
        if not text.strip():
            raise location.error("the file is empty", "name a file that contains atlas entries")
        return text

    @cached_property
    def lines(self) -> list[str]:
        """Lines of the text; line n of an editor is ``lines[n - 1]``."""
        return self.text.split("\n")


def read_document(path: StrPath) -> Document:
    """Read a file. Raise `AtlasError` if it is missing, unreadable or too large."""
    data = read_bytes(path, AtlasError, limit=MAX_BYTES, hint="name an atlas file that can be read")
    return Document(os.fspath(path), data, hashlib.sha256(data).hexdigest())


def _decode(data: bytes, location: SourceLocation) -> str:
    encoding = _utf_16(data)
    if encoding is None and b"\0" in data:
        line = data[: data.index(b"\0")].count(b"\n") + 1
        raise location.at(line).error("binary data (a NUL byte) instead of text", "save the atlas as UTF-8 text")
    try:
        text = data.decode(encoding or "utf-8-sig")
    except UnicodeDecodeError:
        if encoding is not None:
            raise location.at(1).error("the UTF-16 text is damaged", "save the atlas as UTF-8 text") from None
        text = data.decode("latin-1")
    if encoding is not None and "\0" in text:
        raise location.at(1).error("binary data (a NUL character) instead of text", "save the atlas as UTF-8 text")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _utf_16(data: bytes) -> str | None:
    """Return the name of the UTF-16 encoding of data with a byte-order mark, or whose first letters are ASCII."""
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    even, odd = data[:UTF_16_START:2], data[1:UTF_16_START:2]
    if len(data) < UTF_16_START or len(data) % 2 or any(even) == any(odd) or not (all(even) or all(odd)):
        return None
    return "utf-16-le" if any(even) else "utf-16-be"


def parse_number(token: str, location: SourceLocation, label: str) -> float:
    """Parse a number as data files write it; an error names it by ``label``. Raise `AtlasError`."""
    try:
        return parse_float(token)
    except ValueError:
        problem = f"{label} '{truncate(token)}' is not a number"
        raise location.error(problem, "write a plain number such as 0.125") from None


def check_scale(scale: float, label: str, location: SourceLocation) -> float:
    """Return the divisor of the values that a file states. Raise `AtlasError` unless it is positive and finite."""
    if not 0 < scale < float("inf"):
        problem = f"{label} must be positive and finite, got {scale:g}"
        raise location.error(problem, "write 100 for percent, 1 for values in [0, 1]")
    return scale


def truncate(text: str) -> str:
    """Shorten text to one line of at most `MAX_QUOTED` characters."""
    text = " ".join(text.replace("\0", " ").split())
    return text if len(text) <= MAX_QUOTED else text[:MAX_QUOTED] + "…"


def without_unit(token: str) -> str:
    """Return ``380.0`` for ``380.0 nm``."""
    return token.strip().removesuffix("nm").rstrip()
