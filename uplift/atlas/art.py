"""The ART measurement archive (``.ark``), the atlas text format of Tódová 2020, figure
3.1: reader and writer.

An archive is a preamble and entries. An entry has two sections of ``key : value``
fields, and a list of samples: ``{a, b, …}`` or ``{{x, y}, …}``. Keys compare without
case and spacing.
"""

import itertools
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import NamedTuple

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import (
    Document,
    SourceLocation,
    check_scale,
    one_line,
    parse_number,
    truncate,
    without_unit,
)
from uplift.common.arrays import Array
from uplift.common.text import parse_float

MAGIC = "ART measurement archive"
ENTRY = "entry id"
TITLES = ("Sampling information", "ASCII sample data")
"""Key of the first line of an entry, and the lines before its second and third section.
"""
REFLECTANCE = "reflectance spectrum"
OTHER_TYPES = (
    "emission spectrum", "transmission spectrum", "colourimetric matching function",
    "colour matching function",
    "colorimetric matching function", "color matching function", "index of refraction",
)  # fmt: skip
HEADER = {
    "content": "Archive content",
    "copyright": "Archive copyright",
    "licence": "Archive license",
}
STATEMENTS = {
    "description": "Description",
    "additional_description": "Additional description",
    "device": "Measurement device",
    "measured_by": "Measured by",
    "date": "Measurement date",
}
"""Fields by the attributes of `Header` and `Entry`."""
SCALE = "Maximum sample value"
SAMPLINGS = {
    "regular": ("Type", "Start", "Increment", SCALE),
    "point sampled": ("Type", SCALE),
}
"""Fields of the sampling section, per type of sampling."""
NOT_STATED = "not stated"
"""Placeholder of a header line without a value: other readers require a value in every
line.
"""
QUOTED = re.compile(r'"([^"]*|"(?:.*")?)"')
"""A text in one pair of quotes, which do not belong to it; those of ``"a" and "b"`` do
not enclose.
"""
LIST = re.compile(r"\{((?:[^{}]++|\{[^{}]*+\})*+)\}")
"""Samples between braces, which may enclose pairs of them."""
PAIR = re.compile(r"[\s,]*\{([^{}]*)\}")
"""A pair of samples; the comma before it is optional."""
COMPLETE_ENTRY = "complete the entry (the file may be truncated here) or remove it"
WRITE_VALUES = "write the samples as numbers separated by commas, in one pair of braces"
WRITE_PAIRS = "write the samples as {{wavelength, value}, {wavelength, value}, …}"


class Line(NamedTuple):
    """A line that is neither blank nor a rule."""

    number: int
    """Number in the file, counted from 1."""
    text: str
    key: str
    """Text before the first colon, in lower case with single blanks."""


@dataclass(frozen=True)
class Fields:
    """Fields of one section, by their keys in lower case."""

    lines: dict[str, Line]
    location: SourceLocation

    def text(self, key: str) -> str:
        """Return an optional value, empty if it is missing."""
        line = self.lines.get(key.lower())
        return "" if line is None else line.text.partition(":")[2].strip()

    def required(self, key: str) -> tuple[str, SourceLocation]:
        """Return a required value and its location. Raise `AtlasError` if it is
        missing.
        """
        value = self.text(key)
        if not value:
            raise self.location.error(
                f"the field '{key}' is missing", f"add a line '{key} : …' to the entry"
            )
        return value, self.location.at(self.lines[key.lower()].number)

    def check_known(self, known: Iterable[str]) -> None:
        """Check for unknown fields, such as misspelt ones. Raise `AtlasError`."""
        names = {name.lower(): name for name in known}
        for key, line in self.lines.items():
            if key not in names:
                hint = "the fields are " + ", ".join(
                    f"'{name}'" for name in names.values()
                )
                raise self.location.at(line.number).error(
                    f"unknown field '{truncate(key)}'", hint
                )


def read(document: Document) -> Atlas:
    """Read the reflectances of an archive; entries of other types are skipped."""
    header = read_header(document)
    lines = _content(document.lines)
    starts = [index for index, line in enumerate(lines) if line.key == ENTRY]
    if not starts:
        hint = "add entries, each beginning with a line 'Entry ID: …'"
        raise document.location.at(len(document.lines)).error(
            "an archive needs at least one entry", hint
        )
    # An entry ends where the next one begins.
    entries = [
        _read_entry(document, lines[start:end])
        for start, end in zip(starts, [*starts[1:], len(lines)], strict=True)
    ]
    return Atlas(
        tuple(item for item in entries if isinstance(item, Entry)),
        tuple(item for item in entries if isinstance(item, SkippedEntry)),
        (Source(document.name, document.digest, header, MAGIC),),
    )


