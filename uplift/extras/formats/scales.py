"""The scale of the values of a file: as given, as the file states, or by the values."""

import re
from collections.abc import Sequence

import numpy as np

from uplift.atlas.atlas import ASSUMED, HIGHEST
from uplift.atlas.document import SourceLocation, truncate
from uplift.common.errors import UpliftWarning, warn
from uplift.extras.formats.samples import Samples
from uplift.extras.formats.statements import PERCENT, TEN_THOUSAND, Scale

GIVEN = {"percent": ("percent", PERCENT), "fraction": ("0 to 1", 1.0)}
WHICH_SCALE = "pass measured='percent' or measured='fraction'"
DARKEST = 1.0
"""A row of a table in percent whose values are all below this number is darker than any
common material.
"""
DIM = 5.0
"""Largest value in percent of dark samples that may be another quantity."""
UNLABELLED = (1.1, 10.0)
"""The same range without any label: from above a white to DIM samples."""
JUMP = 30.0
"""Ratio of neighbouring samples that no reflectance has."""
FLOOR = 0.1
"""Smallest divisor of a ratio, in units of the table."""
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+")
"""A number that may have commas of thousands."""
WHITE = 1.1
"""Largest reflectance of a white that is not fluorescent."""


def find_scale(
    location: SourceLocation,
    stated: Sequence[Scale],
    samples: Sequence[Samples],
    measured: str,
    *,
    labelled: bool = True,
) -> tuple[float, str]:
    """Return the divisor of all values, and a note about it. What is stated wins over
    what the values suggest, and those without a label suggest less.
    """
    if measured != "auto":
        name, divisor = GIVEN[measured]
        return divisor, f"scale: {name}, as given"
    used = [spectrum.used() for spectrum in samples]
    highest = [float(spectrum.values.max(initial=0)) for spectrum in used]
    top = max(highest, default=0.0)
    if stated:
        _check_statements(location, stated, top)
        divisor = stated[0].divisor
        text = truncate(stated[0].text)
        if divisor == PERCENT and top <= DARKEST and samples:
            problem = f"no value exceeds {top:g} percent, as the file states '{text}'"
            hint = "pass measured='fraction' if they are from 0 to 1"
            code = "dark-percent"
            warn(UpliftWarning(problem, code=code, path=location.path, hint=hint))
        how = ASSUMED if stated[0].is_assumed else ", as stated: "
        return divisor, f"scale: 0 to {divisor:g}{how}'{text}'"
    everything = np.concatenate([np.empty(0), *(spectrum.values for spectrum in used)])
    low, high = (HIGHEST, DIM) if labelled else UNLABELLED
    are_above = (everything > 1).sum() * 2 > len(everything)
    if low < top <= high or (top <= HIGHEST and are_above):
        problem = (
            f"values up to {top:g} may be dark samples in percent, or another "
            "quantity, such as K/S, and no scale is stated"
        )
        raise location.error(problem, WHICH_SCALE, code="scale-not-stated")
    if top > HIGHEST and np.median(everything) > HIGHEST * PERCENT:
        problem = f"values up to {top:g} may be counts, or reflectances × 10,000"
        hint = "divide counts by those of a white, or write 'reflectance × 10000' above"
        raise location.error(problem, hint, code="not-reflectance")
    if top > HIGHEST:
        _check_one_scale(location, used, highest)
        problem = f"values up to {top:g} are read as percent and divided by 100"
        entry = used[int(np.argmax(highest))].spectrum.name
        warn(
            UpliftWarning(
                problem, code="values-in-percent", path=location.path, entry=entry
            )
        )
        return PERCENT, f"scale: percent, by values up to {top:g}"
    return (
        1.0,
        f"scale: 0 to 1{ASSUMED}none is stated, and the largest value is {top:g}",
    )


def _check_statements(
    location: SourceLocation, stated: Sequence[Scale], top: float
) -> None:
    """Raise `AtlasError` if statements contradict each other, or the largest value."""
    first = stated[0]
    text = truncate(first.text)
    others = [scale for scale in stated if scale.divisor != first.divisor]
    problem = ""
    if others:
        problem = (
            f"the file states two scales: '{text}' and '{truncate(others[0].text)}'"
        )
    elif first.divisor == 1 and top > HIGHEST:
        problem = f"the file states '{text}', and has values up to {top:g}"
    if problem:
        raise location.error(problem, WHICH_SCALE, code="scales-contradict")


def _check_one_scale(
    location: SourceLocation, samples: Sequence[Samples], highest: Sequence[float]
) -> None:
    """Raise `AtlasError` for a row in units of 1 among rows in percent, or the reverse,
    or within one row.
    """
    problem = ""
    odd = samples[0].spectrum
    # A row that never exceeds 1, where others are in percent, is in units of 1, or the
    # reverse; the minority is named.
    dark = [row for row, top in enumerate(highest) if top <= DARKEST]
    if dark:
        light = [row for row, top in enumerate(highest) if top > HIGHEST]
        (row, *_), (usual, *_) = sorted((dark, light), key=len)
        odd = samples[row].spectrum
        name = truncate(samples[usual].spectrum.name)
        problem = (
            f"values up to {highest[row]:g}, where '{name}' has up to "
            f"{highest[usual]:g}"
        )
    for spectrum in samples:
        # Neighbours that differ by more than JUMP, one of them within [0, 1], and the
        # other one in percent.
        values = spectrum.values
        low = np.minimum(values[:-1], values[1:])
        high = np.maximum(values[:-1], values[1:])
        jumps = np.flatnonzero(
            (low <= DARKEST) & (high > HIGHEST) & (high / JUMP > np.maximum(low, FLOOR))
        )
        if len(jumps):
            at = jumps[0]
            odd = spectrum.spectrum
            nm = spectrum.nm[at + 1]
            problem = f"{values[at]:g}, then {values[at + 1]:g}, at {nm:g} nm"
            break
    if problem:
        raise location.at(odd.line, odd.name).error(
            f"mixed scales of percent and 0 to 1: {problem}",
            (
                "correct the row, or pass measured='percent' or measured='fraction' if "
                "it is right"
            ),
            code="mixed-scales",
        )


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
