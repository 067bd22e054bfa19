"""Reader of JCAMP-DX (``.dx``, ``.jdx``), by the package jcamp."""

import contextlib
import io
import re

import numpy as np

from uplift.atlas.document import EXPORT, Document, one_line, to_nanometres, truncate
from uplift.atlas.measurements import PERCENT, Measurements, Spectrum, find_quantity, parsed_by, wrong_quantity
from uplift.common.text import pluralise

POINTS = re.compile(r"^##\s*NPOINTS\s*=\s*(\S+)", re.IGNORECASE | re.MULTILINE)
MAX_POINTS = 1_000_000
REFLECTANCES = ("", "%r", "r", "arbitrary units")
"""Units of values that may be reflectances without the word."""


def read(document: Document) -> Measurements:
    """Read the spectrum of a file, or those of the blocks of a compound file."""
    # The library allocates what the file states.
    for count in POINTS.findall(document.text):
        if not re.fullmatch(r"\d{1,7}(\.0*)?", count) or float(count) > MAX_POINTS:
            raise document.location.error(f"NPOINTS must be at most {MAX_POINTS:,}, got {truncate(count)}", EXPORT)
    with parsed_by("jcamp", "JCAMP-DX files", document), contextlib.redirect_stdout(io.StringIO()) as printed:
        import jcamp

        content = jcamp.read(document.text.splitlines())
        blocks = content.get("children") or [content]
    # It prints, and does not raise, that check values disagree with the data.
    if "failed" in printed.getvalue() or "Mismatch" in printed.getvalue():
        problem = f"the data contradict their check values: {truncate(printed.getvalue())}"
        raise document.location.error(problem, EXPORT)
    spectra, scales, refusal, material = list[Spectrum](), set[float | None](), None, ""
    for block in blocks:
        name = one_line(block.get("title")) or document.stem
        location = document.location.at(entry=name)
        unit = one_line(block.get("yunits")).lower()
        if "reflect" in unit:
            material = material or unit
        else:
            refusal = refusal or find_quantity(f"{unit} {block.get('data type', '')}", location)
            if unit not in REFLECTANCES:
                problem = f"YUNITS must be reflectance, got '{truncate(unit)}'"
                refusal = refusal or wrong_quantity(problem, location)
        nm = to_nanometres(block.get("x", ()), one_line(block.get("xunits")).lower(), location)
        values = np.asarray(block.get("y", ()), dtype=float)
        spectra.append(Spectrum(name, nm, values, date=str(block.get("date", ""))))
        scales.add(PERCENT if "%" in unit or "percent" in unit else None)
    return Measurements(
        tuple(spectra),
        scale=scales.pop() if len(scales) == 1 else None,
        notes=(f"layout: {pluralise(len(blocks), 'block')}",),
        material=material,
        refusal=refusal,
    )
