"""PNG, TIFF and Radiance HDR files byte by byte, with any statements about their
colours.
"""

import struct
import zlib

import numpy as np
from PIL.TiffImagePlugin import ImageFileDirectory_v2

SIGNATURE = b"\x89PNG\r\n\x1a\n"
COLOUR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}
"""Colour types of PNG by the number of channels."""
BT2020 = (0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290)
"""x, y of red, green, blue and white."""


def png_chunk(kind, data):
    """A chunk with its length and checksum."""
    return (
        struct.pack(">I", len(data))
        + kind
        + data
        + struct.pack(">I", zlib.crc32(kind + data))
    )


def gama(value):
    """The chunk gAMA."""
    return png_chunk(b"gAMA", struct.pack(">I", round(1e5 * value)))


def chrm(numbers):
    """The chunk cHRM of x, y of red, green, blue and white."""
    *primaries, x, y = (round(1e5 * number) for number in numbers)
    return png_chunk(b"cHRM", struct.pack(">8I", x, y, *primaries))


def cicp(*points):
    """The chunk cICP."""
    return png_chunk(b"cICP", bytes(points))


def iccp(profile):
    """The chunk iCCP."""
    return png_chunk(b"iCCP", b"name\0\0" + zlib.compress(profile))


SRGB = png_chunk(b"sRGB", b"\0")


def png_bytes(codes, *chunks, after=b""):
    """A PNG file of codes (h, w, channels), uint8 or uint16, with chunks before its
    pixels.
    """
    height, width, channels = codes.shape
    depth = 8 * codes.dtype.itemsize
    head = struct.pack(
        ">IIBBBBB", width, height, depth, COLOUR_TYPES[channels], 0, 0, 0
    )
    rows = codes.astype(codes.dtype.newbyteorder(">"))
    data = b"".join(b"\0" + row.tobytes() for row in rows)
    parts = (
        png_chunk(b"IHDR", head),
        *chunks,
        png_chunk(b"IDAT", zlib.compress(data)),
        after,
        png_chunk(b"IEND", b""),
    )
    return SIGNATURE + b"".join(parts)


EXIF = 0x8769
INTEROPERABILITY = 0xA005


def tiff_bytes(codes, tags, order="<", exif=None, interoperability=None):
    """A TIFF file of codes (h, w, channels), or directories alone without; ``tags`` are
    type and values by number.
    """
    mark = b"II" if order == "<" else b"MM"
    body = mark + struct.pack(order + "HI", 42, 0)
    tags = dict(tags)
    pixels = b""
    if interoperability is not None:
        body, place = _with_directory(body, interoperability, mark)
        exif = (exif or {}) | {INTEROPERABILITY: (4, [place])}
    if exif is not None:
        body, place = _with_directory(body, exif, mark)
        tags[EXIF] = (4, [place])
    if codes is not None:
        height, width, channels = codes.shape
        pixels = codes.astype(codes.dtype.newbyteorder(order)).tobytes()
        tags |= {
            256: (4, [width]),
            257: (4, [height]),
            258: (3, [8 * codes.dtype.itemsize] * channels),
            259: (3, [1]),
            262: (3, [2 if channels > 2 else 1]),
            273: (4, [0]),  # from the end of the directory
            277: (3, [channels]),
            278: (4, [height]),
            279: (4, [len(pixels)]),
            339: (3, [3 if codes.dtype.kind == "f" else 1] * channels),
        }
    body, place = _with_directory(body, tags, mark)
    return body[:4] + struct.pack(order + "I", place) + body[8:] + pixels


def _with_directory(body, tags, mark):
    """Append the directory of tags, and return its offset, too."""
    directory = ImageFileDirectory_v2(prefix=mark)
    for tag, (kind, values) in tags.items():
        directory.tagtype[tag] = kind
        directory[tag] = values.rstrip(b"\0") if kind == 2 else values
    body += b"\0" * (len(body) % 2)
    return body + directory.tobytes(len(body)), len(body)


def hdr_bytes(mantissas, exponent, header=""):
    """A Radiance HDR file of mantissas (h, w, 3), uint8, with one exponent: m / 256 ·
    2^(exponent − 128).
    """
    height, width, _ = mantissas.shape
    head = f"#?RADIANCE\n{header}FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    exponents = np.full((height, width, 1), exponent, np.uint8)
    return head.encode() + np.concatenate([mantissas, exponents], axis=-1).tobytes()
