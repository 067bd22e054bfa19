"""Sample lists of an ART measurement archive: ``{a, b, …}`` and ``{{x, y}, …}``."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.atlas.art_fields import TRUNCATED, Line, spoken
from uplift.atlas.document import SourceLocation, number

PLAIN = "write the samples as numbers with commas between, in one pair of braces"
PAIRS = "write the samples as {{wavelength, value}, {wavelength, value}, …}"


@dataclass(frozen=True)
class SampleText:
    """What stands between the outer braces, and where it begins."""

    text: str
    place: SourceLocation


def enclosed(lines: list[Line], place: SourceLocation) -> SampleText:
    """The text between the braces that open on the first spoken line. Raises `AtlasError`."""
    opening = spoken(lines)[:1]
    if not opening or not opening[0][1].startswith("{"):
        raise place.error("the sample list, opened by '{', is missing", TRUNCATED)
    start = opening[0][0]
    first = start - lines[0][0]
    end = _closing(lines, first, place.at(start))
    after = spoken(lines[end + 1 :])
    text = "\n".join(text for _, text in lines[first : end + 1]).strip()
    if after or not text.endswith("}"):
        line = after[0][0] if after else lines[end][0]
        raise place.at(line).error("unexpected text after the sample list", "end the entry with '}'")
    return SampleText(text[1:-1], place.at(start))


def plain(samples: SampleText) -> list[float]:
    """Numbers of ``a, b, …``. Raises `AtlasError`."""
    if "{" in samples.text or "}" in samples.text:
        raise samples.place.error("braces within a regular sample list", PLAIN)
    return _numbers(samples.text, samples.place)


def pairs(samples: SampleText) -> list[list[float]]:
    """Pairs of ``{x, y}, {x, y}, …``, the commas between the pairs may be missing. Raises `AtlasError`."""
    *pieces, rest = samples.text.split("}")
    place, found = samples.place, []
    for piece in pieces:
        between, brace, inside = piece.partition("{")
        place = place.after(between)
        found.append(_pair(between + brace, inside, place))
        place = place.after(inside)
    if rest.strip() or not found:
        raise place.error("samples that are not in pairs", PAIRS)
    return found


def _pair(opening: str, inside: str, place: SourceLocation) -> list[float]:
    numbers = _numbers(inside, place) if opening.strip(", \t\n") == "{" else []
    if len(numbers) != 2:
        raise place.error("samples that are not in pairs", PAIRS)
    return numbers


def _closing(lines: list[Line], first: int, place: SourceLocation) -> int:
    depth = 0
    for i, (_, text) in enumerate(lines[first:], start=first):
        depth += text.count("{") - text.count("}")
        if depth <= 0:
            return i
    raise place.error("the sample list is not closed by '}'", TRUNCATED)


def _numbers(text: str, place: SourceLocation) -> list[float]:
    numbers = []
    for token in text.split(","):
        lead = len(token) - len(token.lstrip())
        place = place.after(token[:lead])
        numbers.append(number(token, place, "sample"))
        place = place.after(token[lead:])
    return numbers
