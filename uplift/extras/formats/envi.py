"""Reader of ENVI spectral libraries: a header (``.hdr``) and numbers (``.sli``)."""

import math
from pathlib import Path

import numpy as np

from uplift.atlas import (
    Document,
    SourceLocation,
    check_scale,
    one_line,
    parse_number,
    read_document,
)
from uplift.common.arrays import Array
from uplift.common.text import parse_whole, pluralise
from uplift.extras.formats.measurements import Measurements
from uplift.extras.formats.samples import Spectrum
from uplift.extras.formats.statements import (
    Quantity,
    Scale,
    remark_quantity,
    remark_scale,
    stated_unit,
    to_nm,
    unit_by_values,
)

HEADER = ".hdr"
SUFFIXES = ("", ".sli", ".SLI", ".img", ".dat", ".bin", ".lib", ".esl")
"""Suffixes of files of numbers."""
MAGIC = b"ENVI"
FILE_TYPE = "envi spectral library"
TYPES = {
    "1": "u1", "2": "i2", "3": "i4", "4": "f4", "5": "f8",
    "12": "u2", "13": "u4", "14": "i8", "15": "u8",
}  # fmt: skip
"""Types of numbers by the field ``data type``."""
BYTE_ORDERS = {"0": "<", "1": ">"}
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
    centers = [
        parse_number(text, location, "a wavelength")
        for text in _items(fields, "wavelength")
    ]
    values = _values(fields, location, data)
    numbers = range(1, len(values) + 1)
    names = _items(fields, "spectra names") or list(map(str, numbers))
    if values.shape != (len(names), len(centers)):
        problem = (
            f"the header has {pluralise(len(names), 'name')} and "
            f"{pluralise(len(centers), 'wavelength')} for {values.shape} values"
        )
        raise location.error(problem, HINT)
    if IGNORED in fields:
        ignored = parse_number(fields[IGNORED], location, IGNORED)
        values[np.isclose(values, ignored, rtol=1e-6, atol=0)] = np.nan
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
    texts = [", ".join(_items(fields, key)) for key in TEXTS]
    return Measurements(
        spectra,
        scales=_scales(fields, location)
        or tuple(filter(None, map(remark_scale, texts))),
        notes=(f"layout: {data.name} with its header",),
        quantity=Quantity("reflectance", FACTOR)
        if FACTOR in fields
        else remark_quantity(texts),
    )


def _fields(header: Document) -> dict[str, str]:
    """Return the fields of a header by their names in lower case. A value in braces may
    have several lines.
    """
    fields = dict[str, str]()
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


def _values(fields: dict[str, str], location: SourceLocation, data: Document) -> Array:
    """Return the values, a row per spectrum. Raise `AtlasError` for numbers that are
    not as the header states them.
    """
    kind = TYPES.get(fields.get("data type", ""))
    order = BYTE_ORDERS.get(fields.get("byte order", "0"))
    if not (kind and order) or fields.get("bands", "1") != "1":
        problem = (
            f"data type must be one of {', '.join(TYPES)}, byte order 0 or 1, and the "
            "number of bands 1"
        )
        raise location.error(problem, HINT)
    try:
        # Samples are wavelengths, lines are spectra.
        shape = [parse_whole(fields[key]) for key in ("lines", "samples")]
        offset = parse_whole(fields.get("header offset", "0"))
        values = np.frombuffer(data.data, order + kind, math.prod(shape), offset)
        return values.reshape(shape).astype(float)
    except (KeyError, ValueError) as error:
        problem = f"the header does not describe the file {data.name}: {error}"
        raise location.error(problem, HINT) from None


def _scales(fields: dict[str, str], location: SourceLocation) -> tuple[Scale, ...]:
    """Return the scale that a header states."""
    if FACTOR not in fields:
        return ()
    number = parse_number(fields[FACTOR], location, FACTOR)
    factor = check_scale(number, FACTOR, location)
    return (Scale(factor, f"{FACTOR} = {fields[FACTOR]}"),)


def _pair(document: Document) -> tuple[Document, Document]:
    """Return header and data. Raise `AtlasError` if one is missing, too large or not a
    file.
    """
    path = Path(document.path)
    is_header = _is_header(document)
    others = SUFFIXES if is_header else (HEADER, HEADER.upper(), path.suffix + HEADER)
    candidates = [path.with_suffix(suffix) for suffix in others]
    existing = [file for file in candidates if file.is_file() and file != path]
    if not existing:
        name = path.with_suffix(".sli" if is_header else HEADER).name
        raise document.location.error(
            f"an ENVI library has two files, and {name} is missing",
            f"put {name} next to it",
            code="file-not-found",
        )
    paired = read_document(existing[0])
    if is_header:
        return document, paired
    if not _is_header(paired):
        raise paired.location.error("is not an ENVI header", HINT, code="not-an-atlas")
    return paired, document


def _is_header(document: Document) -> bool:
    return document.data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(MAGIC)
