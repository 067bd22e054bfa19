"""OpenEXR files written part by part, a band of rows at a time, and atomically."""

import contextlib
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath, Values
from uplift.common.errors import OutputError, TextureError
from uplift.common.files import atomic_write
from uplift.extras.images import exr_file
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import (
    Attribute,
    Window,
    open_image,
    read_error,
    utf8_name,
)

ROWS_PER_CHUNK = 16
"""Rows that OpenEXR compresses together as ZIP."""
MIN_BAND_BYTES = 1 << 24
"""Size of a band to write, as floats, for few processors, which compress it."""
MAX_BAND_BYTES = 1 << 27
"""Largest size, for more processors."""
COMPRESSION = "zip:1"
"""ZIP at its lowest level: the same pixels in files a few per cent larger, compressed
in 2/3 of the time.
"""
LARGEST_HALF = np.float32(65504)
TOO_BRIGHT = "pixels-too-bright"
CLAMPED = "brighter than half floats can store: clamped; use 32-bit channels"
SPACE_MARGIN = 2
"""Factor by which the rest of an image may compress better than the rows written so
far.
"""


@dataclass(frozen=True)
class OutputPart:
    """A part to write: its channels with their types, its header attributes and its
    date.
    """

    name: str
    window: Window
    channels: tuple[str, ...]
    types: tuple[str, ...]
    header: Mapping[str, Any]
    date: str

    @property
    def rows_per_band(self) -> int:
        """Rows to convert and write at a time: chunks of at most `MAX_BAND_BYTES`, at
        least one.
        """
        chunk = self.window.width * len(self.channels) * 4 * ROWS_PER_CHUNK
        wanted = max(MIN_BAND_BYTES // chunk, os.cpu_count() or 1)
        return max(min(wanted, MAX_BAND_BYTES // chunk), 1) * ROWS_PER_CHUNK

    def spec(self) -> Any:
        """Return the `OpenImageIO.ImageSpec`."""
        import OpenImageIO

        window = self.window
        spec = OpenImageIO.ImageSpec(
            window.width, window.height, len(self.channels), self.types[0]
        )
        spec.channelnames = self.channels
        if len(set(self.types)) > 1:
            spec.channelformats = tuple(map(OpenImageIO.TypeDesc, self.types))
        spec.x = window.x
        spec.y = window.y
        spec.full_x, spec.full_y, spec.full_width, spec.full_height = window.display
        spec.attribute("PixelAspectRatio", window.aspect)
        spec.attribute("compression", COMPRESSION)
        # the default is now, which makes every file different
        spec.attribute("DateTime", self.date)
        if self.name:
            spec.attribute("oiio:subimagename", self.name)
        for name, value in self.header.items():
            if isinstance(value, Attribute):
                spec.attribute(name, value.type, value.value)
            elif isinstance(value, tuple):
                spec.attribute(name, f"float[{len(value)}]", value)
            else:
                spec.attribute(name, value)
        return spec


class Writer:
    """Writer of rows in order, from the first row of the first part to the last row of
    the last.
    """

    def __init__(self, path: Path, parts: Sequence[OutputPart]) -> None:
        import OpenImageIO

        self._path = path
        self._specs = [part.spec() for part in parts]
        self._specs[0].attribute(exr_file.CHECKSUM, exr_file.NO_CHECKSUM)
        self._total = sum(
            part.window.height * part.window.width * len(part.channels)
            for part in parts
        )
        self._written = 0
        self._parts = parts
        self._part = parts[0]
        specs = tuple(self._specs) if len(self._specs) > 1 else self._specs[0]
        rows = max(part.rows_per_band for part in parts)
        with _compression_threads(rows // ROWS_PER_CHUNK):
            # takes the number of threads
            self._handle: Any = OpenImageIO.ImageOutput.create("openexr")
            if self._handle is None:
                raise OSError(read_error(OpenImageIO))
            self._check(self._handle.open(utf8_name(path, OutputError), specs))

    def start_part(self, number: int) -> None:
        """Start a part."""
        self._part = self._parts[number]
        if number:
            path = os.fspath(self._path)
            spec = self._specs[number]
            self._check(self._handle.open(path, spec, "AppendSubimage"))

    def write_rows(self, first: int, values: Values) -> Counts:
        """Write rows (k, width, channels) from row ``first``, counted from 0.

        In place of numbers that half floats cannot hold the largest ones are written,
        and counted; infinity stays. Raises `OSError`, and `OutputError` as
        `_check_space`.
        """
        is_half = np.array(self._part.types) == "half"
        is_over = np.zeros(values.shape, dtype=bool)
        if not np.abs(values).max() <= LARGEST_HALF:
            is_over = is_half & np.isfinite(values) & (np.abs(values) > LARGEST_HALF)
            values = np.where(is_over, np.copysign(LARGEST_HALF, values), values)
        # OpenImageIO would convert floats to half floats in another array.
        rows = values.astype(np.float16) if is_half.all() else values
        start = self._part.window.y + first
        self._check(self._handle.write_scanlines(start, start + len(rows), 0, rows))
        self._written += values.size
        self._check_space()
        return Counts.of(TOO_BRIGHT, is_over.any(axis=-1).sum(), CLAMPED)

    def close(self) -> None:
        """Finish the file, check that all of it is there, and add its checksum. Raises
        `OSError` and `OutputError`.
        """
        self._check(self._handle.close())
        self._handle = None  # closed only now, if the image is an environment map
        self._check_end()
        exr_file.seal(self._path)

    def abort(self) -> None:
        """Close an incomplete file and ignore errors."""
        if self._handle is not None:
            self._handle.close()
            read_error(self._handle)  # otherwise it is printed when the process ends

    def _check_end(self) -> None:
        """Raise `OutputError` if the last rows cannot be read: a disk that fills up
        with them gives no other sign.
        """
        try:
            with open_image(self._path) as image:
                for part in image.parts:
                    image.rows(part, part.window.height - 1, 1)
        except TextureError as error:
            raise OutputError(
                "the file is incomplete", hint="free space on the disk"
            ) from error

    def _check_space(self) -> None:
        """Raise `OutputError` at the first rows if the rest of the image will not fit
        on the disk.
        """
        size = self._path.stat().st_size
        remaining = size * (self._total - self._written) / self._written
        free = shutil.disk_usage(self._path.parent).free
        if remaining / SPACE_MARGIN > free:
            raise OutputError(
                f"the file needs about {(size + remaining) / 1e9:.2g} GB, and "
                f"{(size + free) / 1e9:.2g} GB are free",
                code="not-enough-space",
                hint="free space on the disk, or write fewer wavelengths or half "
                "floats",
            )

    def _check(self, ok: bool) -> None:
        if not ok:
            raise OSError(read_error(self._handle))


@contextlib.contextmanager
def _compression_threads(chunks: int) -> Iterator[None]:
    """Open files with no more buffers than ``chunks`` that are written at once need:
    OpenEXR has two per thread.

    The buffers of an image of 16384 columns at 81 wavelengths take 88 MB each.
    """
    import OpenImageIO

    name = "exr_threads"
    before = OpenImageIO.get_int_attribute(name)
    most = before if before > 0 else os.cpu_count() or 1
    OpenImageIO.attribute(name, min(most, chunks))
    try:
        yield
    finally:
        OpenImageIO.attribute(name, before)


@contextlib.contextmanager
def open_writer(
    path: StrPath, parts: Sequence[OutputPart], *, force: bool = False
) -> Iterator[Writer]:
    """Open a writer. The file appears under its name once all rows are written. Raises
    `OutputError`, also before anything is written for more channels than OpenImageIO
    reads.
    """
    count = sum(len(part.channels) for part in parts)
    if count > exr_file.MAX_CHANNELS:
        raise OutputError(
            f"an image must have at most {exr_file.MAX_CHANNELS} channels, got {count}",
            code="too-many-channels",
            path=path,
            hint="write fewer wavelengths",
        )
    with atomic_write(path, force=force) as temporary:
        writer = Writer(temporary, parts)
        try:
            yield writer
            writer.close()
        except BaseException as error:
            writer.abort()
            if isinstance(error, OutputError):
                error.path = path if error.path is None else error.path
            raise
