"""Structure of OpenEXR files, read without their pixels: limits of the headers, and a
checksum of the file.

Reference: "OpenEXR File Layout", Academy Software Foundation,
https://openexr.com/en/latest/OpenEXRFileLayout.html.
"""

import os
import struct
import zlib
from pathlib import Path
from typing import BinaryIO

from uplift.common.errors import TextureError

MAGIC = b"\x76\x2f\x31\x01"
MULTI_PART = 0x1000
"""Bit of the version field."""
MAX_CHANNELS = 1024
"""Channels of all parts together."""
MAX_ATTRIBUTES = 8192
"""Attributes of all parts together. OpenImageIO takes a second for them, and four for
twice as many.
"""
CHANNEL_BYTES = 16
"""Size of a channel in a list of channels, after its name."""
MAX_NAME = 255
CHECKSUM = "uplift.checksum"
"""Name of the attribute with the CRC-32 of the file, taken with zeros in its place."""
NO_CHECKSUM = "00000000"
CHECKSUM_MARK = CHECKSUM.encode() + b"\0string\0" + struct.pack("<i", len(NO_CHECKSUM))
"""Bytes of the attribute before its value."""
BLOCK = 1 << 24
"""Bytes read at a time, more than a header of `uplift texture` has."""


def is_exr(path: Path) -> bool:
    """Return whether a file starts like an OpenEXR file."""
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def check_size(path: Path) -> None:
    """Raise `TextureError` for damaged headers, and for those that would take libraries
    minutes to read.
    """
    with path.open("rb") as file:
        end = os.fstat(file.fileno()).st_size
        start = _read_exactly(file, 8)
        if start[:4] != MAGIC:
            raise damaged()
        is_multi_part = bool(int.from_bytes(start[4:], "little") & MULTI_PART)
        is_first = True
        attributes = 0
        channels = 0
        # Headers of attributes: name, type, size, value. An empty name ends a header,
        # and another one the last header of several.
        while (name := _name(file)) or (is_multi_part and not is_first):
            is_first = not name
            if is_first:
                continue
            attributes += 1
            kind = _name(file)
            (size,) = struct.unpack("<i", _read_exactly(file, 4))
            value = file.tell()
            if not 0 <= size <= end - value:
                raise damaged()
            if kind == b"chlist":
                channels += _count_channels(file, value + size, MAX_CHANNELS - channels)
            file.seek(value + size)
            if attributes > MAX_ATTRIBUTES or channels > MAX_CHANNELS:
                problem = (
                    f"an image must have at most {MAX_CHANNELS} channels and "
                    f"{MAX_ATTRIBUTES} attributes"
                )
                raise TextureError(
                    problem,
                    hint="write the channels to several files, or remove attributes",
                )


def _count_channels(file: BinaryIO, end: int, most: int) -> int:
    """Number of channels of a list up to ``end``; ``most`` + 1 if it has more."""
    channels = 0
    while channels <= most and file.tell() < end and _name(file):
        file.seek(CHANNEL_BYTES, os.SEEK_CUR)
        channels += 1
    return channels


def seal(path: Path) -> None:
    """Store the checksum of a file in its attribute `CHECKSUM`, which must be
    `NO_CHECKSUM`.
    """
    with path.open("rb+") as file:
        place = _checksum_place(file)
        crc = _crc(file, place)
        file.seek(place)
        file.write(crc)


def is_intact(path: Path) -> bool:
    """Return whether a file has a checksum and agrees with it. All of the
    file is read.
    """
    try:
        with path.open("rb") as file:
            place = _checksum_place(file)
            file.seek(place)
            return file.read(len(NO_CHECKSUM)) == _crc(file, place)
    except (OSError, TextureError):
        return False


def _checksum_place(file: BinaryIO) -> int:
    """Return the offset of the checksum, which lies in the first header. Raises
    `TextureError` if there is none.
    """
    head = file.read(BLOCK)
    place = head.find(CHECKSUM_MARK)
    if not head.startswith(MAGIC) or place < 0:
        raise damaged()
    return place + len(CHECKSUM_MARK)


def _crc(file: BinaryIO, place: int) -> bytes:
    """Return the CRC-32 of a file with `NO_CHECKSUM` at ``place``, in hexadecimal."""
    file.seek(0)
    crc = zlib.crc32(file.read(place))
    crc = zlib.crc32(NO_CHECKSUM.encode(), crc)
    file.seek(place + len(NO_CHECKSUM))
    while block := file.read(BLOCK):
        crc = zlib.crc32(block, crc)
    return f"{crc:08x}".encode()


def _name(file: BinaryIO) -> bytes:
    """Read a text that ends with a zero byte."""
    start = file.tell()
    text, zero, _ = file.read(MAX_NAME + 1).partition(b"\0")
    if not zero:
        raise damaged()
    file.seek(start + len(text) + 1)
    return text


def _read_exactly(file: BinaryIO, size: int) -> bytes:
    """Read bytes. Raises `TextureError` at the end of the file."""
    data = file.read(size)
    if len(data) < size:
        raise damaged()
    return data


def damaged(name: str = "OpenEXR") -> TextureError:
    """The error for a file of this format."""
    return TextureError(
        f"the {name} file is damaged or incomplete",
        code="file-unreadable",
        hint="write the file again",
    )
