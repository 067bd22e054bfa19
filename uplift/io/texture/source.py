"""Image files as they are: parts, channels, and rows a band at a time (OpenEXR, PNG, JPEG, TIFF).

OpenImageIO reads all formats. Bands hold the numbers of the file, unconverted.
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
from uplift.common.errors import ColourError, TextureError, UpliftWarning
from uplift.io.texture.colour_profile import Profile, read_profile

FORMATS = ("openexr", "png", "jpeg", "tiff")
MAX_BAND_BYTES = 1 << 25
"""Size of a band to read, unless the file's own blocks of rows are larger."""
UINT32_SCALE = 2**32 - 1
"""OpenImageIO divides 32-bit integers by this number."""
MAX_EXACT_INTEGER = 1 << 24
"""Integers up to this number pass through 32-bit floats."""
FORMAT_HINT = "use an EXR, PNG, JPEG or TIFF image"

Values = NDArray[Any]


@dataclass(frozen=True)
class Window:
    """Data window of a part, its display window (x, y, width, height) and its pixel aspect ratio."""

    x: int
    y: int
    width: int
    height: int
    display: tuple[int, int, int, int]
    aspect: float


@dataclass(frozen=True)
class Part:
    """One part of a file. Files of formats other than OpenEXR have one part.

    Parameters
    ----------
    number : int
        Index of the part.
    name : str
        Name, empty if it has none.
    window : Window
        Data and display window.
    channels : tuple of str
        Names of the channels.
    types : tuple of str
        Types of the channels: half, float, uint, uint8 or uint16.
    rows_per_block : int
        Rows that are decoded together.
    is_tiled : bool
        Whether the part is stored in tiles.
    profile : Profile or None
        The colour space that the file states.
    date : str or None
        The date that the file states.
    """

    number: int
    name: str
    window: Window
    channels: tuple[str, ...]
    types: tuple[str, ...]
    rows_per_block: int
    is_tiled: bool
    profile: Profile | None
    date: str | None

    @property
    def max_code(self) -> int:
        """Largest value if all channels are 8-bit or all are 16-bit integers, else 0."""
        types = set(self.types)
        return {"uint8": 255, "uint16": 65535}.get(types.pop(), 0) if len(types) == 1 else 0


