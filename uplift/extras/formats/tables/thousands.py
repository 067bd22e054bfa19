"""Commas in the numbers of a table: decimal ones, or those of thousands, which
spreadsheets write in quotes.
"""

import re
from collections.abc import Sequence

from uplift.atlas.atlas import HIGHEST
from uplift.extras.formats.statements import PERCENT, TEN_THOUSAND, Scale

GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+")
"""A number that may have commas of thousands."""
WHITE = 1.1
"""Largest reflectance of a white that is not fluorescent."""


def comma_scales(texts: Sequence[str], divisors: Sequence[float]) -> list[Scale]:
    """Return the scale that commas of thousands in the values of a table state, two if
    they may be decimal, none if they are decimal. Scales of ``divisors`` are stated.

    Commas are those of thousands if all numbers that have one have groups of three
    digits, and either there are whole numbers without one, or the numbers are
    reflectances × 10,000 up to white.
    """
    grouped = [text for text in texts if "," in text]
    is_decimal = divisors and TEN_THOUSAND not in divisors
    if is_decimal or not grouped or not all(map(GROUPED.fullmatch, grouped)):
        return []
    first = grouped[0]
    whole = first.replace(",", "")
    top = max(float(text.replace(",", "")) for text in grouped) / TEN_THOUSAND
    has_others = any(text.isdigit() and int(text) for text in texts)
    if divisors or has_others or 1 <= top <= WHITE:
        return [Scale(TEN_THOUSAND, f"{first} is {whole}", is_assumed=True)]
    if top > HIGHEST:
        return []
    decimal = Scale(PERCENT, f"{first} is {first.replace(',', '.')} percent")
    return [decimal, Scale(TEN_THOUSAND / 1000, f"{first} is {whole} of 10,000")]
