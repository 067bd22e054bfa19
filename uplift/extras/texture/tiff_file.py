"""Colour tags of TIFF and JPEG files, which OpenImageIO does not give.

References: "TIFF Revision 6.0", Adobe 1992, section 20; "Exchangeable image file format
for digital still cameras: Exif Version 2.32", CIPA DC-008, sections 4.6.5 and 4.6.7.
"""

import io
import struct
from pathlib import Path
from typing import Any, BinaryIO

TAGS = {
    301: "TransferFunction",
    318: "WhitePoint",
    319: "PrimaryChromaticities",
    0xA001: "ColorSpace",
}
"""Names of the tags that are read."""
EXIF = 0x8769
"""Tag with the offset of the directory of EXIF."""
INTEROPERABILITY = 0xA005
"""Tag with the offset of the directory of interoperability."""
INDEX = 1
"""Tag of the interoperability index in its directory."""
NUMBERS = {1: "B", 3: "H", 4: "I", 5: "II", 11: "f", 12: "d", 13: "I", 16: "Q"}
"""Formats of the types of numbers."""
TEXT = 2
MAX_BYTES = 6 << 16
"""Bytes of the largest value that is read: three transfer functions of 16-bit images.
"""
MAX_ENTRIES = 4096
"""Entries of a directory that are read."""
JPEG = b"\xff\xd8"
EXIF_START = b"Exif\0\0"


def read_tags(path: Path) -> dict[str, Any]:
    """Return the colour tags of a file by name. Damaged ones are missing, as
    OpenImageIO ignores them, too.
    """
    with path.open("rb") as file:
        try:
            if file.read(2) != JPEG:
                return _tags(file)
            exif = _find_exif(file)
            return {} if exif is None else _tags(io.BytesIO(exif))
        except (struct.error, KeyError, TypeError, ValueError, OSError):
            return {}


def _find_exif(file: BinaryIO) -> bytes | None:
    """Return the EXIF data of a JPEG file, which are a TIFF file, after its first two
    bytes.
    """
    while True:
        mark, kind, length = struct.unpack(">BBH", file.read(4))
        is_header = mark == 0xFF and 0xC0 <= kind != 0xDA
        if not is_header or length < 2:
            return None
        data = file.read(length - 2)
        if kind == 0xE1 and data.startswith(EXIF_START):
            return data.removeprefix(EXIF_START)


def _tags(file: BinaryIO) -> dict[str, Any]:
    """Return the tags of the first directory, and of its directories of EXIF."""
    file.seek(0)
    order = {b"II": "<", b"MM": ">"}[file.read(2)]
    (version,) = struct.unpack(order + "H", file.read(2))
    is_big = version == 43
    if is_big:
        file.read(4)
    offset = _unpack(file, order + ("Q" if is_big else "I"))[0]
    first = _directory(file, order, offset, is_big)
    exif = _subdirectory(file, order, first, EXIF, is_big)
    interoperability = _subdirectory(file, order, exif, INTEROPERABILITY, is_big)
    tags = {TAGS[tag]: value for tag, value in (first | exif).items() if tag in TAGS}
    if "ColorSpace" in tags:
        tags["ColorSpace"] = tags["ColorSpace"][0]
    if INDEX in interoperability:
        tags["InteroperabilityIndex"] = interoperability[INDEX]
    return tags


def _subdirectory(
    file: BinaryIO, order: str, parent: dict[int, Any], tag: int, is_big: bool
) -> dict[int, Any]:
    return _directory(file, order, parent[tag][0], is_big) if tag in parent else {}


def _directory(file: BinaryIO, order: str, offset: int, is_big: bool) -> dict[int, Any]:
    """Return the values of a directory by tag: numbers, or a text."""
    file.seek(offset)
    (count,) = _unpack(file, order + ("Q" if is_big else "H"))
    entry = order + ("HHQ8s" if is_big else "HHI4s")
    data = file.read(min(count, MAX_ENTRIES) * struct.calcsize(entry))
    wanted = {*TAGS, EXIF, INTEROPERABILITY, INDEX}
    values = dict[int, Any]()
    for tag, kind, length, value in struct.iter_unpack(entry, data):
        is_readable = kind == TEXT if tag == INDEX else kind in NUMBERS
        if tag in wanted and is_readable:
            values[tag] = _value(file, order, kind, length, value)
    return {tag: value for tag, value in values.items() if value}


def _value(file: BinaryIO, order: str, kind: int, length: int, value: bytes) -> Any:
    """Return the value of an entry, which stands in the entry or at the offset that the
    entry has; empty if damaged.
    """
    form = NUMBERS.get(kind, "s")
    size = length * struct.calcsize("=" + form)
    if size > MAX_BYTES:
        return ()
    if size > len(value):
        file.seek(struct.unpack(order + ("Q" if len(value) == 8 else "I"), value)[0])
        value = file.read(size)
    if len(value) < size:
        return ()
    if kind == TEXT:
        return value[:length].partition(b"\0")[0].decode("ascii", "replace")
    numbers = struct.unpack(order + form * length, value[:size])
    if kind != 5:
        return numbers
    pairs = zip(numbers[::2], numbers[1::2], strict=True)
    return tuple(above / below if below else float("nan") for above, below in pairs)


def _unpack(file: BinaryIO, form: str) -> tuple[Any, ...]:
    return struct.unpack(form, file.read(struct.calcsize(form)))
