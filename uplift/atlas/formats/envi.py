"""Reader of ENVI spectral libraries (``.sli`` with ``.hdr``), by the package spectral."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from uplift.atlas.document import MAX_BYTES, Document, SourceLocation, check_scale, truncate
from uplift.atlas.measurements import Measurements, Spectrum, parsed_by
from uplift.common.errors import AtlasError, needs_extra
from uplift.common.files import read_bytes

HEADER, LIBRARY = ".hdr", ".sli"
MAGIC = b"ENVI"
FILE_TYPE = "ENVI Spectral Library"
MAX_HEADER_BYTES = 16 << 20
TO_NANOMETRES = {"nanometers": 1.0, "nm": 1.0, "micrometers": 1e3, "um": 1e3, "": 1.0}
"""Factor by the unit of the wavelengths, in lower case."""
HINT = "write the library again as an ENVI spectral library, or export a CSV table"


def is_envi(document: Document) -> bool:
    """Whether a file is the header of an ENVI file, or has the suffix of a library."""
    return document.path.lower().endswith(LIBRARY) or document.data.lstrip()[:4] == MAGIC


def read(document: Document) -> Measurements:
    """Read the spectra of a library, from the path of either of its two files."""
    location = SourceLocation(document.path)
    header, data = _pair(document)
    with needs_extra("io", "ENVI libraries", AtlasError):
        from spectral.io import envi
    with parsed_by("spectral", "an ENVI spectral library", document.path):
        fields = envi.read_envi_header(os.fspath(header))
        _check_size(fields, data, location)
        library = envi.open(os.fspath(header), os.fspath(data))
        names = [" ".join(str(name).split()) for name in library.names]
        factor = fields.get("reflectance scale factor")
        scale = None if factor is None else check_scale(float(factor), "the reflectance scale factor", location)
        centers, values = library.bands.centers, np.asarray(library.spectra, dtype=float)
    unit = str(fields.get("wavelength units", "")).strip().lower()
    length = TO_NANOMETRES.get(unit if unit != "<unspecified>" else "")
    if centers is None or length is None:
        problem = "the header has no wavelengths" if centers is None else f"unknown wavelength unit '{truncate(unit)}'"
        raise location.error(problem, HINT)
    with np.errstate(over="ignore"):  # infinite wavelengths are refused later
        nm = length * np.asarray(centers, dtype=float)
    spectra = tuple(Spectrum(name, nm, row) for name, row in zip(names, values, strict=True))
    return Measurements(spectra, scale=scale, notes=(f"layout: {Path(data).name} with its header",))


def _pair(document: Document) -> tuple[Path, Path]:
    """Return the paths of header and data. Raise `AtlasError` if one is missing, too large or not a file."""
    path = Path(document.path)
    is_header = document.data.lstrip()[:4] == MAGIC
    if is_header:
        candidates = [path.with_suffix(""), path.with_suffix(LIBRARY), path.with_suffix(LIBRARY.upper())]
    else:
        candidates = [path.with_suffix(HEADER), path.with_suffix(HEADER.upper()), Path(f"{path}{HEADER}")]
    other = next((each for each in candidates if each.is_file() and each != path), candidates[0])
    hint = f"put {other.name} next to it: an ENVI library has two files"
    content = read_bytes(other, AtlasError, limit=MAX_BYTES if is_header else MAX_HEADER_BYTES, hint=hint)
    if not is_header and content.lstrip()[:4] != MAGIC:
        raise SourceLocation(os.fspath(other)).error("is not an ENVI header", HINT, code="not-an-atlas")
    return (path, other) if is_header else (other, path)


def _check_size(fields: dict[str, Any], data: Path, location: SourceLocation) -> None:
    """Raise `AtlasError` unless the header is that of a library as large as the file."""
    if fields.get("file type") != FILE_TYPE:
        raise location.error("is an ENVI image, not a spectral library", HINT, code="not-an-atlas")
    count = int(fields["samples"]) * int(fields["lines"])
    if count <= 0 or count > data.stat().st_size or int(fields.get("header offset", 0)) != 0:
        raise location.error(f"the header states {count:,} values, which the file {data.name} does not hold", HINT)
