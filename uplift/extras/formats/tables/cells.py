"""Cells of tables: numbers, missing values, and labels of wavelengths."""

import itertools
import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from uplift.atlas.atlas import SLACK, VISIBLE
from uplift.common.arrays import Array
from uplift.common.text import parse_float
from uplift.extras.files.csv import parse_decimal
from uplift.extras.formats.quantities import TABLE, label_quantity
from uplift.extras.formats.statements import NANOMETRE, find_unit

SHORTEST = 100.0
"""Wavelength in nm that distinguishes a row of wavelengths from a wavelength and its
values.
"""
MISSING = frozenset(TABLE["words"]["missing"])
PREFIXES = frozenset(TABLE["words"]["prefixes"])
LABEL = re.compile(
    r"([^\d.,+-]{0,40}?)[\s_([]*(\d{1,5}(?:[.,]\d{1,8})?)\s*[([]?\s*(nm|[µμu]m|microns?|å|1/cm)?\s*[)\]]?(?:\s*[([]?%[)\]]?)?",
    re.IGNORECASE,
)
"""A prefix, a wavelength, and perhaps its unit: ``nm400``, ``R_400``, ``380[nm]``,
``Refl (400 nm)``.
"""


class Cell(NamedTuple):
    """Text of a cell, and its line."""

    text: str
    line: int


Row = Sequence[Cell]


class Line(Row):
    """Cells of a line, made when they are used: large tables have millions."""

    __slots__ = ("line", "texts")

    def __init__(self, texts: Sequence[str], line: int) -> None:
        self.texts = tuple(texts)
        self.line = line

    def __len__(self) -> int:
        return len(self.texts)

    def __getitem__(self, key: Any) -> Any:
        part = self.texts[key]
        kind = Cell if isinstance(part, str) else Line
        return kind(part, self.line)


def trimmed(texts: list[str]) -> list[str]:
    """Leave out the empty cells at the end of a line, which spreadsheets add."""
    while texts and not texts[-1].strip():
        texts.pop()
    return texts


def texts_of(row: Row) -> Sequence[str]:
    """Return the texts of cells."""
    return row.texts if isinstance(row, Line) else [cell.text for cell in row]


def line_texts(rows: Iterable[Row]) -> list[str]:
    """Return the text of each row."""
    return [" ".join(texts_of(row)) for row in rows]


def parse_cell(text: str) -> float | None:
    """Parse a number with a decimal point or comma, perhaps in percent; NaN for a
    missing one, None for other text.

    >>> [parse_cell(text) for text in ("0.5", "8,02 %", "n/a", "ochre")]
    [0.5, 8.02, nan, None]
    """
    try:
        return parse_float(text)
    except ValueError:
        plain = text.strip()
    if plain.casefold() in MISSING:
        return np.nan
    try:
        return parse_decimal(plain.removesuffix("%").rstrip())
    except ValueError:
        return None


def is_value(text: str) -> bool:
    """Whether a cell has a number, or a mark of a missing one."""
    return bool(text) and parse_cell(text) is not None


class Label(NamedTuple):
    """What the label of a wavelength begins with, the number, and the unit that it
    states.
    """

    prefix: str
    number: float
    unit: float | None


def parse_label(text: str) -> Label | None:
    """Parse the label of a wavelength; None for other text.

    >>> parse_label("R_400"), parse_label("patch 400")
    (Label(prefix='r', number=400.0, unit=None), None)
    """
    number = parse_cell(text)
    if number is not None:
        return (
            Label("", number, None)
            if np.isfinite(number) and not text.endswith("%")
            else None
        )
    match = LABEL.fullmatch(text.strip())
    if match is None:
        return None
    prefix = re.sub(r"[^a-zλρτ%]", "", match[1].casefold())
    unit = find_unit(match[3] or "")
    # Without a unit, R9 is a colour and R400 a wavelength.
    if unit is None and len(re.split("[.,]", match[2])[0]) not in (3, 4):
        return None
    if prefix not in PREFIXES and not label_quantity(match[1].strip(" _([")):
        return None
    return Label(prefix, float(match[2].replace(",", ".")), unit)


class Run(NamedTuple):
    """Numbers of neighbouring wavelengths in cells ``first`` to ``last`` − 1, prefix of
    their labels, and unit.
    """

    first: int
    last: int
    prefix: str
    numbers: Sequence[float]
    unit: float | None


def runs(cells: Sequence[Cell]) -> Iterator[Run]:
    """Yield runs of two or more neighbouring wavelengths whose labels begin in the same
    way.
    """
    labels = [parse_label(cell.text) for cell in cells]
    first = 0
    for kind, group in itertools.groupby(labels, key=_kind):
        members = list(group)
        numbers = [label.number for label in members if label is not None]
        if kind is not None and len(numbers) > 1:
            unit = next(
                (label.unit for label in members if label is not None and label.unit),
                None,
            )
            yield Run(first, first + len(numbers), kind[0], numbers, unit)
        first += len(members)


def _kind(label: Label | None) -> tuple[str, float] | None:
    """Return what the labels of a run have in common; nm may be stated in some."""
    return None if label is None else (label.prefix, label.unit or NANOMETRE)


def covers_visible(nm: Array) -> bool:
    """Whether wavelengths in nm cover the visible range."""
    return bool(nm.min() <= VISIBLE[0] + SLACK and nm.max() >= VISIBLE[1] - SLACK)


def is_visible(nm: Array) -> bool:
    """Whether numbers are wavelengths in nm that cover the visible range, and not
    wavelengths next to their values.
    """
    return bool(nm.min() >= SHORTEST) and covers_visible(nm)


def are_wavelengths(nm: Array, *, is_named: bool = False) -> bool:
    """Whether numbers, NaN where a cell is empty, are wavelengths in nm: by their range
    and order if a label names them so, else also by their steps, which differ less than
    those of values.
    """
    known = nm[np.isfinite(nm)]
    if len(known) < 3:
        return False
    before = known[:-1]
    after = known[1:]
    is_sorted = (before < after).all() or (before > after).all()
    if is_named:
        return is_visible(known) or bool(is_sorted and known.max() >= SHORTEST)
    if not (is_sorted and is_visible(known)):
        return False
    steps = np.diff(known)
    return bool(np.ptp(steps) < abs(steps.mean()))
