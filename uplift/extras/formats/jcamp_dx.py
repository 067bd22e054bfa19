"""Reader of JCAMP-DX (``.dx``, ``.jdx``), by the package jcamp."""

import contextlib
import io
import re
from itertools import chain

import numpy as np

from uplift.atlas.document import EXPORT, Document, one_line, truncate
from uplift.common.text import pluralise
from uplift.extras.formats.measurements import Measurements, parsed_by
from uplift.extras.formats.quantities import OTHER, Quantity, label_quantity
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import (
    Scale,
    label_scale,
    stated_unit,
    to_nm,
)

POINTS = re.compile(r"^##\s*NPOINTS\s*=\s*(\S+)", re.IGNORECASE | re.MULTILINE)
DATA = re.compile(
    r"^##\s*XY(?:DATA|POINTS)\s*=.*\n([^#]*)", re.IGNORECASE | re.MULTILINE
)
"""Lines of numbers."""
COMMA = re.compile(r"(?<![\d.,])([+-]?\d+),(\d+)(?![\d.,])")
"""A number with a decimal comma, or two numbers."""
FIRST = re.compile(
    r"^##\s*(?:FIRST|LAST|DELTA|MIN|MAX)[XY]\s*=\s*[+-]?\d+,\d",
    re.IGNORECASE | re.MULTILINE,
)
"""A single number with a decimal comma."""
MAX_POINTS = 1_000_000
REFLECTANCES = ("", "%r", "r", "arbitrary units")
"""Units of values that may be reflectances without the word."""


def read(document: Document) -> Measurements:
    """Read the spectrum of a file, or those of the blocks of a compound file."""
    # The library allocates what the file states.
    for count in POINTS.findall(document.text):
        if not re.fullmatch(r"\d{1,7}(\.0*)?", count) or float(count) > MAX_POINTS:
            raise document.location.error(
                f"NPOINTS must be at most {MAX_POINTS:,}, got {truncate(count)}", EXPORT
            )
    with (
        parsed_by("jcamp", "JCAMP-DX files", document),
        contextlib.redirect_stdout(io.StringIO()) as printed,
    ):
        import jcamp

        content = jcamp.read(_with_points(document.text).splitlines())
        blocks = content.get("children") or [content]
    # It prints, and does not raise, that check values disagree with the data.
    if "failed" in printed.getvalue() or "Mismatch" in printed.getvalue():
        problem = (
            f"the data contradict their check values: {truncate(printed.getvalue())}"
        )
        raise document.location.error(problem, EXPORT)
    spectra = list[Spectrum]()
    scales = list[Scale]()
    for block in blocks:
        name = one_line(block.get("title")) or document.stem
        location = document.location.at(entry=name)
        unit = one_line(block.get("yunits"))
        quantity = label_quantity(f"{unit} {block.get('data type', '')}")
        if quantity is None and unit.lower() not in REFLECTANCES:
            quantity = Quantity(OTHER, f"YUNITS={unit}")
        nm = to_nm(
            block.get("x", ()), stated_unit(one_line(block.get("xunits")), location)
        )
        values = np.asarray(block.get("y", ()), dtype=float)
        spectra.append(
            Spectrum(
                name, nm, values, date=str(block.get("date", "")), quantity=quantity
            )
        )
        scales += filter(None, [label_scale(unit)])
    notes = (f"layout: {pluralise(len(blocks), 'block')}",)
    return Measurements(tuple(spectra), scales=tuple(scales), notes=notes)


def _with_points(text: str) -> str:
    """Return a text with points in place of decimal commas. Commas between the numbers
    of pairs stay.
    """
    pairs = list(
        chain.from_iterable(COMMA.finditer(data) for data in DATA.findall(text))
    )
    wavelengths = [float(match[1]) for match in pairs]
    ascending = sorted(set(wavelengths))
    are_pairs = wavelengths in (ascending, ascending[::-1])
    if not FIRST.search(text) and (are_pairs or not pairs):
        return text
    return COMMA.sub(r"\1.\2", text)
