"""Reader of the ART measurement archive (``.ark``), the atlas text format of Tódová 2020, figure 3.1."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from uplift.atlas.art_fields import NOT_STATED, Block, Fields, Line, fold, key_of, parse_fields, split
from uplift.atlas.art_samples import SampleText, enclosed, pairs, plain
from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.checks import Array
from uplift.atlas.document import Document, SourceLocation, nanometres, number, truncate

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


def claims(document: Document) -> bool:
    """Whether the text bears the marks of this format."""
    first = next(line for line in document.lines if line.strip())
    return fold(first).startswith(fold(MAGIC)) or any(key_of(line) == "entry id" for line in document.lines)


def read(document: Document) -> Atlas:
    """All reflectances of an archive; other kinds of entries are skipped, with the reason.

    Raises
    ------
    AtlasError : anything that is not as the format says, with line, entry and hint.
    """
    preamble, blocks = split(document)
    header = _header(preamble, SourceLocation(document.path))
    found = [_entry(block) for block in blocks]
    if not found:
        hint = "add entries, each beginning with a line 'Entry ID: …'"
        raise SourceLocation(document.path, len(document.lines)).error("the archive has no entry", hint)
    return Atlas(
        tuple(item for item in found if isinstance(item, Entry)),
        tuple(item for item in found if isinstance(item, SkippedEntry)),
        (Source(document.name, document.digest, header),),
    )


def _header(lines: list[Line], place: SourceLocation) -> Header:
    if lines and fold(lines[0][1]).startswith(fold(MAGIC)):
        _check_version(lines[0], place)
        lines = lines[1:]
    fields = parse_fields(lines, place)
    fields.check_known(["Archive content", "Archive copyright", "Archive license"])
    stated = [fields.text(f"Archive {key}") for key in ("content", "copyright", "license")]
    return Header(*("" if text == NOT_STATED else text for text in stated))


def _check_version(line: Line, place: SourceLocation) -> None:
    number, text = line
    version = text.split()[-1]
    if not version.startswith("1."):
        problem = f"archive version '{truncate(version)}' is not known"
        raise place.at(number).error(problem, "write the archive as version 1.0, 1.1 or 1.2")


def _entry(block: Block) -> Entry | SkippedEntry:
    samples = enclosed(block.samples, block.place)
    reason = _why_skipped(block)
    if reason:
        return SkippedEntry(block.name, reason, block.place.path, block.place.line)
    block.fields.check_known(FIELDS)
    wavelengths, values = _sampled(block.sampling, samples)
    return Entry(
        block.name,
        wavelengths,
        values,
        description=_unquote(block.fields.text("Description")),
        additional=_unquote(block.fields.text("Additional description")),
        device=block.fields.text("Measurement device"),
        measured_by=block.fields.text("Measured by"),
        date=block.fields.text("Measurement date"),
        path=block.place.path,
        line=block.place.line,
    )


def _why_skipped(block: Block) -> str:
    """Why a known kind of entry cannot be used, empty if it can. Raises `AtlasError` for an unknown kind."""
    kind, place = block.fields.required("Type")
    if fold(kind) in OTHER_TYPES:
        return f"its type is '{kind}', not '{REFLECTANCE}'"
    if fold(kind) != REFLECTANCE:
        known = ", ".join(f"'{name}'" for name in (REFLECTANCE, *OTHER_TYPES[:4]))
        raise place.error(f"unknown type '{truncate(kind)}'", f"the types are {known}")
    return "it is fluorescent (bispectral): no plain reflectance" if _is_fluorescent(block) else ""


def _is_fluorescent(block: Block) -> bool:
    if "fluorescence data" not in block.fields.values:  # the samples tell as well
        return bool(block.sampling.text("Reflectance start"))
    answer, place = block.fields.required("Fluorescence data")
    if fold(answer) not in ("yes", "no"):
        raise place.error(f"'Fluorescence data' is '{truncate(answer)}'", "write 'yes' or 'no'")
    return fold(answer) == "yes"


def _sampled(sampling: Fields, samples: SampleText) -> tuple[Array, Array]:
    """Wavelengths (N,) nm and reflectances (N,) in units of 1."""
    kind, place = sampling.required("Type")
    if fold(kind) not in SAMPLINGS:
        raise place.error(f"unknown sampling type '{truncate(kind)}'", "write 'regular' or 'point sampled'")
    sampling.check_known(SAMPLINGS[fold(kind)])
    scale = _scale(sampling)
    read: Callable[[Fields, SampleText], tuple[Array, Array]] = (
        _regular if fold(kind) == "regular" else _points
    )
    with np.errstate(over="ignore", invalid="ignore"):  # absurd scales and steps are reported by name later
        wavelengths, values = read(sampling, samples)
        return wavelengths, values / scale


def _regular(sampling: Fields, samples: SampleText) -> tuple[Array, Array]:
    start = nanometres(*sampling.required("Start"), "'Start'")
    increment = nanometres(*sampling.required("Increment"), "'Increment'")
    values = np.array(plain(samples))
    return start + increment * np.arange(len(values), dtype=np.float64), values


def _points(_: Fields, samples: SampleText) -> tuple[Array, Array]:
    wavelengths, values = np.array(pairs(samples)).T
    return wavelengths, values


def _scale(sampling: Fields) -> float:
    text, place = sampling.required(SCALE)
    scale = number(text, place, f"'{SCALE}'")
    if not 0 < scale < float("inf"):
        raise place.error(f"'{SCALE}' is {scale:g}", "write 100.0 for percent, 1.0 for values within [0, 1]")
    return scale


def _unquote(text: str) -> str:
    """Text without the quotes around it; ``"a" and "b"`` has none around it (`art_write` quotes to match)."""
    inside = text[1:-1]
    quoted = len(text) > 1 and text[0] == text[-1] == '"'
    encloses = '"' not in inside or (inside[0] == inside[-1] == '"')
    return inside if quoted and encloses else text