def read_header(document: Document) -> Header:
    """Read the statements of an archive about itself. Raise `AtlasError`."""
    lines = list(
        itertools.takewhile(lambda line: line.key != ENTRY, _content(document.lines))
    )
    if lines and lines[0].key.startswith(MAGIC.lower()):
        number, text, _ = lines.pop(0)
        version = text.split()[-1]
        if not version.startswith("1."):
            problem = f"unknown archive version '{truncate(version)}'"
            raise document.location.at(number).error(
                problem, "write the archive as version 1.0, 1.1 or 1.2"
            )
    fields = _fields(lines, document.location)
    fields.check_known(HEADER.values())
    values = {name: fields.text(key) for name, key in HEADER.items()}
    return Header(
        **{name: "" if value == NOT_STATED else value for name, value in values.items()}
    )


def _content(lines: Iterable[str], first: int = 1) -> list[Line]:
    """Return the lines, numbered from ``first``, that are neither blank nor a rule."""
    return [
        Line(number, text, one_line(text.partition(":")[0]).casefold())
        for number, text in enumerate(map(str.strip, lines), first)
        if text.strip("-") and not text.casefold().startswith("<hr")
    ]


def _fields(lines: Iterable[Line], location: SourceLocation) -> Fields:
    """Collect the lines of a section. Raise `AtlasError` for a line without a colon and
    for a repeated key.
    """
    fields: dict[str, Line] = {}
    for line in lines:
        if ":" not in line.text:
            problem = f"unexpected text '{truncate(line.text)}'"
            raise location.at(line.number).error(problem, "write 'key : value'")
        if line.key in fields:
            problem = f"the field '{truncate(line.key)}' is repeated"
            raise location.at(line.number).error(problem, "remove one of the two")
        fields[line.key] = line
    return Fields(fields, location)


def _read_entry(document: Document, lines: list[Line]) -> Entry | SkippedEntry:
    """Parse the lines of an entry: two sections of fields, and a list of samples."""
    name = lines[0].text.partition(":")[2].strip()
    location = SourceLocation(document.path, lines[0].number, name or None)
    keys = [line.key for line in lines]
    for title in TITLES:
        if title.lower() not in keys:
            raise location.at(lines[-1].number).error(
                f"the section '{title}' is missing", COMPLETE_ENTRY
            )
    # Fields of the entry, fields of its sampling, samples
    middle, end = (keys.index(title.lower()) for title in TITLES)
    fields = _fields(lines[1:middle], location)
    sampling = _fields(lines[middle + 1 : end], location)
    samples, start = _sample_list(document, lines[end + 1 :], location)
    reason = _why_skipped(fields, sampling)
    if reason:
        return SkippedEntry(name, reason, document.path, location.line)
    fields.check_known(("Type", "Fluorescence data", *STATEMENTS.values()))
    statements = {attribute: fields.text(key) for attribute, key in STATEMENTS.items()}
    for attribute in ("description", "additional_description"):
        if quoted := QUOTED.fullmatch(statements[attribute]):
            statements[attribute] = quoted[1]
    wavelengths, values = _sampled(sampling, samples, start)
    return Entry(
        name, wavelengths, values, path=document.path, line=location.line, **statements
    )


def _why_skipped(fields: Fields, sampling: Fields) -> str:
    """Return why an entry of a known type cannot be used, empty if it can. Raise
    `AtlasError` for unknown types.
    """
    kind, location = fields.required("Type")
    if one_line(kind).casefold() in OTHER_TYPES:
        return f"its type is '{kind}', not '{REFLECTANCE}'"
    if one_line(kind).casefold() != REFLECTANCE:
        known = ", ".join(f"'{name}'" for name in (REFLECTANCE, *OTHER_TYPES[:4]))
        raise location.error(
            f"unknown type '{truncate(kind)}'", f"the types are {known}"
        )
    answer = (
        "yes" if sampling.text("Reflectance start") else "no"
    )  # the section is specific to the kind
    if "fluorescence data" in fields.lines:
        answer, location = fields.required("Fluorescence data")
    if answer.casefold() not in ("yes", "no"):
        problem = f"'Fluorescence data' must be 'yes' or 'no', got '{truncate(answer)}'"
        raise location.error(problem, "write 'yes' or 'no'")
    return (
        "it is fluorescent (bispectral), not a plain reflectance"
        if answer.casefold() == "yes"
        else ""
    )


def _sample_list(
    document: Document, lines: list[Line], location: SourceLocation
) -> tuple[str, SourceLocation]:
    """Return the text between the braces that open on the first line with content, and
    the location of that line.
    """
    if not lines or not lines[0].text.startswith("{"):
        raise location.error(
            "the sample list, opened by '{', is missing", COMPLETE_ENTRY
        )
    first = lines[0].number
    last = lines[-1].number
    start = location.at(first)
    text = "\n".join(document.lines[first - 1 : last]).strip()
    samples = LIST.match(text)
    if samples is None:
        raise start.error("the sample list is not closed by '}'", COMPLETE_ENTRY)
    # Only rules may follow the list.
    after = _content(text[samples.end() :].split("\n"), first + samples[0].count("\n"))
    if after:
        raise start.at(after[0].number).error(
            "unexpected text after the sample list", "end the entry with '}'"
        )
    return samples[1], start


