"""OpenEXR files written a band of rows at a time, part by part; whole or not at all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.errors import OutputError, TextureError
from uplift.common.files import atomic_write
from uplift.io.texture.source import Values, Window, open_image


@dataclass(frozen=True)
class Layout:
    """A part to be written: ``kinds`` are the channels' types, ``header`` its attributes."""

    name: str
    window: Window
    channels: tuple[str, ...]
    kinds: tuple[str, ...]
    header: Mapping[str, Any]
    date: str

    def spec(self) -> Any:
        """An `OpenImageIO.ImageSpec`."""
        import OpenImageIO

        window = self.window
        spec = OpenImageIO.ImageSpec(window.width, window.height, len(self.channels), self.kinds[0])
        spec.channelnames = self.channels
        if len(set(self.kinds)) > 1:
            spec.channelformats = tuple(map(OpenImageIO.TypeDesc, self.kinds))
        spec.x, spec.y = window.x, window.y
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = window.display
        spec.attribute("PixelAspectRatio", window.aspect)
        spec.attribute("compression", "zip")
        spec.attribute("DateTime", self.date)  # or it would be now, and no file the same twice
        if self.name:
            spec.attribute("oiio:subimagename", self.name)
        for name, value in self.header.items():
            if isinstance(value, tuple):
                spec.attribute(name, f"float[{len(value)}]", value)
            else:
                spec.attribute(name, value)
        return spec


class Writer:
    """Rows in order, from the first of the first part to the last of the last."""

    def __init__(self, path: Path, layouts: Sequence[Layout]) -> None:
        import OpenImageIO

        self._path, self._specs = path, [layout.spec() for layout in layouts]
        handle = OpenImageIO.ImageOutput.create("openexr")
        if handle is None:
            raise OSError(OpenImageIO.geterror())
        self._handle = handle
        several = len(self._specs) > 1
        self._check(self._handle.open(os.fspath(path), tuple(self._specs) if several else self._specs[0]))

    def part(self, number: int) -> None:
        """Go on to a part."""
        if number:
            spec = self._specs[number]
            self._check(self._handle.open(os.fspath(self._path), spec, "AppendSubimage"))

    def rows(self, first: int, values: Values) -> None:
        """Rows (k, width, channels) from row ``first``. Raises `OSError`."""
        self._check(self._handle.write_scanlines(first, first + len(values), 0, np.ascontiguousarray(values)))

    def close(self) -> None:
        self._check(self._handle.close())

    def give_up(self) -> None:
        """Close what is not whole, whatever becomes of it."""
        self._handle.close()
        self._handle.geterror()  # or it is said when the process ends

    def _check(self, well: bool) -> None:
        if not well:
            raise OSError(" ".join(self._handle.geterror().split()))


@contextlib.contextmanager
def open_writer(
    path: str | os.PathLike[str], layouts: Sequence[Layout], *, force: bool = False
) -> Iterator[Writer]:
    """A writer; the file takes its name when all rows are there. Raises `OutputError`."""
    with atomic_write(path, force=force) as temporary:
        writer = Writer(temporary, layouts)
        try:
            yield writer
        except BaseException:
            writer.give_up()
            raise
        writer.close()
        # Where the last bytes meet a full disk, nothing else tells.
        if not is_complete(temporary):
            raise OutputError("was not written whole", path=path, hint="make room on the disk")


def is_complete(path: Path) -> bool:
    """Whether the last rows of all parts can be read."""
    try:
        with open_image(path) as image:
            for part in image.parts:
                image.last(part)
    except TextureError:
        return False
    return True
