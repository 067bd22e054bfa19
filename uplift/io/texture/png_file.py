"""Structure of PNG files, checked before OpenImageIO reads them: libpng prints its own errors.

Reference: "Portable Network Graphics (PNG) Specification", World Wide Web Consortium, https://www.w3.org/TR/png-3/.
"""

import struct
import zlib
from pathlib import Path
from typing import BinaryIO

from uplift.common.errors import TextureError

SIGNATURE = b"\x89PNG\r\n\x1a\n"
NECESSARY = (b"IHDR", b"PLTE", b"IDAT", b"IEND")
"""Types of the chunks without which an image cannot be decoded."""
BLOCK = 1 << 24
"""Bytes read at a time."""


def check_chunks(path: Path) -> None:
    """Raise `TextureError` for a file that is truncated, or whose chunks differ from their checksums."""
    with path.open("rb") as file:
        kind = file.read(len(SIGNATURE))
        while kind != NECESSARY[-1]:
            length, kind = struct.unpack(">I4s", _read(file, 8))
            crc = zlib.crc32(kind)
            while length:
                block = _read(file, min(length, BLOCK))
                crc = zlib.crc32(block, crc)
                length -= len(block)
            is_unknown = kind[:1].isupper() and kind not in NECESSARY
            if struct.pack(">I", crc) != _read(file, 4) or is_unknown:
                raise _damaged()


def _read(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) < size:
        raise _damaged()
    return data


def _damaged() -> TextureError:
    return TextureError("the PNG file is damaged or incomplete", code="file-unreadable", hint="write the file again")
