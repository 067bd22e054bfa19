"""Reader of ENVI spectral libraries (``.sli`` with ``.hdr``), by the
package spectral.
"""

import os
from pathlib import Path

import numpy as np

from uplift.atlas import MAX_BYTES, Document, SourceLocation, check_scale, one_line
from uplift.common.errors import AtlasError
from uplift.common.files import read_bytes
from uplift.common.text import pluralise
from uplift.extras.formats.measurements import Measurements, parsed_by
from uplift.extras.formats.quantities import REFLECTANCE, Quantity, remark_quantity
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import (
    Scale,
    remark_scale,
    stated_unit,
    to_nm,
    unit_by_values,
)

HEADER = ".hdr"
LIBRARY = ".sli"
MAGIC = b"ENVI"
FILE_TYPE = "ENVI Spectral Library"
FACTOR = "reflectance scale factor"
"""Field of the divisor of the values."""
IGNORED = "data ignore value"
"""Field of the number for a missing value."""
TEXTS = ("description", "z plot titles", "data units")
"""Fields that may state scale and quantity."""
UNSPECIFIED = ("", "<unspecified>", "unknown")
HINT = "write the library again as an ENVI spectral library, or export a CSV table"


def read(document: Document) -> Measurements:
    """Read the spectra of a library, from the path of either of its two files."""
    location = document.location
    header, data = _pair(document)
    with parsed_by("spectral", "ENVI spectral libraries", document):
        from spectral.io import envi

        fields = envi.read_envi_header(os.fspath(header))
        if fields.get("file type") != FILE_TYPE:
            raise location.error(
                "is an ENVI image, not a spectral library", HINT, code="not-an-atlas"
            )
        # The library allocates what the header states: samples are wavelengths, lines
        # are spectra.
        count = int(fields["samples"]) * int(fields["lines"])
        if (
            count <= 0
            or count > data.stat().st_size
            or int(fields.get("header offset", 0)) != 0
        ):
            problem = (
                f"the header states {pluralise(count, 'value')}, which the file "
                f"{data.name} does not hold"
            )
            raise location.error(problem, HINT)
        library = envi.open(os.fspath(header), os.fspath(data))
        names = list(map(one_line, library.names))
        centers = library.bands.centers
        values = np.asarray(library.spectra, dtype=float)
        scales = _scales(fields, location)
        if IGNORED in fields:
            ignored = float(fields[IGNORED])
            values[np.isclose(values, ignored, rtol=1e-6, atol=0)] = np.nan
    if centers is None:
        raise location.error("the header has no wavelengths", HINT)
    unit = one_line(fields.get("wavelength units"))
    nm = to_nm(
        centers,
        stated_unit(unit, location)
        if unit.lower() not in UNSPECIFIED
        else unit_by_values(centers),
    )
    spectra = tuple(
        Spectrum(name, nm, row) for name, row in zip(names, values, strict=True)
    )
    texts = [one_line(fields.get(key)) for key in TEXTS]
    return Measurements(
        spectra,
        scales=scales or tuple(filter(None, map(remark_scale, texts))),
        notes=(f"layout: {data.name} with its header",),
        quantity=Quantity(REFLECTANCE, FACTOR)
        if FACTOR in fields
        else remark_quantity(texts),
    )


def _scales(fields: dict[str, str], location: SourceLocation) -> tuple[Scale, ...]:
    """Return the scale that a header states."""
    if FACTOR not in fields:
        return ()
    factor = check_scale(float(fields[FACTOR]), f"the {FACTOR}", location)
    return (Scale(factor, f"{FACTOR} = {fields[FACTOR]}"),)


def _pair(document: Document) -> tuple[Path, Path]:
    """Return the paths of header and data. Raise `AtlasError` if one is missing, too
    large or not a file.
    """
    path = Path(document.path)
    is_header = document.data.lstrip().startswith(MAGIC)
    if is_header:
        candidates = [
            path.with_suffix(""),
            path.with_suffix(LIBRARY),
            path.with_suffix(LIBRARY.upper()),
        ]
    else:
        candidates = [
            path.with_suffix(HEADER),
            path.with_suffix(HEADER.upper()),
            Path(f"{path}{HEADER}"),
        ]
    other = next(
        (
            candidate
            for candidate in candidates
            if candidate.is_file() and candidate != path
        ),
        candidates[0],
    )
    hint = f"put {other.name} next to it: an ENVI library has two files"
    content = read_bytes(other, AtlasError, limit=MAX_BYTES, hint=hint)
    if not is_header and not content.lstrip().startswith(MAGIC):
        raise SourceLocation(os.fspath(other)).error(
            "is not an ENVI header", HINT, code="not-an-atlas"
        )
    return (path, other) if is_header else (other, path)
