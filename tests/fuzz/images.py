"""Fuzz target: images of all formats, mutated, converted to textures without a line from any library."""

from __future__ import annotations

import os
import struct
import tempfile
import zlib
from functools import cache
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image, ImageCms

from tests.fuzz.campaign import Target
from tests.fuzz.mutate import Random, choose, mutate
from tests.io.texture.exr_bytes import attribute, exr_bytes
from uplift.colorimetry.observer import sensor
from uplift.io.texture import Counts, convert
from uplift.io.texture.uplifter import Converter

SIZE = (6, 7)
MANY = (10, 1000, 1025, 9000, 100_000)
"""Numbers of channels and attributes."""


class _Same(Converter):
    """Conversion of each colour to itself."""

    def convert(self, rgb):  # type: ignore[no-untyped-def]
        return (rgb,), Counts()


@cache
def _converter() -> Converter:
    return _Same(sensor(), "half", "auto", "clip", (), {})


@cache
def _seeds() -> tuple[bytes, ...]:
    codes = np.random.default_rng(0).integers(0, 256, (*SIZE, 4), dtype=np.uint8)
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    images = []
    for kind, depth, options in (
        ("PNG", 4, {}),
        ("PNG", 3, {"icc_profile": profile}),
        ("JPEG", 3, {"icc_profile": profile}),
        ("TIFF", 3, {"compression": "tiff_deflate"}),
        ("TIFF", 4, {"compression": "raw"}),
    ):
        buffer = BytesIO()
        Image.fromarray(codes[..., :depth]).save(buffer, kind, **options)
        images.append(buffer.getvalue())
    text = attribute(b"owner", b"string", b"someone") + attribute(b"chromaticities", b"chromaticities", bytes(32))
    return (*images, exr_bytes(), exr_bytes([b"R", b"G", b"B", b"A", b"Z"], text))


def _many(random: Random) -> bytes:
    """An EXR file of many channels or attributes."""
    count = choose(random, MANY)
    names = [b"c%06d" % number for number in range(count)]
    if random.random() < 0.5:
        return exr_bytes([b"R", b"G", b"B", *names])
    return exr_bytes(extra=b"".join(attribute(name, b"int", bytes(4)) for name in names))


def _valid_chunks(content: bytes, random: Random) -> bytes:
    """Mutate a chunk of a PNG file and keep its length and its checksum valid, so that the decoder reads it."""
    chunks, position = [], 8
    while position < len(content):
        (size,) = struct.unpack(">I", content[position : position + 4])
        chunks.append((content[position + 4 : position + 8], content[position + 8 : position + 8 + size]))
        position += 12 + size
    place = int(random.integers(len(chunks)))
    name, data = chunks[place]
    chunks[place] = name, mutate(data, random, _seeds())
    parts = [
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks
    ]
    return content[:8] + b"".join(parts)


def _generate(random: Random, path: Path) -> None:
    seeds = _seeds()
    content = choose(random, seeds)
    draw = random.random()
    if draw < 0.01:
        content = _many(random)
    elif draw < 0.3:
        content = _valid_chunks(seeds[random.integers(2)], random)
    elif draw < 0.9:
        content = mutate(content, random, seeds)
    path.write_bytes(content)


def _use(path: Path) -> None:
    """Convert to a texture. Raises RuntimeError for anything on standard error."""
    with tempfile.TemporaryFile(dir=path.parent) as printed, tempfile.TemporaryDirectory(dir=path.parent) as out:
        saved = os.dup(2)
        os.dup2(printed.fileno(), 2)
        try:
            convert(_converter(), path, Path(out) / "out.exr")
        finally:
            os.dup2(saved, 2)
            os.close(saved)
            printed.seek(0)
            if text := printed.read():
                raise RuntimeError(f"a second line: {text[:80]!r}")


TARGETS = (Target("image", _generate, _use),)
