"""Containers of textures in single precision: KTX 2 and DDS, which describe their content.

References
----------
Khronos Group, "KTX File Format Specification", version 2.0, and "Khronos Data Format Specification", version 1.3.
Microsoft, "Programming Guide for DDS" (structures ``DDS_HEADER`` and ``DDS_HEADER_DXT10``).
"""

from __future__ import annotations

import struct
from typing import Any

from numpy.typing import NDArray

RGBA32F = 109
"""``VK_FORMAT_R32G32B32A32_SFLOAT``."""
CHANNELS = (0, 1, 2, 15)
"""Red, green, blue and alpha in a data format descriptor."""
FLOAT = 0x80 | 0x40
"""Qualifiers of a channel: floating point, signed."""


def ktx2(texels: NDArray[Any], notes: dict[str, str]) -> bytes:
    """Encode a texture.

    Parameters
    ----------
    texels : ndarray, shape (H, W, 4) or (D, H, W, 4)
        A 2-D or 3-D texture.
    notes : mapping
        Text stored with it, by names in alphabetical order.

    Returns
    -------
    bytes
    """
    depth, height, width = (0, *texels.shape[:-1])[-3:]
    pixels = texels.astype("<f4").tobytes()
    channels = b"".join(
        struct.pack("<HBBIII", 32 * k, 31, channel | FLOAT, 0, 0xBF800000, 0x3F800000)
        for k, channel in enumerate(CHANNELS)
    )
    block = struct.pack("<IHHBBBBIQ", 0, 2, 24 + len(channels), 1, 1, 1, 0, 0, 16) + channels
    descriptor = struct.pack("<I", 4 + len(block)) + block
    values = b"".join(_padded(_note(key, text), 4) for key, text in notes.items())
    start = 104
    end = start + len(descriptor) + len(values)
    first = -(-end // 16) * 16
    header = struct.pack("<12s9I", b"\xabKTX 20\xbb\r\n\x1a\n", RGBA32F, 4, width, height, depth, 0, 1, 1, 0)
    index = struct.pack("<4I2Q", start, len(descriptor), start + len(descriptor) if values else 0, len(values), 0, 0)
    level = struct.pack("<3Q", first, len(pixels), len(pixels))
    return _padded(header + index + level + descriptor + values, 16) + pixels


def dds(texels: NDArray[Any]) -> bytes:
    """Encode a texture, (H, W, 4) or (D, H, W, 4)."""
    is_volume = texels.ndim == 4
    depth, height, width = (1, *texels.shape[:-1])[-3:]
    flags = 0x100F | (0x800000 if is_volume else 0)
    pixel_format = struct.pack("<2I4s5I", 32, 4, b"DX10", 0, 0, 0, 0, 0)
    capabilities = struct.pack("<5I", 0x1008 if is_volume else 0x1000, 0x200000 if is_volume else 0, 0, 0, 0)
    header = struct.pack("<7I44x", 124, flags, height, width, 16 * width, depth if is_volume else 0, 1)
    extension = struct.pack("<5I", 2, 4 if is_volume else 3, 0, 1, 0)
    return b"DDS " + header + pixel_format + capabilities + extension + texels.astype("<f4").tobytes()


def _note(key: str, text: str) -> bytes:
    pair = key.encode() + b"\0" + text.encode() + b"\0"
    return struct.pack("<I", len(pair)) + pair


def _padded(data: bytes, size: int) -> bytes:
    return data + bytes(-len(data) % size)
