"""Sample lists of an ART measurement archive: ``{a, b, …}`` and ``{{x, y}, …}``."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.atlas.art_fields import COMPLETE_ENTRY, Line, content_lines
from uplift.atlas.document import SourceLocation, parse_number
from uplift.common.errors import AtlasError

WRITE_VALUES = "write the samples as numbers separated by commas, in one pair of braces"
WRITE_PAIRS = "write the samples as {{wavelength, value}, {wavelength, value}, …}"


@dataclass(frozen=True)
class SampleText:
    """The text between the outer braces, and the location of its start."""

    text: str
    location: SourceLocation


def extract_samples(lines: list[Line], location: SourceLocation) -> SampleText:
    """Extract the text between the braces that open on the first line with content. Raise `AtlasError`."""
    opening = content_lines(lines)[:1]
    if not opening or not opening[0][1].startswith("{"):
        raise location.error("the sample list, opened by '{', is missing", COMPLETE_ENTRY, code="samples-missing")
    start = opening[0][0]
    first = start - lines[0][0]
    end = _closing(lines, first, location.at(start))
    after = content_lines(lines[end + 1 :])
    text = "\n".join(text for _, text in lines[first : end + 1]).strip()
    if after or not text.endswith("}"):
        line = after[0][0] if after else lines[end][0]
        raise location.at(line).error(
            "unexpected text after the sample list", "end the entry with '}'", code="unexpected-text"
        )
    return SampleText(text[1:-1], location.at(start))


def parse_values(samples: SampleText) -> list[float]:
    """Parse ``a, b, …``. Raise `AtlasError`."""
    if "{" in samples.text or "}" in samples.text:
        raise samples.location.error("braces within a regular sample list", WRITE_VALUES, code="unexpected-braces")
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
    return location.error("the samples are not in pairs", WRITE_PAIRS, code="samples-not-paired")


def _closing(lines: list[Line], first: int, location: SourceLocation) -> int:
    depth = 0
    for i, (_, text) in enumerate(lines[first:], start=first):
        depth += text.count("{") - text.count("}")
        if depth <= 0:
            return i
    raise location.error("the sample list is not closed by '}'", COMPLETE_ENTRY, code="samples-not-closed")


def _numbers(text: str, location: SourceLocation) -> list[float]:
    numbers = []
    for token in text.split(","):
        lead = len(token) - len(token.lstrip())
        location = location.after(token[:lead])
        numbers.append(parse_number(token, location, "sample"))
        location = location.after(token[lead:])
    return numbers
