"""Structure of an ART measurement archive: entries as blocks, blocks as ``key : value`` fields."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from uplift.atlas.document import Document, SourceLocation, truncate

Line = tuple[int, str]
"""Number, counted from 1, and text."""

NOT_STATED = "not stated"
"""Placeholder of a header line without a value: other readers require a value in every line."""

COMPLETE_ENTRY = "complete the entry (the file may be truncated here) or remove it"


@dataclass(frozen=True)
class Fields:
    """``key : value`` lines of one section; keys compare without case and spacing."""

    values: dict[str, Line]
    location: SourceLocation

    def text(self, key: str) -> str:
        """Return an optional value, empty if it is missing."""
        return self.values.get(fold(key), (0, ""))[1]

    def required(self, key: str) -> tuple[str, SourceLocation]:
        """Return a required value and its location. Raise `AtlasError` if it is missing."""
        line, value = self.values.get(fold(key), (0, ""))
        if not value:
            raise self.location.error(
                f"the field '{key}' is missing", f"add a line '{key} : …' to the entry", code="field-missing"
            )
        return value, self.location.at(line)

    def check_known(self, known: Iterable[str]) -> None:
        """Check for unknown fields, such as misspelt ones. Raise `AtlasError`."""
        known = tuple(known)
        for key, (line, _) in self.values.items():
            if key not in map(fold, known):
                hint = "the fields are " + ", ".join(f"'{name}'" for name in known)
                raise self.location.at(line).error(f"unknown field '{truncate(key)}'", hint, code="unknown-field")


@dataclass(frozen=True)
class Block:
    """One entry: its name, its two sections of fields, and the lines of its sample list."""

    location: SourceLocation
    name: str
    fields: Fields
    sampling: Fields
    samples: list[Line]


def split_entries(document: Document) -> tuple[list[Line], Iterator[Block]]:
    """Return the lines before the first entry, and the entries, parsed lazily. Raise `AtlasError`."""
    lines = list(enumerate(document.lines, start=1))
    starts = [i for i, (_, text) in enumerate(lines) if key_of(text) == "entry id"]
    ends = [*starts, len(lines)][1:]
    blocks = (_block(lines[i:j], document.path) for i, j in zip(starts, ends, strict=True))
    return content_lines(lines[: starts[0]] if starts else lines), blocks


def key_of(text: str) -> str:
    """Return the folded key of a ``key : value`` line, empty for other lines."""
    key, colon, _ = text.partition(":")
    return fold(key) if colon else ""


def fold(text: str) -> str:
    """Normalise case and blanks."""
    return " ".join(text.split()).casefold()


def content_lines(lines: Iterable[Line]) -> list[Line]:
    """Return the lines that are neither blank nor a rule."""
    return [(number, text.strip()) for number, text in lines if not _is_rule(text)]


def parse_fields(lines: Iterable[Line], location: SourceLocation) -> Fields:
    """Parse the lines of a section. Raise `AtlasError` for a line without a colon and for a repeated key."""
    values: dict[str, Line] = {}
    for number, text in content_lines(lines):
        key, colon, value = text.partition(":")
        if not colon:
            raise location.at(number).error(
                f"unexpected text '{truncate(text)}'", "write 'key : value'", code="unexpected-text"
            )
        if fold(key) in values:
            raise location.at(number).error(
                f"the field '{truncate(key)}' is repeated", "remove one of the two", code="duplicate-field"
            )
        values[fold(key)] = number, value.strip()
    return Fields(values, location)


def _is_rule(text: str) -> bool:
    text = text.strip()
    return not text.strip("-") or text.casefold().startswith("<hr")


def _block(lines: list[Line], path: str) -> Block:
    number, text = lines[0]
    name = text.partition(":")[2].strip()
    location = SourceLocation(path, number, name or None)
    sampling = _find(lines, "Sampling information", location)
    samples = _find(lines, "ASCII sample data", location)
    return Block(
        location,
        name,
        parse_fields(lines[1:sampling], location),
        parse_fields(lines[sampling + 1 : samples], location),
        lines[samples + 1 :],
    )


def _find(lines: list[Line], title: str, location: SourceLocation) -> int:
    for i, (_, text) in enumerate(lines):
        if len(text) < 200 and fold(text) == fold(title):
            return i
    last = (content_lines(lines) or lines)[-1][0]
    raise location.at(last).error(f"the section '{title}' is missing", COMPLETE_ENTRY, code="section-missing")
