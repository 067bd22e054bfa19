"""Commas in the numbers of a table: decimal ones, or those of thousands, which
spreadsheets write in quotes.
"""

import re
from collections.abc import Sequence
from itertools import chain

from uplift.atlas import HIGHEST
from uplift.extras.formats.statements import PERCENT, TEN_THOUSAND, Scale
from uplift.extras.formats.tables.cells import Row
from uplift.extras.formats.tables.grid import Series

GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+")
"""A number that may have commas of thousands."""
WHITE = 1.1
"""Largest reflectance of a white that is not fluorescent."""


def read_commas(series: Sequence[Series]) -> tuple[Sequence[Series], list[Scale]]:
    """Return spectra without commas of thousands, and what the commas state: both
    readings if they may be decimal.

    Commas are those of thousands if all numbers that have one have groups of three
    digits, and either there are whole numbers without one, or the numbers are
    reflectances × 10,000 up to white.
    """
    cells = chain.from_iterable(one.cells for one in series)
    texts = [cell.text for cell in cells]
    grouped = [text for text in texts if "," in text]
    if not grouped or not all(map(GROUPED.fullmatch, grouped)):
        return series, []
    first = grouped[0]
    whole = first.replace(",", "")
    top = max(float(text.replace(",", "")) for text in grouped) / TEN_THOUSAND
    if 1 <= top <= WHITE or any(text.isdigit() and int(text) for text in texts):
        scale = Scale(TEN_THOUSAND, f"{first} is {whole}", is_assumed=True)
        return [one._replace(cells=_without_commas(one.cells)) for one in series], [
            scale
        ]
    if top > HIGHEST:
        return series, []
    decimal = Scale(PERCENT, f"{first} is {first.replace(',', '.')} percent")
    return series, [decimal, Scale(10.0, f"{first} is {whole} of 10,000")]


def _without_commas(cells: Row) -> Row:
    return tuple(cell._replace(text=cell.text.replace(",", "")) for cell in cells)
