"""Reader of the ART measurement archive (``.ark``), the atlas text format of Tódová 2020, figure 3.1."""

from __future__ import annotations

import numpy as np

from uplift.atlas.art_fields import NOT_STATED, Block, Fields, Line, fold, key_of, parse_fields, split_entries
from uplift.atlas.art_samples import SampleText, extract_samples, parse_pairs, parse_values
from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import Document, SourceLocation, parse_nanometres, parse_number, truncate
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


def is_art_archive(document: Document) -> bool:
    """Whether the text has the first line or an entry of this format."""
    first = next(line for line in document.lines if line.strip())
    return fold(first).startswith(fold(MAGIC)) or any(key_of(line) == "entry id" for line in document.lines)


def read(document: Document) -> Atlas:
    """Read the reflectances of an archive; entries of other types are skipped.

    Raises
    ------
    AtlasError
        The text deviates from the format; with line, entry and hint.
    """
    preamble, blocks = split_entries(document)
    header = _header(preamble, SourceLocation(document.path))
    entries = [_entry(block) for block in blocks]
    if not entries:
        hint = "add entries, each beginning with a line 'Entry ID: …'"
        location = SourceLocation(document.path, len(document.lines))
        raise location.error("an archive needs at least one entry", hint, code="archive-without-entries")
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
        raise location.at(number).error(problem, hint, code="unknown-archive-version")


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
        raise location.error(f"unknown type '{truncate(kind)}'", f"the types are {known}", code="unknown-entry-type")
    return "it is fluorescent (bispectral), not a plain reflectance" if _is_fluorescent(block) else ""


def _is_fluorescent(block: Block) -> bool:
    if "fluorescence data" not in block.fields.values:  # then the sampling section is specific to the kind
        return bool(block.sampling.text("Reflectance start"))
    answer, location = block.fields.required("Fluorescence data")
    if fold(answer) not in ("yes", "no"):
        problem = f"'Fluorescence data' must be 'yes' or 'no', got '{truncate(answer)}'"
        raise location.error(problem, "write 'yes' or 'no'", code="not-yes-or-no")
    return fold(answer) == "yes"


def _sampled(sampling: Fields, samples: SampleText) -> tuple[Array, Array]:
    """Return wavelengths (N,) in nm and reflectances (N,) in units of 1."""
    kind, location = sampling.required("Type")
    if fold(kind) not in SAMPLINGS:
        raise location.error(
            f"unknown sampling type '{truncate(kind)}'",
            "write 'regular' or 'point sampled'",
            code="unknown-sampling-type",
        )
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
            f"'{SCALE}' must be positive and finite, got {scale:g}",
            "write 100.0 for percent, 1.0 for values in [0, 1]",
            code="invalid-scale",
        )
    return scale


def _unquote(text: str) -> str:
    """Remove one pair of enclosing quotes; those of ``"a" and "b"`` do not enclose (`art_write` quotes to match)."""
    inside = text[1:-1]
    quoted = len(text) > 1 and text[0] == text[-1] == '"'
    encloses = '"' not in inside or (inside[0] == inside[-1] == '"')
    return inside if quoted and encloses else text
