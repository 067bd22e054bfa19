"""Reader of ENVI spectral libraries: a header (``.hdr``) and numbers (``.sli``)."""

from pathlib import Path

import numpy as np

from uplift.atlas.document import (
    Document,
    check_scale,
    one_line,
    parse_number,
    read_document,
)
from uplift.common.arrays import Array
from uplift.common.text import parse_float, parse_whole
from uplift.extras.formats.measurements import Measurements
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
SUFFIXES = (".sli", ".SLI", "", ".img", ".dat", ".bin", ".lib", ".esl")
"""Suffixes of files of numbers."""
MAGIC = b"ENVI"
FILE_TYPE = "envi spectral library"
TYPES = {
    "1": "u1", "2": "i2", "3": "i4", "4": "f4", "5": "f8",
    "12": "u2", "13": "u4", "14": "i8", "15": "u8",
}  # fmt: skip
"""Types of numbers by the field ``data type``."""
BYTE_ORDERS = {"0": "<", "1": ">"}
CHOICES = {"bands": ("1",), "byte order": BYTE_ORDERS, "data type": TYPES}
"""Fields whose values are limited."""
DEFAULTS = {
    "bands": "1", "byte order": "0", "data type": "", "header offset": "0",
    "lines": "", "samples": "",
}  # fmt: skip
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
    header, data = _pair(document)
    location = header.location
    fields = _fields(header)
    if fields.get("file type", "").casefold() != FILE_TYPE:
        raise location.error(
            "is an ENVI image, not a spectral library", HINT, code="not-an-atlas"
        )
    try:
        values = _values(fields, data)
        names = _items(fields, "spectra names") or [
            str(number) for number in range(1, len(values) + 1)
        ]
        centers = list(map(parse_float, _items(fields, "wavelength")))
        if values.shape != (len(names), len(centers)):
            counts = f"names: {len(names)}, wavelengths: {len(centers)}"
            raise ValueError(f"values of {values.shape}, {counts}")
    except ValueError as error:
        problem = f"the header does not describe the file {data.name}: {error}"
        raise location.error(problem, HINT) from None
    unit = one_line(fields.get("wavelength units"))
    is_stated = unit.lower() not in UNSPECIFIED
    nm = to_nm(
        centers, stated_unit(unit, location) if is_stated else unit_by_values(centers)
    )
    if IGNORED in fields:
        ignored = parse_number(fields[IGNORED], location, IGNORED)
        values[np.isclose(values, ignored, rtol=1e-6, atol=0)] = np.nan
    texts = [", ".join(_items(fields, key)) for key in TEXTS]
    scales = tuple(filter(None, map(remark_scale, texts)))
    quantity = remark_quantity(texts)
    if FACTOR in fields:
        factor = parse_number(fields[FACTOR], location, FACTOR)
        check_scale(factor, FACTOR, location)
        scales = (Scale(factor, f"{FACTOR} = {fields[FACTOR]}"),)
        quantity = Quantity(REFLECTANCE, FACTOR)
    return Measurements(
        tuple(Spectrum(name, nm, row) for name, row in zip(names, values, strict=True)),
        scales=scales,
        notes=(f"layout: {data.name} with its header",),
        quantity=quantity,
    )


def _fields(header: Document) -> dict[str, str]:
    """Return the fields of a header by their names in lower case. A value in braces may
    have several lines.
    """
    fields = dict(DEFAULTS)
    lines = iter([line for line in header.lines if not line.startswith(";")])
    for line in lines:
        key, _, value = line.partition("=")
        parts = [value.strip()]
        while parts[0].startswith("{") and not parts[-1].endswith("}"):
            parts.append(next(lines, "}").strip())
        fields[key.strip().lower()] = " ".join(parts)
    return fields


def _items(fields: dict[str, str], key: str) -> list[str]:
    """Return the items of a field in braces."""
    text = fields.get(key, "").strip("{} ")
    return list(map(one_line, text.split(","))) if text else []


def _values(fields: dict[str, str], data: Document) -> Array:
    """Return the values, a row per spectrum. Raise `ValueError` for numbers that are
    not as the header states them.
    """
    for key, known in CHOICES.items():
        if fields[key] not in known:
            listing = ", ".join(known)
            raise ValueError(f"{key} must be one of {listing}, got '{fields[key]}'")
    dtype = np.dtype(BYTE_ORDERS[fields["byte order"]] + TYPES[fields["data type"]])
    # Samples are wavelengths, lines are spectra.
    keys = ("header offset", "lines", "samples")
    offset, lines, samples = [parse_whole(fields[key]) for key in keys]
    size = lines * samples * dtype.itemsize
    if offset < 0 or lines < 1 or samples < 1 or offset + size > len(data.data):
        raise ValueError(f"{lines} × {samples} values from byte {offset} on")
    content = data.data[offset : offset + size]
    return np.frombuffer(content, dtype).reshape(lines, samples).astype(float)


def _pair(document: Document) -> tuple[Document, Document]:
    """Return header and data. Raise `AtlasError` if one is missing, too large or not a
    file.
    """
    path = Path(document.path)
    is_header = _is_header(document)
    suffixes = SUFFIXES if is_header else (HEADER, HEADER.upper(), path.suffix + HEADER)
    candidates = [path.with_suffix(suffix) for suffix in suffixes]
    for candidate in candidates:
        if candidate.is_file() and candidate != path:
            other = read_document(candidate)
            if is_header:
                return document, other
            if _is_header(other):
                return other, document
            raise other.location.error(
                "is not an ENVI header", HINT, code="not-an-atlas"
            )
    raise document.location.error(
        f"an ENVI library has two files, and {candidates[0].name} is missing",
        f"put {candidates[0].name} next to it",
        code="file-not-found",
    )


def _is_header(document: Document) -> bool:
    return document.data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(MAGIC)
