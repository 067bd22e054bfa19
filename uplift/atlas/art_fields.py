"""The lines of an ART measurement archive: entries as blocks, blocks as ``key : value`` fields."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from uplift.atlas.document import Document, SourceLocation, truncate

Line = tuple[int, str]
"""Number, counted from 1, and text."""

NOT_STATED = "not stated"
"""What a header line holds that has nothing to say: other readers want every line filled."""

TRUNCATED = "complete the entry (the file may be cut off here) or remove it"


@dataclass(frozen=True)
class Fields:
    """``key : value`` lines of one section; keys compare without case and spacing."""

    values: dict[str, Line]
    place: SourceLocation

    def text(self, key: str) -> str:
        """A value that may be missing."""
        return self.values.get(fold(key), (0, ""))[1]

    def required(self, key: str) -> tuple[str, SourceLocation]:
        """A value that must be there, and where. Raises `AtlasError`."""
        line, value = self.values.get(fold(key), (0, ""))
        if not value:
            raise self.place.error(f"the field '{key}' is missing", f"add a line '{key} : …' to the entry")
        return value, self.place.at(line)

    def check_known(self, known: Iterable[str]) -> None:
        """A misspelt field would be a missing one. Raises `AtlasError`."""
        known = tuple(known)
        for key, (line, _) in self.values.items():
            if key not in map(fold, known):
                hint = "the fields are " + ", ".join(f"'{name}'" for name in known)
                raise self.place.at(line).error(f"unknown field '{truncate(key)}'", hint)


@dataclass(frozen=True)
class Block:
    """One entry: its name, its two sections of fields, and the lines of its sample list."""

    place: SourceLocation
    name: str
    fields: Fields
    sampling: Fields
    samples: list[Line]


def split(document: Document) -> tuple[list[Line], Iterator[Block]]:
    """The lines before the first entry, and the entries, parsed when asked for. Raises `AtlasError`."""
    lines = list(enumerate(document.lines, start=1))
    starts = [i for i, (_, text) in enumerate(lines) if key_of(text) == "entry id"]
    ends = [*starts, len(lines)][1:]
    blocks = (_block(lines[i:j], document.path) for i, j in zip(starts, ends, strict=True))
    return spoken(lines[: starts[0]] if starts else lines), blocks


def key_of(text: str) -> str:
    """The folded key of a ``key : value`` line, empty for any other line."""
    key, colon, _ = text.partition(":")
    return fold(key) if colon else ""


def fold(text: str) -> str:
    """Text without case and with single blanks."""
    return " ".join(text.split()).casefold()


def spoken(lines: Iterable[Line]) -> list[Line]:
    """The lines that say something: not blank, no rule."""
    return [(number, text.strip()) for number, text in lines if not _is_rule(text)]


def parse_fields(lines: Iterable[Line], place: SourceLocation) -> Fields:
    """Lines of a section as fields. Raises `AtlasError` for a line without a colon and for a second value."""
    values: dict[str, Line] = {}
    for number, text in spoken(lines):
        key, colon, value = text.partition(":")
        if not colon:
            raise place.at(number).error(f"unexpected text '{truncate(text)}'", "write 'key : value'")
        if fold(key) in values:
            raise place.at(number).error(f"the field '{truncate(key)}' stands twice", "remove one of the two")
        values[fold(key)] = number, value.strip()
    return Fields(values, place)


def _is_rule(text: str) -> bool:
    text = text.strip()
    return not text.strip("-") or text.casefold().startswith("<hr")


def _block(lines: list[Line], path: str) -> Block:
    number, text = lines[0]
    name = text.partition(":")[2].strip()
    place = SourceLocation(path, number, name or None)
    sampling = _find(lines, "Sampling information", place)
    samples = _find(lines, "ASCII sample data", place)
    return Block(
        place,
        name,
        parse_fields(lines[1:sampling], place),
        parse_fields(lines[sampling + 1 : samples], place),
        lines[samples + 1 :],
    )


def _find(lines: list[Line], title: str, place: SourceLocation) -> int:
    for i, (_, text) in enumerate(lines):
        if len(text) < 200 and fold(text) == fold(title):
            return i
    last = (spoken(lines) or lines)[-1][0]
    raise place.at(last).error(f"the entry has no section '{title}'", TRUNCATED)
