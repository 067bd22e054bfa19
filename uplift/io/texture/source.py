"""Images as they lie in files: parts, channels, and rows a band at a time (OpenEXR, PNG, JPEG, TIFF).

OpenImageIO reads them all; what a band holds is what the file holds, not converted.
"""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import TextureError
from uplift.io.texture.colour_profile import Profile, profile_of

FORMATS = ("openexr", "png", "jpeg", "tiff")
BAND = 1 << 25
"""Bytes that a band is read in, if the file's own blocks of rows are no larger."""
WHOLE = 2**32 - 1
"""OpenImageIO takes 32-bit whole numbers to [0, 1] by this."""
EXACT = 1 << 24
"""Whole numbers up to this pass through its 32-bit floats."""
REMEDY = "name an EXR, PNG, JPEG or TIFF image"

Values = NDArray[Any]


@dataclass(frozen=True)
class Window:
    """Where the pixels of a part lie, and the display window (x, y, width, height) that they are part of."""

    x: int
    y: int
    width: int
    height: int
    display: tuple[int, int, int, int]
    aspect: float


@dataclass(frozen=True)
class Part:
    """One part of a file; all but OpenEXR have one.

    ``kinds`` are the channels' types: half, float, uint, uint8, uint16. ``block`` is how many rows are decoded
    together. ``profile`` is what the file says its RGB are of, if it does; ``date`` likewise.
    """

    number: int
    name: str
    window: Window
    channels: tuple[str, ...]
    kinds: tuple[str, ...]
    block: int
    tiled: bool
    profile: Profile | None
    date: str | None

    @property
    def codes(self) -> int:
        """Of a part of 8-bit or 16-bit whole numbers, the largest; 0 for all others."""
        kinds = set(self.kinds)
        return {"uint8": 255, "uint16": 65535}.get(kinds.pop(), 0) if len(kinds) == 1 else 0


@dataclass(frozen=True, eq=False)
class Image:
    """An open file."""

    path: Path
    parts: tuple[Part, ...]
    handle: Any

    def bands(self, part: Part) -> Iterator[tuple[int, Values]]:
        """First row, and rows (k, width, channels): whole numbers as they are if all are, else floats."""
        window = part.window
        self.handle.seek_subimage(part.number, 0)
        row = window.width * len(part.channels) * 4
        step = part.block * max(1, BAND // (row * part.block))
        for first in range(window.y, window.y + window.height, step):
            yield first, self._band(part, first, min(first + step, window.y + window.height))

    def text(self, name: str) -> str:
        """A text of the first part's header, empty where there is none."""
        return str(self.handle.spec(0).get_string_attribute(name))

    def remarks(self, sensor: Sensor) -> tuple[str, ...]:
        """One for each space that it names that is not the sensor's."""
        told = []
        for part in self.parts:
            if part.profile is not None and (what := part.profile.unlike(sensor, codes=bool(part.codes))):
                name = f" ({part.profile.name})" if part.profile.name else ""
                told.append(f"the image names {what}{name}; its colours are taken for {sensor.space}")
        return tuple(dict.fromkeys(told))

    def last(self, part: Part) -> Values:
        """The last row (1, width, channels). Raises `TextureError` where it is missing."""
        self.handle.seek_subimage(part.number, 0)
        end = part.window.y + part.window.height
        start = end - 1 - (part.window.height - 1) % part.block if part.tiled else end - 1
        return self._band(part, start, end)[-1:]

    def _band(self, part: Part, first: int, end: int) -> Values:
        if part.codes:
            return self._read(part, first, end, part.kinds[0])
        whole = [index for index, kind in enumerate(part.kinds) if kind == "uint"]
        values = self._read(part, first, end, "double" if whole else "float")
        for index in whole:
            numbers = self._read(part, first, end, "uint", index)[..., 0]
            if numbers.max(initial=0) > EXACT:
                problem = f"channel '{part.channels[index]}' holds whole numbers beyond {EXACT}"
                raise TextureError(problem, path=self.path, hint="leave that channel out")
            values[..., index] = numbers / WHOLE
        return values

    def _read(self, part: Part, first: int, end: int, kind: str, channel: int | None = None) -> Values:
        import OpenImageIO

        window = part.window
        channels = (0, len(part.channels)) if channel is None else (channel, channel + 1)
        if part.tiled:
            across = (window.x, window.x + window.width)
            found = self.handle.read_tiles(*across, first, end, 0, 1, *channels, OpenImageIO.TypeDesc(kind))
        else:
            found = self.handle.read_scanlines(first, end, 0, *channels, OpenImageIO.TypeDesc(kind))
        problem = self.handle.geterror()  # of a JPEG that ends early this is the only sign
        if found is None or problem:
            raise TextureError(
                f"rows {first} to {end - 1} cannot be read: {_tidy(problem)}",
                path=self.path,
                hint="the file is damaged: make it anew",
            )
        return np.asarray(found)


@contextlib.contextmanager
def open_image(path: str | os.PathLike[str]) -> Iterator[Image]:
    """The image in a file. Raises `TextureError` where there is none that can be used."""
    import OpenImageIO

    path, wishes = Path(path), OpenImageIO.ImageSpec()
    wishes["oiio:UnassociatedAlpha"] = 1  # colours as they stand, not multiplied by alpha
    if not path.is_file():
        raise TextureError("there is no such file", path=path, hint=REMEDY)
    handle = OpenImageIO.ImageInput.open(os.fspath(path), wishes)
    if handle is None:
        raise TextureError(_tidy(OpenImageIO.geterror()), path=path, hint=REMEDY)
    try:
        if handle.format_name() not in FORMATS:
            problem = f"is a {handle.format_name()} image"
            raise TextureError(problem, path=path, hint="make it EXR, PNG, JPEG or TIFF")
        yield Image(path, tuple(_parts(handle, path)), handle)
    finally:
        handle.close()


def _parts(handle: Any, path: Path) -> Iterator[Part]:
    number = 0
    while handle.seek_subimage(number, 0):
        yield _part(handle.spec(), number, path)
        number += 1
        if handle.format_name() != "openexr":  # pages of a TIFF are other images
            return


def _part(spec: Any, number: int, path: Path) -> Part:
    if spec.deep or spec.depth > 1:
        raise TextureError("has depth", path=path, hint="flatten it: textures have one value a pixel")
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    display = (spec.full_x, spec.full_y, spec.full_width, spec.full_height)
    aspect = spec.get_float_attribute("PixelAspectRatio", 1.0)
    return Part(
        number=number,
        name=spec.get_string_attribute("oiio:subimagename"),
        window=Window(spec.x, spec.y, spec.width, spec.height, display, aspect),
        channels=tuple(spec.channelnames),
        kinds=tuple(map(str, formats)),
        block=spec.tile_height or max(spec.get_int_attribute("oiio:RowsPerChunk", 1), 1),
        tiled=bool(spec.tile_width),
        profile=profile_of(spec),
        date=spec.get_string_attribute("DateTime") or None,
    )


def _tidy(message: str) -> str:
    """One line."""
    return " ".join(message.split()) or "it is no image that can be read"