@dataclass(frozen=True, eq=False)
class Image:
    """An open image file."""

    path: Path
    parts: tuple[Part, ...]
    handle: Any

    def bands(self, part: Part) -> Iterator[tuple[int, Values]]:
        """Yield row numbers and rows (k, width, channels): integers if all channels are, else floats."""
        window = part.window
        self.handle.seek_subimage(part.number, 0)
        row = window.width * len(part.channels) * 4
        step = part.rows_per_block * max(1, MAX_BAND_BYTES // (row * part.rows_per_block))
        for first in range(window.y, window.y + window.height, step):
            yield first, self._band(part, first, min(first + step, window.y + window.height))

    def header_text(self, name: str) -> str:
        """Return a text attribute of the first part, empty if it is missing."""
        return str(self.handle.spec(0).get_string_attribute(name))

    def warnings(self, sensor: Sensor) -> tuple[UpliftWarning, ...]:
        """Return a warning for every colour space in the file that differs from the sensor's."""
        problems = []
        for part in self.parts:
            if part.profile is None:
                continue
            if mismatch := part.profile.mismatch(sensor, encoded=bool(part.max_code)):
                name = f" ({part.profile.name})" if part.profile.name else ""
                problems.append(f"the image states {mismatch}{name}; its colours are read as {sensor.space}")
        return tuple(
            UpliftWarning(problem, code="colour-space-mismatch", path=self.path)
            for problem in dict.fromkeys(problems)
        )

    def last_row(self, part: Part) -> Values:
        """Return the last row (1, width, channels). Raises `TextureError` if it is missing."""
        self.handle.seek_subimage(part.number, 0)
        end = part.window.y + part.window.height
        start = end - 1 - (part.window.height - 1) % part.rows_per_block if part.is_tiled else end - 1
        return self._band(part, start, end)[-1:]

    def _band(self, part: Part, first: int, end: int) -> Values:
        if part.max_code:
            return self._read(part, first, end, part.types[0])
        integers = [index for index, name in enumerate(part.types) if name == "uint"]
        values = self._read(part, first, end, "double" if integers else "float")
        for index in integers:
            numbers = self._read(part, first, end, "uint", index)[..., 0]
            if numbers.max(initial=0) > MAX_EXACT_INTEGER:
                raise TextureError(
                    f"integers must be at most {MAX_EXACT_INTEGER}, got {numbers.max()} in channel "
                    f"'{part.channels[index]}'",
                    code="integer-too-large",
                    hint="remove that channel",
                )
            values[..., index] = numbers / UINT32_SCALE
        return values

    def _read(self, part: Part, first: int, end: int, dtype: str, channel: int | None = None) -> Values:
        import OpenImageIO

        window, kind = part.window, OpenImageIO.TypeDesc(dtype)
        channels = (0, len(part.channels)) if channel is None else (channel, channel + 1)
        if part.is_tiled:
            columns = (window.x, window.x + window.width)
            rows = self.handle.read_tiles(*columns, first, end, 0, 1, *channels, kind)
        else:
            rows = self.handle.read_scanlines(first, end, 0, *channels, kind)
        problem = self.handle.geterror()  # the only sign of a truncated JPEG
        if rows is None or problem:
            raise TextureError(
                f"rows {first} to {end - 1} cannot be read: {_one_line(problem)}",
                code="damaged-image",
                hint="the file is damaged: write it again",
            )
        return np.asarray(rows)


@contextlib.contextmanager
def open_image(path: str | os.PathLike[str]) -> Iterator[Image]:
    """Open an image file. A `TextureError` or `ColourError` in the block without a path gets this one.

    Raises
    ------
    TextureError
        The file is missing, damaged, of another format, or has several values per pixel.
    """
    import OpenImageIO

    path, config = Path(path), OpenImageIO.ImageSpec()
    config["oiio:UnassociatedAlpha"] = 1  # keep colours as stored, not multiplied by alpha
    if not path.is_file():
        raise TextureError("no such file", code="file-not-found", path=path, hint=FORMAT_HINT)
    handle = OpenImageIO.ImageInput.open(os.fspath(path), config)
    if handle is None:
        problem = _one_line(OpenImageIO.geterror())
        raise TextureError(problem, code="unreadable-image", path=path, hint=FORMAT_HINT)
    try:
        yield Image(path, tuple(_parts(handle)), handle)
    except (TextureError, ColourError) as error:
        error.path = path if error.path is None else error.path
        raise
    finally:
        handle.close()


def _parts(handle: Any) -> Iterator[Part]:
    if handle.format_name() not in FORMATS:
        problem = f"unsupported image format {handle.format_name()}"
        raise TextureError(problem, code="unsupported-image-format", hint=FORMAT_HINT)
    number = 0
    while handle.seek_subimage(number, 0):
        yield _part(handle.spec(), number)
        number += 1
        if handle.format_name() != "openexr":  # pages of a TIFF are separate images
            return


def _part(spec: Any, number: int) -> Part:
    if spec.deep or spec.depth > 1:
        raise TextureError("an image must have one value per pixel", code="deep-image", hint="flatten it")
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    display = (spec.full_x, spec.full_y, spec.full_width, spec.full_height)
    aspect = spec.get_float_attribute("PixelAspectRatio", 1.0)
    return Part(
        number=number,
        name=spec.get_string_attribute("oiio:subimagename"),
        window=Window(spec.x, spec.y, spec.width, spec.height, display, aspect),
        channels=tuple(spec.channelnames),
        types=tuple(map(str, formats)),
        rows_per_block=spec.tile_height or max(spec.get_int_attribute("oiio:RowsPerChunk", 1), 1),
        is_tiled=bool(spec.tile_width),
        profile=read_profile(spec),
        date=spec.get_string_attribute("DateTime") or None,
    )


def _one_line(message: str) -> str:
    return " ".join(message.split()) or "the image cannot be read"
