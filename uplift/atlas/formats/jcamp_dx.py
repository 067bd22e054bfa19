"""Reader of JCAMP-DX (``.dx``, ``.jdx``), by the package jcamp."""

from __future__ import annotations

import contextlib
import io
import re
from typing import Any

import numpy as np

from uplift.atlas.document import Document, SourceLocation, truncate
from uplift.atlas.measurements import (
    PERCENT,
    Measurements,
    Spectrum,
    check_quantity,
    parsed_by,
    refuse_as_lamp,
    refuse_quantity,
)
from uplift.common.errors import AtlasError, needs_extra

POINTS = re.compile(r"^##\s*NPOINTS\s*=\s*(\S+)", re.IGNORECASE | re.MULTILINE)
MAX_POINTS = 1_000_000
TO_NANOMETRES = {"nanometers": 1.0, "nanometres": 1.0, "nm": 1.0, "micrometers": 1e3, "micrometres": 1e3, "um": 1e3}
"""Factor by the unit of the abscissa, in lower case."""
WAVE_NUMBER = "1/cm"


def is_jcamp(document: Document) -> bool:
    """Whether the first line with a letter is the title of JCAMP-DX."""
    first = next((line for line in document.lines if line.strip() and not line.startswith("$$")), "")
    return re.match(r"\s*##\s*TITLE\s*=", first, re.IGNORECASE) is not None


def read(document: Document) -> Measurements:
    """Read the spectrum of a file, or those of the blocks of a compound file."""
    location = SourceLocation(document.path)
    for count in POINTS.findall(document.text):
        if not re.fullmatch(r"\d{1,7}(\.0*)?", count) or float(count) > MAX_POINTS:
            problem = f"NPOINTS must be at most {MAX_POINTS:,}, got {truncate(count)}"
            raise location.error(problem, "export the file again")
    with needs_extra("io", "JCAMP-DX files", AtlasError):
        import jcamp
    with parsed_by("jcamp", "JCAMP-DX", document.path), contextlib.redirect_stdout(io.StringIO()) as printed:
        content = jcamp.read(document.text.splitlines())
        blocks = content.get("children") or [content]
    if "failed" in printed.getvalue() or "Mismatch" in printed.getvalue():
        problem = truncate(printed.getvalue())
        raise location.error(f"the data contradict their check values: {problem}", "export the file again")
    found = [_spectrum(block, document) for block in blocks]
    scales = {scale for _, scale in found}
    return Measurements(
        tuple(spectrum for spectrum, _ in found),
        scale=scales.pop() if len(scales) == 1 else None,
        notes=(f"layout: {len(blocks)} block{'s' * (len(blocks) != 1)}",),
    )


def _spectrum(block: dict[str, Any], document: Document) -> tuple[Spectrum, float | None]:
    """Return the spectrum of a block, and the scale that it states."""
    name = " ".join(str(block.get("title", "")).split()) or document.stem
    location = SourceLocation(document.path, entry=name)
    unit = str(block.get("yunits", "")).strip().lower()
    if "reflect" in unit:
        refuse_as_lamp(unit, location)
    else:
        check_quantity(f"{unit} {block.get('data type', '')}", location)
        if unit not in ("", "%r", "r", "arbitrary units"):
            refuse_quantity(f"YUNITS must be reflectance, got '{truncate(unit)}'", location)
    length = str(block.get("xunits", "")).strip().lower()
    if length not in (WAVE_NUMBER, *TO_NANOMETRES):
        problem = f"XUNITS must be nanometers, micrometers or 1/cm, got '{truncate(length)}'"
        raise location.error(problem, "export the file with wavelengths in nm")
    x, y = (np.asarray(block.get(axis, ()), dtype=float) for axis in "xy")
    with np.errstate(all="ignore"):
        nm = 1e7 / x if length == WAVE_NUMBER else TO_NANOMETRES[length] * x
    spectrum = Spectrum(name, nm, y, date=str(block.get("date", "")))
    return spectrum, PERCENT if "%" in unit or "percent" in unit else None
