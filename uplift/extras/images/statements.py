"""Statements of image files about their colours that OpenImageIO does not report, read
before it opens a file.

References: "Portable Network Graphics (PNG) Specification", W3C,
https://www.w3.org/TR/png-3/; "TIFF Revision 6.0", Adobe 1992, section 20; "Exif Version
2.32", CIPA DC-008, sections 4.6.5 and 4.6.7; G. Ward, "Radiance File Formats",
https://radsite.lbl.gov/radiance/refer/filefmts.pdf.
"""

import contextlib
import io
import mmap
import struct
import warnings
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, BinaryIO

from uplift.extras.images import exr_file

PNG = b"\x89PNG\r\n\x1a\n"
HDR = b"#?"
JPEG = b"\xff\xd8"
TIFF = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
SIGNATURES = (exr_file.MAGIC, PNG, HDR, JPEG, *TIFF)
"""First bytes of the formats."""
PNG_PIXELS = (b"PLTE", b"IDAT")
"""Types of the chunks before which a PNG file states its colours."""
PNG_UNITS = 100_000
"""Numbers of gAMA and cHRM that are 1."""
MAX_HDR_HEADER = 1 << 16
PRIMARIES = b"PRIMARIES="
TAGS = {
    301: "TransferFunction",
    318: "WhitePoint",
    319: "PrimaryChromaticities",
    0xA001: "ColorSpace",
}
"""Names of the tags of TIFF and EXIF that are read."""
EXIF = 0x8769
"""Tag with the offset of the directory of EXIF."""
INTEROPERABILITY = 0xA005
"""Tag with the offset of the directory of interoperability."""
INDEX = 1
"""Tag of the interoperability index in its directory."""
BIG_TIFF = 43
"""Version in the header of files with 64-bit offsets."""


def read_statements(path: Path, start: bytes) -> Mapping[str, Any]:
    """Read the statements of a file that begins with ``start``, by name.

    Raises `TextureError` for OpenEXR files with too many channels, and for PNG files
    that are truncated or differ from their checksums, as libpng prints its own errors.
    """
    if start.startswith(exr_file.MAGIC):
        exr_file.check_size(path)
        return {}
    if start.startswith(PNG):
        return _png_statements(_png_chunks(path))
    if start.startswith(HDR):
        return _hdr_primaries(path)
    # Damaged tags are missing, as OpenImageIO ignores them, too.
    damaged = (struct.error, KeyError, TypeError, ValueError, OSError, SyntaxError)
    with contextlib.suppress(*damaged), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if start.startswith(JPEG):
            return _tags(io.BytesIO(_jpeg_exif(path)))
        with path.open("rb") as file:
            return _tags(file)
    return {}


def _png_chunks(path: Path) -> dict[bytes, bytes]:
    """Return the chunks before the pixels by type, and check all of them."""
    chunks = dict[bytes, bytes]()
    is_before_pixels = True
    place = len(PNG)
    kind = b""
    with (
        path.open("rb") as file,
        mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data,
        memoryview(data) as view,
    ):
        while kind != b"IEND":
            try:
                length, kind = struct.unpack_from(">I4s", view, place)
                (stored,) = struct.unpack_from(">I", view, place + 8 + length)
            except struct.error:
                raise exr_file.damaged("PNG") from None
            with view[place + 4 : place + 8 + length] as chunk:
                if zlib.crc32(chunk) != stored:
                    raise exr_file.damaged("PNG")
                is_before_pixels &= kind not in PNG_PIXELS
                if is_before_pixels:
                    chunks.setdefault(kind, bytes(chunk[4:]))
            place += 12 + length
    return chunks


def _png_statements(chunks: Mapping[bytes, bytes]) -> dict[str, Any]:
    """Return ``cICP``, ``gAMA``, ``cHRM`` as x, y of red, green, blue and white,
    ``sRGB`` and ``iCCP``. Numbers of another size than theirs are NaN, which no colours
    have.
    """
    stated: dict[str, Any] = {
        name: True for name in ("sRGB", "iCCP") if name.encode() in chunks
    }
    if b"cICP" in chunks:
        stated["cICP"] = tuple(chunks[b"cICP"])
    if b"gAMA" in chunks:
        (stated["gAMA"],) = _png_numbers(chunks[b"gAMA"], 1)
    if b"cHRM" in chunks:
        white_x, white_y, *primaries = _png_numbers(chunks[b"cHRM"], 8)
        stated["cHRM"] = (*primaries, white_x, white_y)
    return stated


def _png_numbers(data: bytes, count: int) -> tuple[float, ...]:
    if len(data) != 4 * count:
        return (float("nan"),) * count
    return tuple(number / PNG_UNITS for number in struct.unpack(f">{count}I", data))


def _hdr_primaries(path: Path) -> dict[str, Any]:
    """Return ``PRIMARIES``, words that should be x, y of red, green, blue and white."""
    with path.open("rb") as file:
        header, _, _ = file.read(MAX_HDR_HEADER).partition(b"\n\n")
    stated = dict[str, Any]()
    for line in header.splitlines():
        if line.startswith(PRIMARIES):
            stated["PRIMARIES"] = tuple(line.removeprefix(PRIMARIES).split())
    return stated


def _jpeg_exif(path: Path) -> bytes:
    """Return the EXIF data of a JPEG file, which are a TIFF file."""
    from PIL.JpegImagePlugin import JpegImageFile

    with JpegImageFile(path) as image:
        exif: bytes = image.info["exif"]
    return exif.removeprefix(b"Exif\0\0")


def _tags(file: BinaryIO) -> dict[str, Any]:
    """Return the tags of the first directory, and of its directories of EXIF."""
    from PIL.TiffImagePlugin import ImageFileDirectory_v2

    head = file.read(8)
    if head[2] == BIG_TIFF:
        head += file.read(8)

    def read(offset: int | None) -> Mapping[int, Any]:
        directory = ImageFileDirectory_v2(head)
        if offset is not None:
            file.seek(offset)
            directory.load(file)
        return directory

    first = read(ImageFileDirectory_v2(head).next)
    exif = read(first.get(EXIF))
    index = read(exif.get(INTEROPERABILITY)).get(INDEX)
    tags = dict[str, Any]()
    for directory in (first, exif):
        tags |= {name: directory[tag] for tag, name in TAGS.items() if tag in directory}
    return tags if index is None else tags | {"InteroperabilityIndex": index}
