"""Structure of PNG files, checked before OpenImageIO reads them, as libpng prints its
own errors; and their colours.

Reference: "Portable Network Graphics (PNG) Specification", World Wide Web Consortium,
https://www.w3.org/TR/png-3/.
"""

import struct
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from uplift.extras.texture.exr_file import damaged, read_exactly

SIGNATURE = b"\x89PNG\r\n\x1a\n"
NECESSARY = (b"IHDR", b"PLTE", b"IDAT", b"IEND")
"""Types of the chunks without which an image cannot be decoded."""
PIXELS = (b"PLTE", b"IDAT")
"""Types of the chunks before which a file states its colours."""
STATEMENT_BYTES = 64
"""Bytes of a chunk that are kept, more than the numbers of colours have."""
UNITS = 100_000
"""Numbers of gAMA and cHRM that are 1."""
BLOCK = 1 << 24
"""Bytes read at a time."""


def read_chunks(path: Path) -> dict[str, Any]:
    """Return the colour statements of a file: ``cICP``, ``iCCP``, ``sRGB``, ``gAMA``
    and ``cHRM``, if it has them.

    Those of cHRM are x, y of red, green, blue and white. OpenImageIO has the profile,
    but not the others. Numbers of another size than theirs are NaN, which no colours
    have.

    Raises `TextureError` for a file that is truncated, or whose chunks differ from
    their checksums.
    """
    chunks = dict[bytes, bytes]()
    with path.open("rb") as file:
        kind = file.read(len(SIGNATURE))
        is_before_pixels = True
        while kind != NECESSARY[-1]:
            length, kind = struct.unpack(">I4s", read_exactly(file, 8, "PNG"))
            crc = zlib.crc32(kind)
            start = b""
            while length:
                block = read_exactly(file, min(length, BLOCK), "PNG")
                start = start or block[:STATEMENT_BYTES]
                crc = zlib.crc32(block, crc)
                length -= len(block)
            is_unknown = kind[:1].isupper() and kind not in NECESSARY
            if struct.pack(">I", crc) != read_exactly(file, 4, "PNG") or is_unknown:
                raise damaged("PNG")
            is_before_pixels &= kind not in PIXELS
            if is_before_pixels:
                chunks.setdefault(kind, start)
    return _statements(chunks)


def _statements(chunks: Mapping[bytes, bytes]) -> dict[str, Any]:
    stated = dict[str, Any]()
    if b"gAMA" in chunks:
        (stated["gAMA"],) = _fixed(chunks[b"gAMA"], 1)
    if b"cHRM" in chunks:
        white_x, white_y, *primaries = _fixed(chunks[b"cHRM"], 8)
        stated["cHRM"] = (*primaries, white_x, white_y)
    if b"cICP" in chunks:
        stated["cICP"] = tuple(chunks[b"cICP"])
    for name in ("sRGB", "iCCP"):
        if name.encode() in chunks:
            stated[name] = True
    return stated


def _fixed(data: bytes, count: int) -> tuple[float, ...]:
    """Return numbers in units of 1e-5."""
    if len(data) != 4 * count:
        return (float("nan"),) * count
    return tuple(number / UNITS for number in struct.unpack(f">{count}I", data))