def _sampled(
    sampling: Fields, samples: str, start: SourceLocation
) -> tuple[Array, Array]:
    """Return wavelengths (N,) in nm and reflectances (N,) in units of 1."""
    kind, location = sampling.required("Type")
    known = SAMPLINGS.get(one_line(kind).casefold())
    if known is None:
        raise location.error(
            f"unknown sampling type '{truncate(kind)}'",
            "write 'regular' or 'point sampled'",
        )
    sampling.check_known(known)
    stated = {key: sampling.required(key) for key in known if key != "Type"}
    numbers = {
        key: parse_number(without_unit(text), at, f"'{key}'")
        for key, (text, at) in stated.items()
    }
    scale = check_scale(numbers[SCALE], f"'{SCALE}'", stated[SCALE][1])
    with np.errstate(
        over="ignore", invalid="ignore"
    ):  # Entry reports values that are not finite
        if "Start" not in known:
            wavelengths, values = np.array(_pairs(samples, start)).T
        else:
            if "{" in samples or "}" in samples:
                raise start.error("braces within a regular sample list", WRITE_VALUES)
            values = np.array(_numbers(samples, 0, len(samples), start))
            wavelengths = numbers["Start"] + numbers["Increment"] * np.arange(
                len(values), dtype=np.float64
            )
        return wavelengths, values / scale


def _pairs(samples: str, start: SourceLocation) -> list[list[float]]:
    """Parse ``{x, y}, {x, y}, …``. Raise `AtlasError`."""
    pairs = list[list[float]]()
    end = 0
    while match := PAIR.match(samples, end):
        pairs.append(_numbers(samples, *match.span(1), start))
        if len(pairs[-1]) != 2:
            break
        end = match.end()
    if samples[end:].strip() or not pairs:
        raise _below(start, samples[:end]).error(
            "the samples are not in pairs", WRITE_PAIRS
        )
    return pairs


def _numbers(samples: str, first: int, last: int, start: SourceLocation) -> list[float]:
    """Parse the numbers between two positions of a list that begins at ``start``. Raise
    `AtlasError`.
    """
    numbers = []
    for token in samples[first:last].split(","):
        try:
            numbers.append(parse_float(token))
        except ValueError:  # the error names its line
            blanks = token[: len(token) - len(token.lstrip())]
            numbers.append(
                parse_number(token, _below(start, samples[:first] + blanks), "sample")
            )
        first += len(token) + 1
    return numbers


def _below(start: SourceLocation, text: str) -> SourceLocation:
    """Return the location behind a text that begins at ``start``."""
    return start.at((start.line or 1) + text.count("\n"))


def text(atlas: Atlas, header: Header) -> str:
    """Format an archive: version 1.1, or 1.2 if an entry has an additional description.

    `read` returns the same values, bit for bit.
    """
    version = "1.2" if any(entry.additional_description for entry in atlas) else "1.1"
    lines = [f"{MAGIC} version {version}", ""]
    lines += (
        f"{key}: {one_line(getattr(header, name)) or NOT_STATED}"
        for name, key in HEADER.items()
    )
    return "\n".join(
        [*lines, "", *chain.from_iterable(_entry_lines(entry) for entry in atlas)]
    )


def _entry_lines(entry: Entry) -> Iterator[str]:
    def field(key: str, value: str) -> str:
        return f"{key:<22}:  {one_line(value)}".rstrip()

    yield from (f"Entry ID:   {entry.name}", "-" * 75)
    for name, key in STATEMENTS.items():
        value = one_line(getattr(entry, name))
        if name == "device":
            yield from (field("Type", REFLECTANCE), field("Fluorescence data", "no"))
        if (
            name.endswith("description")
            and len(value) > 1
            and value[0] == value[-1] == '"'
        ):
            value = f'"{value}"'  # the reader removes one pair of quotes
        if value or name != "additional_description":
            yield field(key, value)
    yield from (TITLES[0], "-" * 20)
    # Wavelengths that no start and step give exactly are written one by one.
    step = _exact_step(entry.wavelengths)
    values = entry.values.tolist()
    if step is None:
        yield field("Type", "point sampled")
        samples = [
            f"{{{x!r}, {y!r}}}"
            for x, y in zip(entry.wavelengths.tolist(), values, strict=True)
        ]
    else:
        yield field("Type", "regular")
        yield field("Start", f"{float(entry.wavelengths[0])!r} nm")
        yield field("Increment", f"{step!r} nm")
        samples = list(map(repr, values))
    yield field(SCALE, "1.0")
    yield from (TITLES[1], "-" * 17, f"{{{', '.join(samples)}}}", "")


def _exact_step(wavelengths: Array) -> float | None:
    """Return the step that gives exactly these wavelengths in the reader, None if there
    is none.
    """
    n = len(wavelengths)
    first = wavelengths[0]
    last = wavelengths[-1]
    for step in (
        wavelengths[1] - first,
        (last - first) / (n - 1),
        round((last - first) / (n - 1), 9),
    ):
        if np.array_equal(first + step * np.arange(n), wavelengths):
            return float(step)
    return None
