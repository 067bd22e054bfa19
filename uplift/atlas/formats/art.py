"""Reader of the ART measurement archive (``.ark``), the atlas text format of Tódová 2020, figure 3.1.

An archive is a preamble and entries. An entry has two sections of ``key : value`` fields, and a list of samples:
``{a, b, …}`` or ``{{x, y}, …}``.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import Document, SourceLocation, check_scale, parse_number, truncate, without_unit
from uplift.common.arrays import Array

MAGIC = "ART measurement archive"
REFLECTANCE = "reflectance spectrum"
OTHER_TYPES = (
    "emission spectrum",
    "transmission spectrum",
    "colourimetric matching function",
    "colour matching function",
    "colorimetric matching function",
    "color matching function",
    "index of refraction",
)
FIELDS = (
    "Description",
    "Additional description",
    "Type",
    "Fluorescence data",
    "Measurement device",
    "Measured by",
    "Measurement date",
)
SCALE = "Maximum sample value"
SAMPLINGS = {"regular": ("Type", "Start", "Increment", SCALE), "point sampled": ("Type", SCALE)}
"""Fields of the sampling section, per type of sampling."""

Line = tuple[int, str]
"""Number, counted from 1, and text."""

NOT_STATED = "not stated"
"""Placeholder of a header line without a value: other readers require a value in every line."""

PAIR = re.compile(r"[\s,]*\{([^{}]*)\}")
"""A pair of samples; the comma before it is optional."""
COMPLETE_ENTRY = "complete the entry (the file may be truncated here) or remove it"
WRITE_VALUES = "write the samples as numbers separated by commas, in one pair of braces"
WRITE_PAIRS = "write the samples as {{wavelength, value}, {wavelength, value}, …}"


def is_art_archive(document: Document) -> bool:
    """Whether the text has the first line or an entry of this format."""
    first = next(line for line in document.lines if line.strip())
    return _fold(first).startswith(_fold(MAGIC)) or any(map(_begins_entry, document.lines))


def read(document: Document) -> Atlas:
    """Read the reflectances of an archive; entries of other types are skipped."""
    header = read_header(document)
    lines = list(enumerate(document.lines, start=1))
    starts = [index for index, (_, text) in enumerate(lines) if _begins_entry(text)]
    if not starts:
        hint = "add entries, each beginning with a line 'Entry ID: …'"
        raise SourceLocation(document.path, len(lines)).error("an archive needs at least one entry", hint)
    ends = [*starts[1:], len(lines)]
    entries = [_entry(lines[start:end], document.path) for start, end in zip(starts, ends, strict=True)]
    return Atlas(
        tuple(item for item in entries if isinstance(item, Entry)),
        tuple(item for item in entries if isinstance(item, SkippedEntry)),
        (Source(document.name, document.digest, header, "ART measurement archive"),),
    )


def read_header(document: Document) -> Header:
    """Read the statements of an archive about itself. Raise `AtlasError`."""
    location = SourceLocation(document.path)
    preamble = itertools.takewhile(lambda line: not _begins_entry(line[1]), enumerate(document.lines, start=1))
    lines = _content(preamble)
    if lines and _fold(lines[0][1]).startswith(_fold(MAGIC)):
        number, text = lines.pop(0)
        version = text.split()[-1]
        if not version.startswith("1."):
            problem = f"unknown archive version '{truncate(version)}'"
            raise location.at(number).error(problem, "write the archive as version 1.0, 1.1 or 1.2")
    fields = _fields(lines, location)
    fields.check_known(("Archive content", "Archive copyright", "Archive license"))
    values = [fields.text(f"Archive {key}") for key in ("content", "copyright", "license")]
    return Header(*("" if text == NOT_STATED else text for text in values))


def _entry(lines: list[Line], path: str) -> Entry | SkippedEntry:
    """Parse the lines of an entry: two sections of fields, and a list of samples."""
    number, text = lines[0]
    name = text.partition(":")[2].strip()
    location = SourceLocation(path, number, name or None)
    middle = _find(lines, "Sampling information", location)
    end = _find(lines, "ASCII sample data", location)
    fields = _fields(lines[1:middle], location)
    sampling = _fields(lines[middle + 1 : end], location)
    samples, start = _samples(lines[end + 1 :], location)
    reason = _why_skipped(fields, sampling)
    if reason:
        return SkippedEntry(name, reason, path, number)
    fields.check_known(FIELDS)
    wavelengths, values = _sampled(sampling, samples, start)
    return Entry(
        name,
        wavelengths,
        values,
        description=_unquote(fields.text("Description")),
        additional_description=_unquote(fields.text("Additional description")),
        device=fields.text("Measurement device"),
        measured_by=fields.text("Measured by"),
        date=fields.text("Measurement date"),
        path=path,
        line=number,
    )


def _why_skipped(fields: Fields, sampling: Fields) -> str:
    """Return why an entry of a known type cannot be used, empty if it can. Raise `AtlasError` for unknown types."""
    kind, location = fields.required("Type")
    if _fold(kind) in OTHER_TYPES:
        return f"its type is '{kind}', not '{REFLECTANCE}'"
    if _fold(kind) != REFLECTANCE:
        known = ", ".join(f"'{name}'" for name in (REFLECTANCE, *OTHER_TYPES[:4]))
        raise location.error(f"unknown type '{truncate(kind)}'", f"the types are {known}")
    if "fluorescence data" in fields.values:
        answer, location = fields.required("Fluorescence data")
        if _fold(answer) not in ("yes", "no"):
            problem = f"'Fluorescence data' must be 'yes' or 'no', got '{truncate(answer)}'"
            raise location.error(problem, "write 'yes' or 'no'")
        is_fluorescent = _fold(answer) == "yes"
    else:  # the sampling section is then specific to the kind
        is_fluorescent = bool(sampling.text("Reflectance start"))
    return "it is fluorescent (bispectral), not a plain reflectance" if is_fluorescent else ""


def _sampled(sampling: Fields, samples: str, start: SourceLocation) -> tuple[Array, Array]:
    """Return wavelengths (N,) in nm and reflectances (N,) in units of 1."""
    kind, location = sampling.required("Type")
    if _fold(kind) not in SAMPLINGS:
        raise location.error(f"unknown sampling type '{truncate(kind)}'", "write 'regular' or 'point sampled'")
    sampling.check_known(SAMPLINGS[_fold(kind)])
    scale = check_scale(sampling.number(SCALE), f"'{SCALE}'", sampling.required(SCALE)[1])
    with np.errstate(over="ignore", invalid="ignore"):  # Entry reports values that are not finite
        if _fold(kind) == "point sampled":
            wavelengths, values = np.array(_pairs(samples, start)).T
        else:
            first, increment = sampling.number("Start"), sampling.number("Increment")
            if "{" in samples or "}" in samples:
                raise start.error("braces within a regular sample list", WRITE_VALUES)
            values = np.array(_numbers(samples, start))
            wavelengths = first + increment * np.arange(len(values), dtype=np.float64)
        return wavelengths, values / scale


def _unquote(text: str) -> str:
    """Remove one pair of enclosing quotes; those of ``"a" and "b"`` do not enclose (`art_write` quotes to match)."""
    inside = text[1:-1]
    quoted = len(text) > 1 and text[0] == text[-1] == '"'
    encloses = '"' not in inside or (inside[0] == inside[-1] == '"')
    return inside if quoted and encloses else text


@dataclass(frozen=True)
class Fields:
    """``key : value`` lines of one section; keys compare without case and spacing."""

    values: dict[str, Line]
    location: SourceLocation

    def text(self, key: str) -> str:
        """Return an optional value, empty if it is missing."""
        return self.values.get(_fold(key), (0, ""))[1]

    def required(self, key: str) -> tuple[str, SourceLocation]:
        """Return a required value and its location. Raise `AtlasError` if it is missing."""
        line, value = self.values.get(_fold(key), (0, ""))
        if not value:
            raise self.location.error(f"the field '{key}' is missing", f"add a line '{key} : …' to the entry")
        return value, self.location.at(line)

    def number(self, key: str) -> float:
        """Return a required number, which may have the unit ``nm``. Raise `AtlasError`."""
        text, location = self.required(key)
        return parse_number(without_unit(text), location, f"'{key}'")

    def check_known(self, known: Iterable[str]) -> None:
        """Check for unknown fields, such as misspelt ones. Raise `AtlasError`."""
        known = tuple(known)
        for key, (line, _) in self.values.items():
            if key not in map(_fold, known):
                hint = "the fields are " + ", ".join(f"'{name}'" for name in known)
                raise self.location.at(line).error(f"unknown field '{truncate(key)}'", hint)


def _fields(lines: Iterable[Line], location: SourceLocation) -> Fields:
    """Parse the lines of a section. Raise `AtlasError` for a line without a colon and for a repeated key."""
    values: dict[str, Line] = {}
    for number, text in _content(lines):
        key, colon, value = text.partition(":")
        if not colon:
            raise location.at(number).error(f"unexpected text '{truncate(text)}'", "write 'key : value'")
        if _fold(key) in values:
            raise location.at(number).error(f"the field '{truncate(key)}' is repeated", "remove one of the two")
        values[_fold(key)] = number, value.strip()
    return Fields(values, location)


def _begins_entry(text: str) -> bool:
    key, colon, _ = text.partition(":")
    return bool(colon) and _fold(key) == "entry id"


def _fold(text: str) -> str:
    """Normalise case and blanks."""
    return " ".join(text.split()).casefold()


def _content(lines: Iterable[Line]) -> list[Line]:
    """Return the lines that are neither blank nor a rule."""
    stripped = ((number, text.strip()) for number, text in lines)
    return [line for line in stripped if line[1].strip("-") and not line[1].casefold().startswith("<hr")]


def _find(lines: list[Line], title: str, location: SourceLocation) -> int:
    for i, (_, text) in enumerate(lines):
        if len(text) < 200 and _fold(text) == _fold(title):
            return i
    last = (_content(lines) or lines)[-1][0]
    raise location.at(last).error(f"the section '{title}' is missing", COMPLETE_ENTRY)


def _samples(lines: list[Line], location: SourceLocation) -> tuple[str, SourceLocation]:
    """Return the text between the braces that open on the first line with content, and its location."""
    content = _content(lines)
    if not content or not content[0][1].startswith("{"):
        raise location.error("the sample list, opened by '{', is missing", COMPLETE_ENTRY)
    start = location.at(content[0][0])
    text = "\n".join(text for number, text in lines if number >= content[0][0]).strip()
    depth = 0
    for brace in re.finditer(r"[{}]", text):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            break
    else:
        raise start.error("the sample list is not closed by '}'", COMPLETE_ENTRY)
    end = brace.end()
    rest = text[end:].split("\n")
    after = _content(enumerate(rest, content[0][0] + text.count("\n", 0, end)))
    if after:
        raise start.at(after[0][0]).error("unexpected text after the sample list", "end the entry with '}'")
    return text[1 : end - 1], start


def _pairs(text: str, location: SourceLocation) -> list[list[float]]:
    """Parse ``{x, y}, {x, y}, …``. Raise `AtlasError`."""
    pairs, end = list[list[float]](), 0
    while match := PAIR.match(text, end):
        pairs.append(_numbers(match[1], location.after(text[end : match.start(1)])))
        if len(pairs[-1]) != 2:
            break
        location, end = location.after(match[0]), match.end()
    if text[end:].strip() or not pairs:
        raise location.error("the samples are not in pairs", WRITE_PAIRS)
    return pairs


def _numbers(text: str, location: SourceLocation) -> list[float]:
    numbers = []
    for token in text.split(","):
        lead = len(token) - len(token.lstrip())
        location = location.after(token[:lead])
        numbers.append(parse_number(token, location, "sample"))
        location = location.after(token[lead:])
    return numbers
