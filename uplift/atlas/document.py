"""Files in and out: text read whole, faults with their place, no half-written file left behind."""

from __future__ import annotations

import dataclasses
import hashlib
import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from uplift.common.arrays import StrPath
from uplift.common.errors import AtlasError

SHOWN = 40
"""Characters of a faulty token or name that a message shows."""


@dataclass(frozen=True)
class SourceLocation:
    """Where something stands, as far as it is known (``line`` counts from 1)."""

    path: str | None = None
    line: int | None = None
    entry: str | None = None

    def at(self, line: int) -> SourceLocation:
        """Another line of the same entry."""
        return dataclasses.replace(self, line=line)

    def after(self, text: str) -> SourceLocation:
        """Where one stands having read ``text``."""
        return self.at((self.line or 1) + text.count("\n")) if "\n" in text else self

    def error(self, problem: str, hint: str) -> AtlasError:
        """The error to raise for a problem here."""
        entry = None if self.entry is None else truncate(self.entry)
        return AtlasError(problem, path=self.path, line=self.line, entry=entry, hint=hint)


@dataclass(frozen=True)
class Document:
    """A text file as it was read: lines end in LF here, ``digest`` is sha256 (hex) of the file's bytes."""

    path: str
    text: str
    digest: str

    @property
    def name(self) -> str:
        """The file's base name."""
        return os.path.basename(self.path)

    @cached_property
    def lines(self) -> list[str]:
        """Line n of an editor is ``lines[n - 1]``."""
        return self.text.split("\n")


def read_document(path: StrPath) -> Document:
    """Read a text file, UTF-8 or else Latin-1.

    Raises
    ------
    AtlasError : the file is missing, unreadable, empty or binary.
    """
    place = SourceLocation(os.fspath(path))
    data = _bytes(place)
    text = _text(data, place)
    if not text.strip():
        raise place.error("the file is empty", "name a file that holds atlas entries")
    return Document(os.fspath(path), text, hashlib.sha256(data).hexdigest())


def _bytes(place: SourceLocation) -> bytes:
    try:
        return Path(place.path or "").read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise place.error(
            f"cannot be read: {_reason(error)}", "name an atlas file that can be read"
        ) from None


def _text(data: bytes, place: SourceLocation) -> str:
    if b"\0" in data:
        line = data[: data.index(b"\0")].count(b"\n") + 1
        raise place.at(line).error("binary data (a NUL byte), no text", "save the atlas as UTF-8 text")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def number(token: str, place: SourceLocation, what: str) -> float:
    """A number as data files write it; ``what`` names it in the error. Raises `AtlasError`."""
    try:
        if "_" in token:  # Python reads 1_000, no measuring device writes it
            raise ValueError
        return float(token)
    except ValueError:
        problem = f"{what} '{truncate(token)}' is not a number"
        raise place.error(problem, "write a plain number such as 0.125") from None


def truncate(text: str) -> str:
    """Text as a message quotes it: one line, not too long."""
    text = " ".join(text.replace("\0", " ").split())
    return text if len(text) <= SHOWN else text[:SHOWN] + "…"


def nanometres(token: str, place: SourceLocation, what: str) -> float:
    """A number followed by ``nm`` or by nothing. Raises `AtlasError`."""
    return number(without_unit(token), place, what)


def without_unit(token: str) -> str:
    """``380.0`` of ``380.0 nm``."""
    return token.strip().removesuffix("nm").rstrip()


def _reason(error: Exception) -> str:
    return str(getattr(error, "strerror", None) or error).lower()
