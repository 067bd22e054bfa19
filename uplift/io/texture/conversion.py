"""One image: read, decoded, uplifted and written a band at a time, so that memory does not grow with it."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.errors import ColourError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.texture.colours import Counts, Floats
from uplift.io.texture.part_layout import PartLayout, part_layouts
from uplift.io.texture.source import Image, Values, open_image
from uplift.io.texture.uplifter import Uplifter
from uplift.io.texture.writer import Writer, open_writer

BAND = 1 << 27
"""Bytes of a band that is written at once."""
LINES = 16
"""Rows that OpenEXR compresses together."""

"""Told rows done, and rows in all."""


@dataclass(frozen=True)
class Conversion:
    """What became of an image: how many of its pixels were what, what should be said of them, seconds it took."""

    source: Path
    target: Path
    counts: Counts
    remarks: tuple[str, ...]
    seconds: float


def convert(
    uplifter: Uplifter,
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    force: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Conversion:
    """Write the texture of an image, atomically.

    Raises `TextureError`, `OutputError`, `OptionError` for encoded floats that should be moved, and `ColourError` for
    colours that a cube of a scene has no points for, or that lie outside [0, 1] where that is an error.
    """
    begin = time.perf_counter()
    with open_image(source) as image:
        planned = part_layouts(uplifter, image)
        try:
            with open_writer(target, [plan.layout for plan in planned], force=force) as writer:
                counts = _write(uplifter, image, planned, writer, progress)
        except ColourError as error:
            raise ColourError(error.problem, path=source, hint=error.hint) from error
    remarks = (*counts.remarks(uplifter.out_of_gamut), *image.remarks(uplifter.cube.data.sensor))
    return Conversion(Path(source), Path(target), counts, remarks, time.perf_counter() - begin)


def _write(
    uplifter: Uplifter, image: Image, planned: list[PartLayout], writer: Writer, progress: ProgressCallback
) -> Counts:
    counts, done = Counts(), 0
    total = sum(plan.part.window.height for plan in planned)
    for plan in planned:
        writer.part(plan.part.number)
        for first, band in _bands(image, plan):
            values, found = _made(uplifter, plan, band)
            writer.rows(first, values)
            counts, done = counts + found, done + len(band)
            progress(Progress("rows", done, total))
    return counts


def _bands(image: Image, plan: PartLayout) -> Iterator[tuple[int, Values]]:
    """Bands as they are read, cut so that what is made of them takes `BAND`."""
    row = plan.part.window.width * len(plan.layout.channels) * 4
    step = max(BAND // (row * LINES), 1) * LINES
    for first, band in image.bands(plan.part):
        for start in range(0, len(band), step):
            yield first + start, band[start : start + step]


def _made(uplifter: Uplifter, plan: PartLayout, band: Values) -> tuple[Values, Counts]:
    """Channels (k, width, N) of the texture, and what was wrong with the colours."""
    through = band[..., plan.rest]
    if plan.part.codes:
        through = through / np.float32(plan.part.codes)
    if plan.colours is None:
        return through, Counts()
    rgb, counts = plan.decoder(band[..., plan.colours])
    made = [rgb, uplifter.sample(rgb), through]
    return np.concatenate(made, axis=-1), counts + _missed(uplifter, rgb)


def _missed(uplifter: Uplifter, rgb: Floats) -> Counts:
    """How many colours their spectra may miss, for the reach of reflectances."""
    if uplifter.misses is None:
        return Counts()
    return Counts(missed=int((uplifter.misses(rgb) > uplifter.cube.data.threshold).sum()))
