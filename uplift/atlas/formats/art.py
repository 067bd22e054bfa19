"""Reader of the ART measurement archive (``.ark``), the atlas text format of Tódová 2020, figure 3.1.

An archive is a preamble and entries. An entry has two sections of ``key : value`` fields, and a list of samples:
``{a, b, …}`` or ``{{x, y}, …}``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import Document, SourceLocation, parse_nanometres, parse_number, truncate
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError

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

COMPLETE_ENTRY = "complete the entry (the file may be truncated here) or remove it"
WRITE_VALUES = "write the samples as numbers separated by commas, in one pair of braces"
WRITE_PAIRS = "write the samples as {{wavelength, value}, {wavelength, value}, …}"


def is_art_archive(document: Document) -> bool:
    """Whether the text has the first line or an entry of this format."""
    first = next(line for line in document.lines if line.strip())
    return fold(first).startswith(fold(MAGIC)) or any(key_of(line) == "entry id" for line in document.lines)


def read(document: Document) -> Atlas:
    """Read the reflectances of an archive; entries of other types are skipped."""
    preamble, blocks = split_entries(document)
    header = _header(preamble, SourceLocation(document.path))
    entries = [_entry(block) for block in blocks]
    if not entries:
        hint = "add entries, each beginning with a line 'Entry ID: …'"
        location = SourceLocation(document.path, len(document.lines))
        raise location.error("an archive needs at least one entry", hint)
    return Atlas(
        tuple(item for item in entries if isinstance(item, Entry)),
        tuple(item for item in entries if isinstance(item, SkippedEntry)),
        (Source(document.name, document.digest, header, "ART measurement archive"),),
    )


def read_header(document: Document) -> Header:
    """Read the statements of an archive about itself. Raise `AtlasError`."""
    preamble, _ = split_entries(document)
    return _header(preamble, SourceLocation(document.path))


def _header(lines: list[Line], location: SourceLocation) -> Header:
    if lines and fold(lines[0][1]).startswith(fold(MAGIC)):
        _check_version(lines[0], location)
        lines = lines[1:]
    fields = parse_fields(lines, location)
    fields.check_known(["Archive content", "Archive copyright", "Archive license"])
    values = [fields.text(f"Archive {key}") for key in ("content", "copyright", "license")]
    return Header(*("" if text == NOT_STATED else text for text in values))


def _check_version(line: Line, location: SourceLocation) -> None:
    number, text = line
    version = text.split()[-1]
    if not version.startswith("1."):
        problem = f"unknown archive version '{truncate(version)}'"
        hint = "write the archive as version 1.0, 1.1 or 1.2"
        raise location.at(number).error(problem, hint)


def _entry(block: Block) -> Entry | SkippedEntry:
    samples = extract_samples(block.samples, block.location)
    reason = _why_skipped(block)
    if reason:
        return SkippedEntry(block.name, reason, block.location.path, block.location.line)
    block.fields.check_known(FIELDS)
    wavelengths, values = _sampled(block.sampling, samples)
    return Entry(
        block.name,
        wavelengths,
        values,
        description=_unquote(block.fields.text("Description")),
        additional_description=_unquote(block.fields.text("Additional description")),
        device=block.fields.text("Measurement device"),
        measured_by=block.fields.text("Measured by"),
        date=block.fields.text("Measurement date"),
        path=block.location.path,
        line=block.location.line,
    )


def _why_skipped(block: Block) -> str:
    """Return why an entry of a known type cannot be used, empty if it can. Raise `AtlasError` for unknown types."""
    kind, location = block.fields.required("Type")
    if fold(kind) in OTHER_TYPES:
        return f"its type is '{kind}', not '{REFLECTANCE}'"
    if fold(kind) != REFLECTANCE:
        known = ", ".join(f"'{name}'" for name in (REFLECTANCE, *OTHER_TYPES[:4]))
        raise location.error(f"unknown type '{truncate(kind)}'", f"the types are {known}")
    return "it is fluorescent (bispectral), not a plain reflectance" if _is_fluorescent(block) else ""


def _is_fluorescent(block: Block) -> bool:
    if "fluorescence data" not in block.fields.values:  # then the sampling section is specific to the kind
        return bool(block.sampling.text("Reflectance start"))
    answer, location = block.fields.required("Fluorescence data")
    if fold(answer) not in ("yes", "no"):
        problem = f"'Fluorescence data' must be 'yes' or 'no', got '{truncate(answer)}'"
        raise location.error(problem, "write 'yes' or 'no'")
    return fold(answer) == "yes"


def _sampled(sampling: Fields, samples: SampleText) -> tuple[Array, Array]:
    """Return wavelengths (N,) in nm and reflectances (N,) in units of 1."""
    kind, location = sampling.required("Type")
    if fold(kind) not in SAMPLINGS:
        raise location.error(f"unknown sampling type '{truncate(kind)}'", "write 'regular' or 'point sampled'")
    sampling.check_known(SAMPLINGS[fold(kind)])
    scale = _scale(sampling)
    with np.errstate(over="ignore", invalid="ignore"):  # Entry reports values that are not finite
        wavelengths, values = (
            _regular(sampling, samples) if fold(kind) == "regular" else np.array(parse_pairs(samples)).T
        )
        return wavelengths, values / scale


def _regular(sampling: Fields, samples: SampleText) -> tuple[Array, Array]:
    start = parse_nanometres(*sampling.required("Start"), "'Start'")
    increment = parse_nanometres(*sampling.required("Increment"), "'Increment'")
    values = np.array(parse_values(samples))
    return start + increment * np.arange(len(values), dtype=np.float64), values


def _scale(sampling: Fields) -> float:
    text, location = sampling.required(SCALE)
    scale = parse_number(text, location, f"'{SCALE}'")
    if not 0 < scale < float("inf"):
        raise location.error(
            f"'{SCALE}' must be positive and finite, got {scale:g}", "write 100.0 for percent, 1.0 for values in [0, 1]"
        )
    return scale


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
        return self.values.get(fold(key), (0, ""))[1]

    def required(self, key: str) -> tuple[str, SourceLocation]:
        """Return a required value and its location. Raise `AtlasError` if it is missing."""
        line, value = self.values.get(fold(key), (0, ""))
        if not value:
            raise self.location.error(f"the field '{key}' is missing", f"add a line '{key} : …' to the entry")
        return value, self.location.at(line)

    def check_known(self, known: Iterable[str]) -> None:
        """Check for unknown fields, such as misspelt ones. Raise `AtlasError`."""
        known = tuple(known)
        for key, (line, _) in self.values.items():
            if key not in map(fold, known):
                hint = "the fields are " + ", ".join(f"'{name}'" for name in known)
                raise self.location.at(line).error(f"unknown field '{truncate(key)}'", hint)


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
            raise location.at(number).error(f"unexpected text '{truncate(text)}'", "write 'key : value'")
        if fold(key) in values:
            raise location.at(number).error(f"the field '{truncate(key)}' is repeated", "remove one of the two")
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
    raise location.at(last).error(f"the section '{title}' is missing", COMPLETE_ENTRY)


@dataclass(frozen=True)
class SampleText:
    """The text between the outer braces, and the location of its start."""

    text: str
    location: SourceLocation


def extract_samples(lines: list[Line], location: SourceLocation) -> SampleText:
    """Extract the text between the braces that open on the first line with content. Raise `AtlasError`."""
    opening = content_lines(lines)[:1]
    if not opening or not opening[0][1].startswith("{"):
        raise location.error("the sample list, opened by '{', is missing", COMPLETE_ENTRY)
    start = opening[0][0]
    first = start - lines[0][0]
    end = _closing(lines, first, location.at(start))
    after = content_lines(lines[end + 1 :])
    text = "\n".join(text for _, text in lines[first : end + 1]).strip()
    if after or not text.endswith("}"):
        line = after[0][0] if after else lines[end][0]
        raise location.at(line).error("unexpected text after the sample list", "end the entry with '}'")
    return SampleText(text[1:-1], location.at(start))


def parse_values(samples: SampleText) -> list[float]:
    """Parse ``a, b, …``. Raise `AtlasError`."""
    if "{" in samples.text or "}" in samples.text:
        raise samples.location.error("braces within a regular sample list", WRITE_VALUES)
    return _numbers(samples.text, samples.location)


def parse_pairs(samples: SampleText) -> list[list[float]]:
    """Parse ``{x, y}, {x, y}, …``; the commas between pairs are optional. Raise `AtlasError`."""
    *pieces, rest = samples.text.split("}")
    location, pairs = samples.location, []
    for piece in pieces:
        between, brace, inside = piece.partition("{")
        location = location.after(between)
        pairs.append(_pair(between + brace, inside, location))
        location = location.after(inside)
    if rest.strip() or not pairs:
        raise _pairs_error(location)
    return pairs


def _pair(opening: str, inside: str, location: SourceLocation) -> list[float]:
    numbers = _numbers(inside, location) if opening.strip(", \t\n") == "{" else []
    if len(numbers) != 2:
        raise _pairs_error(location)
    return numbers


def _pairs_error(location: SourceLocation) -> AtlasError:
    return location.error("the samples are not in pairs", WRITE_PAIRS)


def _closing(lines: list[Line], first: int, location: SourceLocation) -> int:
    depth = 0
    for i, (_, text) in enumerate(lines[first:], start=first):
        depth += text.count("{") - text.count("}")
        if depth <= 0:
            return i
    raise location.error("the sample list is not closed by '}'", COMPLETE_ENTRY)


def _numbers(text: str, location: SourceLocation) -> list[float]:
    numbers = []
    for token in text.split(","):
        lead = len(token) - len(token.lstrip())
        location = location.after(token[:lead])
        numbers.append(parse_number(token, location, "sample"))
        location = location.after(token[lead:])
    return numbers
