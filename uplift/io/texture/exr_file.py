"""Structure of OpenEXR files, read without their pixels: attributes, chunks, and a checksum of the file.

References
----------
"OpenEXR File Layout", Academy Software Foundation, https://openexr.com/en/latest/OpenEXRFileLayout.html.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from uplift.common.errors import TextureError

MAGIC = b"\x76\x2f\x31\x01"
MULTI_PART = 0x1000
"""Bit of the version field."""
MAX_CHANNELS = 1024
"""Channels of all parts together."""
MAX_ATTRIBUTES = 8192
"""Attributes of all parts together. OpenImageIO takes a second for them, and four for twice as many."""
CHANNEL_BYTES = 16
"""Size of a channel in a list of channels, after its name."""
MAX_NAME = 255
CHECKSUM = "uplift.checksum"
"""Name of the attribute with the CRC-32 of the file, taken with zeros in its place."""
NO_CHECKSUM = "00000000"
CHECKSUM_BLOCK = 1 << 24
"""Bytes read at a time."""


@dataclass(frozen=True)
class Attribute:
    """An attribute of a header: the index of its part, its name, its type, and where its value lies in the file."""

    part: int
    name: bytes
    type: bytes
    offset: int
    size: int


def is_exr(path: Path) -> bool:
    """Return whether a file starts like an OpenEXR file."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def check_size(path: Path) -> None:
    """Raise `TextureError` for headers that would take libraries minutes to read.

    Raises
    ------
    TextureError
        The header is damaged (code ``damaged-image``), or has too many channels (``too-many-channels``) or
        attributes (``too-many-attributes``).
    """
    with path.open("rb") as file:
        if sum(_channel_count(file, each) for each in attributes(file)) > MAX_CHANNELS:
            raise TextureError(
                f"an image must have at most {MAX_CHANNELS} channels",
                code="too-many-channels",
                hint="write the channels to several files",
            )


def attributes(file: BinaryIO) -> Iterator[Attribute]:
    """Yield the attributes of all parts, and leave the position at the end of the headers.

    Raises `TextureError` (codes ``damaged-image`` and ``too-many-attributes``).
    """
    end = os.fstat(file.fileno()).st_size
    start = file.read(8)
    if len(start) < 8 or start[:4] != MAGIC:
        raise _damaged()
    is_multi_part = bool(int.from_bytes(start[4:], "little") & MULTI_PART)
    part, first, count = 0, True, 0
    while True:
        name = _name(file)
        if not name:  # the end of a header, and after the last header of several another one
            if first or not is_multi_part:
                return
            part, first = part + 1, True
            continue
        first, count = False, count + 1
        if count > MAX_ATTRIBUTES:
            raise TextureError(
                f"an image must have at most {MAX_ATTRIBUTES} attributes",
                code="too-many-attributes",
                hint="remove some of them",
            )
        kind = _name(file)
        (size,) = struct.unpack("<i", _read(file, 4))
        offset = file.tell()
        if not 0 <= size <= end - offset:
            raise _damaged()
        file.seek(size, os.SEEK_CUR)
        yield Attribute(part, name, kind, offset, size)


def check_chunks(path: Path, heights: list[int], rows_per_chunk: int) -> None:
    """Check that all chunks of a file are there: parts of scan lines, written in order.

    Parameters
    ----------
    path : Path
        The file.
    heights : list of int
        Rows of every part.
    rows_per_chunk : int
        Rows of a chunk.

    Raises
    ------
    TextureError
        The file ends early, or a chunk is missing (code ``damaged-image``).
    """
    counts = [-(-height // rows_per_chunk) for height in heights]
    has_part_number = len(heights) > 1
    head = "<iii" if has_part_number else "<ii"
    with path.open("rb") as file:
        for _ in attributes(file):
            pass
        offsets = struct.unpack(f"<{sum(counts)}Q", _read(file, 8 * sum(counts)))
        expected, end = file.tell(), os.fstat(file.fileno()).st_size
        for offset in offsets:
            if offset != expected:
                raise _damaged()
            file.seek(offset)
            *_, size = struct.unpack(head, _read(file, struct.calcsize(head)))
            expected = offset + struct.calcsize(head) + size
        if expected != end:
            raise _damaged()


def seal(path: Path) -> None:
    """Store the checksum of a file in its attribute `CHECKSUM`, which must be `NO_CHECKSUM`."""
    with path.open("rb+") as file:
        place = _checksum_place(file)
        if place is None:
            raise _damaged()
        file.seek(place)
        file.write(f"{_crc(file, place):08x}".encode())


def is_intact(path: Path) -> bool:
    """Return whether a file has a checksum and agrees with it. All of the file is read."""
    try:
        with path.open("rb") as file:
            place = _checksum_place(file)
            if place is None:
                return False
            file.seek(place)
            stored = file.read(len(NO_CHECKSUM))
            return stored == f"{_crc(file, place):08x}".encode()
    except (OSError, TextureError):
        return False


def _channel_count(file: BinaryIO, attribute: Attribute) -> int:
    """Return the number of channels in a list of channels, or more than `MAX_CHANNELS`; 0 for other attributes."""
    if attribute.type != b"chlist":
        return 0
    position, count = file.tell(), 0
    file.seek(attribute.offset)
    while count <= MAX_CHANNELS and file.tell() < attribute.offset + attribute.size and _name(file):
        file.seek(CHANNEL_BYTES, os.SEEK_CUR)
        count += 1
    file.seek(position)
    return count


def _checksum_place(file: BinaryIO) -> int | None:
    """Return the offset of the checksum, None if the file has none."""
    found = [each for each in attributes(file) if each.name == CHECKSUM.encode()]
    return found[0].offset if found and found[0].size == len(NO_CHECKSUM) else None


def _crc(file: BinaryIO, place: int) -> int:
    """Return the CRC-32 of a file with `NO_CHECKSUM` at ``place``, and leave the position at ``place``."""
    file.seek(0)
    crc = zlib.crc32(file.read(place))
    crc = zlib.crc32(NO_CHECKSUM.encode(), crc)
    file.seek(place + len(NO_CHECKSUM))
    buffer = bytearray(CHECKSUM_BLOCK)
    while size := file.readinto(buffer):  # type: ignore[attr-defined]
        crc = zlib.crc32(memoryview(buffer)[:size], crc)
    file.seek(place)
    return crc


def _name(file: BinaryIO) -> bytes:
    """Read a text that ends with a zero byte."""
    start = file.tell()
    text, zero, _ = file.read(MAX_NAME + 1).partition(b"\0")
    if not zero:
        raise _damaged()
    file.seek(start + len(text) + 1)
    return text


def _read(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) < size:
        raise _damaged()
    return data


def _damaged() -> TextureError:
    return TextureError("the OpenEXR file is damaged or incomplete", code="damaged-image", hint="write the file again")
