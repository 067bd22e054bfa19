"""OpenEXR files byte by byte, for headers that no library writes."""

import struct
from collections.abc import Sequence

WIDTH = 5
HEIGHT = 4


def attribute(name: bytes, kind: bytes, value: bytes) -> bytes:
    """An attribute of a header."""
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value


def exr_bytes(
    channels: Sequence[bytes] = (b"B", b"G", b"R"),
    extra: bytes = b"",
    size: tuple[int, int] = (WIDTH, HEIGHT),
) -> bytes:
    """An image of half-float zeros, uncompressed, with further attributes; its pixels
    end after `HEIGHT` rows.
    """
    width, height = size
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    half = struct.pack("<iBBBBii", 1, 0, 0, 0, 0, 1, 1)
    header = struct.pack("<ii", 20000630, 2 | 0x400) + b"".join(
        (
            attribute(
                b"channels",
                b"chlist",
                b"".join(name + b"\0" + half for name in channels) + b"\0",
            ),
            attribute(b"compression", b"compression", b"\0"),
            attribute(b"dataWindow", b"box2i", box),
            attribute(b"displayWindow", b"box2i", box),
            attribute(b"lineOrder", b"lineOrder", b"\0"),
            attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
            attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
            attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)),
            extra,
            b"\0",
        )
    )
    rows = min(height, HEIGHT)
    row = 2 * len(channels) * min(width, WIDTH)
    start = len(header) + 8 * rows
    offsets = b"".join(struct.pack("<Q", start + y * (8 + row)) for y in range(rows))
    return (
        header
        + offsets
        + b"".join(struct.pack("<ii", y, row) + bytes(row) for y in range(rows))
    )
