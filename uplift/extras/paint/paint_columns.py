"""Columns of a table of recipes: which are paints, by their labels and their parts.

A column whose label names another quantity is not a paint. Of the others all are, if
their parts make up the same whole in each row, or else those that do so without a few.
Parts in other units, such as 1 to 4, have no whole. There, a column that has a number
in each row next to paints that have not may be another quantity, and raises.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, combinations

import numpy as np

from uplift.atlas.document import SourceLocation
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError
from uplift.common.text import format_value
from uplift.extras.formats.tables.cells import is_value, parse_cell, parse_label
from uplift.extras.formats.tables.grid import NAME_LABELS, plain_label

COLOUR_LABELS = ("colour", "color", "hex", "srgb")
MICROMETRES = {
    "nm": 1e-3,
    "um": 1.0,
    "µm": 1.0,  # the micro sign
    "μm": 1.0,  # the Greek letter, its lower case
    "micron": 1.0,
    "mil": 25.4,
    "mm": 1e3,
    "cm": 1e4,
}
"""Units of thickness."""
LENGTH = "|".join(f"{unit}s?" for unit in MICROMETRES)
THICKNESS = re.compile(
    r"(?!.*\b(std|sd|stdev|deviation|error)\b)"
    r"(\w+ )*(thickness|dft|wft|(film|layer|coat) (height|depth|build))"
    rf"( ({LENGTH}))?"
)
GROUND = re.compile(
    r"(ground|substrate|backing|background|support)( (name|colour|color))?"
)
OTHER = re.compile(
    r"total|sum|weight|mass|amount|quantity|qty|volume|density|viscosity|solids|ph|"
    r"batch|lot|no|nr|num|number|id|uid|index|row|line|page|panel|sheet|card|position|"
    r"run|rep|replicate|test|series|sample|patch|date|time|day|month|year|age|operator|"
    r"instrument|observer|angle|geometry|aperture|description|comments?|remarks?|"
    r"gloss|haze|opacity|hiding|contrast|ratio|coverage|price|cost|count|layers?|coats?|"
    r"temp|temperature|humidity|rh|delta|δ?[eabhlc]|d[eabhlc]|hue|chroma|lightness|"
    r"luminance|whiteness|yellowness|thickness|film|dry|drying|wet|mix|mixture|"
    r"mixing|mean|average|avg|std|sd|stdev|deviation|error|min|max|[rgbxyzlhsvu]|"
    rf"{LENGTH}|m?g|kg|ml|f|gu|deg|percent"
)
"""Words of labels that name other quantities, with their units."""
SPACES = ("rgb", "xyz", "xy", "lab", "lch", "luv", "hsv", "hsl")
"""Letters that name colours if all of them are labels, and have a number in each row.
One alone may be a paint.
"""
STATED = re.compile(
    r"\(parts\)|\b(white|base|medium|binder|vehicle|extender|PW ?\d+)\b", re.IGNORECASE
)
"""Paints that samples may all have."""
WHOLES = (1, 100)
ROUNDING = 0.02
"""Tolerance of a whole, relative."""
MAX_OTHERS = 2
"""Most columns without which the others may make up a whole."""


@dataclass(frozen=True)
class Columns:
    """Positions of columns; those that a table has not are −1."""

    name: int
    thickness: int
    ground: int
    colour: int
    paints: dict[str, int]
    unused: tuple[str, ...]
    """Labels of columns that are not used."""


def find_columns(
    head: Sequence[str], rows: Sequence[Sequence[str]], location: SourceLocation
) -> Columns:
    """Classify columns by the header and the rows below, which are as long. Raise
    `AtlasError` for an ambiguous one.
    """
    labels = [plain_label(text) for text in head]
    words = [_words(text) for text in head]
    cells = list(zip(*rows, strict=True)) or [("",)] * len(head)
    filled = [at for at, column in enumerate(cells) if any(column)]
    names = [labels.index(label) for label in NAME_LABELS if label in labels] or [0]
    colours = [at for at, label in enumerate(labels) if label in COLOUR_LABELS]
    films = [at for at in filled if THICKNESS.fullmatch(words[at])]
    grounds = [at for at in filled if GROUND.fullmatch(words[at])]
    for repeated in (*films[1:], *grounds[1:]):
        problem = "states a thickness or ground, as another one does"
        raise _ambiguous(head[repeated], problem, location)
    known = {names[0], *colours, *films, *grounds}
    columns = [at for at in filled if at not in known and parse_label(head[at]) is None]
    below = cells[grounds[0]] if grounds else ()
    painted = [name not in below for name in cells[names[0]]]
    candidates = {
        at: _amounts(cells[at])[painted]
        for at in columns
        if any(map(is_value, cells[at])) and not _is_other(head[at], words[at])
    }
    if _deviation(candidates, list(candidates)) > ROUNDING:
        letters = set("".join(filter(set(labels).issuperset, SPACES)))
        for at in columns:
            if labels[at] in letters and all(cells[at]):
                candidates.pop(at, None)
    paints = dict[str, int]()
    for at in _paints(candidates, head, location):
        label = head[at].replace("(parts)", "").strip()
        if label in paints:
            raise location.error(
                f"two columns have the name {format_value(label)}",
                "rename one of the paints",
            )
        paints[label] = at
    unused = [head[at] for at in columns if at not in paints.values()]
    thickness, ground, colour = ((*at, -1)[0] for at in (films, grounds, colours))
    return Columns(names[0], thickness, ground, colour, paints, tuple(unused))


def _amounts(cells: Sequence[str]) -> Array:
    """Return the finite numbers of cells, 0 for others."""
    numbers = [parse_cell(cell) or 0.0 for cell in cells]
    return np.nan_to_num(numbers, posinf=0, neginf=0)


def _words(label: str) -> str:
    """Return the words of a label in lower case, without what is in brackets."""
    plain = re.sub(r"[(\[].*", "", label)
    spaced = re.sub(r"(?<=[a-z]{2})(?=[A-Z])", " ", plain)
    return " ".join(re.findall(r"[^\W\d_]+", spaced.casefold()))


def _is_other(label: str, words: str) -> bool:
    """Whether a label names another quantity than the parts of a paint."""
    if "(parts)" in label:
        return False
    if "*" in label or not words or "note" in words.split():
        return True
    return len(words) > 1 and all(map(OTHER.fullmatch, words.split()))


def _paints(
    candidates: dict[int, Array], head: Sequence[str], location: SourceLocation
) -> Sequence[int]:
    """Return the columns that make up a whole best, without a few, or else all."""
    least = len(candidates) - MAX_OTHERS
    sizes = range(len(candidates), max(least, 2) - 1, -1)
    subsets = chain.from_iterable(combinations(candidates, size) for size in sizes)
    best = min(subsets, key=partial(_deviation, candidates), default=())
    if _deviation(candidates, best) <= ROUNDING:
        return best
    present = np.array([values > 0 for values in candidates.values()])
    counts = present.sum(axis=0)
    is_mixed = counts.any() and (counts != 1).all()
    for at, values in candidates.items():
        is_everywhere = is_mixed and values[counts > 0].all()
        if is_everywhere and not STATED.search(head[at]):
            problem = "may be a paint of all samples, or another quantity"
            raise _ambiguous(head[at], problem, location)
    return list(candidates)


def _deviation(candidates: dict[int, Array], columns: Sequence[int]) -> float:
    """Return the largest relative difference of the sums of columns from one of
    `WHOLES`, in rows with numbers; infinite if no row mixes them.
    """
    parts = np.array([candidates[at] for at in columns])
    if not (parts > 0).sum(axis=0).max(initial=0) > 1:
        return np.inf
    sums = parts.sum(axis=0)[np.any(list(candidates.values()), axis=0)]
    return min(float(abs(sums / whole - 1).max()) for whole in WHOLES)


def _ambiguous(label: str, problem: str, location: SourceLocation) -> AtlasError:
    return location.error(
        f"column {format_value(label)} {problem}",
        f"rename it 'note {label}' if it is not to be used, '{label} (parts)' if it is "
        "a paint",
        code="ambiguous-column",
    )
