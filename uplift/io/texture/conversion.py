"""Conversion of one image, a band of rows at a time, so that memory does not grow with its height."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.errors import UpliftWarning
from uplift.common.files import check_output
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.io.texture.colours import Counts
from uplift.io.texture.converter import Converter
from uplift.io.texture.part_layout import PartLayout, part_layouts
from uplift.io.texture.source import Image, Values, open_image
from uplift.io.texture.source_space import source_space, space_warnings
from uplift.io.texture.writer import Writer, open_writer


@dataclass(frozen=True)
class Conversion:
    """Outcome of the conversion of an image.

    Parameters
    ----------
    source, target : Path
        The image read and the file written.
    counts : Counts
        Numbers of pixels by kind.
    warnings : tuple of UpliftWarning
        Warnings about the image. They are data: `convert` does not emit them, as it may run in another process.
    seconds : float
        Wall-clock time.
    spaces : tuple of str
        RGB spaces that colours were converted from; empty if they were in the space of the cube.
    """

    source: Path
    target: Path
    counts: Counts
    warnings: tuple[UpliftWarning, ...]
    seconds: float
    spaces: tuple[str, ...] = ()


def convert(
    converter: Converter,
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    force: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Conversion:
    """Convert the colours of an image and write the result as OpenEXR, atomically.

    Channels that are not colours pass through, parts and windows stay. Colours that the file holds multiplied by alpha
    are divided by it before the conversion and multiplied after.

    Parameters
    ----------
    converter : Converter
        An `Uplifter`, or a coat of paint (`uplift.design.mixing.overpaint`).
    source : path-like
        OpenEXR, Radiance HDR, PNG, JPEG or TIFF image.
    target : path-like
        OpenEXR file to write.
    force : bool
        Whether to replace an existing file.
    progress : callable
        Receives a `Progress` of stage ``rows`` after every band.

    Returns
    -------
    Conversion
        Counts, warnings and time.

    Raises
    ------
    TextureError
        The image cannot be read, or has no colour channels.
    OutputError
        ``target`` cannot be written, exists and ``force`` is off, or is ``source``.
    OptionError
        The image has encoded floats, and the gamut mapping is neither ``clip`` nor ``error``.
    ColourError
        A colour lies outside [0, 1] and the gamut mapping is ``error``, or the cube, built for a scene, lacks
        the nodes for it.
    """
    begin = time.perf_counter()
    check_output(target, inputs=[source], force=force)
    with open_image(source) as image, converter.opened(image) as converter:
        layouts = part_layouts(converter, image)
        with open_writer(target, [each.output for each in layouts], force=force) as writer:
            counts = _write_parts(converter, image, layouts, writer, progress)
        notes = space_warnings(image, converter.sensor, converter.space)
        spaces = _converted_from(converter, layouts)
    warnings = (*counts.warnings(converter.out_of_gamut, source), *notes)
    return Conversion(Path(source), Path(target), counts, warnings, time.perf_counter() - begin, spaces)


def _write_parts(
    converter: Converter,
    image: Image,
    layouts: list[PartLayout],
    writer: Writer,
    progress: ProgressCallback,
) -> Counts:
    counts, done = Counts(), 0
    total = sum(layout.part.window.height for layout in layouts)
    for layout in layouts:
        writer.start_part(layout.part.number)
        for first, band in _bands(image, layout):
            ready = converter if layout.colours is None else converter.at_rows(layout.part, first, len(band))
            counts, done = counts + _write_band(ready, layout, writer, first, band), done + len(band)
            progress(Progress("rows", done, total))
    return counts


def _converted_from(converter: Converter, layouts: list[PartLayout]) -> tuple[str, ...]:
    """Return the names of the spaces that differ from that of the cube."""
    parts = (layout.part for layout in layouts if layout.colours is not None)
    spaces = (source_space(part, converter.sensor, converter.space) for part in parts)
    return tuple(dict.fromkeys(space.name for space in spaces if space is not None))


def _bands(image: Image, layout: PartLayout) -> Iterator[tuple[int, Values]]:
    """Yield bands to write, with the number of their first row."""
    step = layout.output.rows_per_band
    for first, band in image.bands(layout.part):
        for start in range(0, len(band), step):
            yield first + start, band[start : start + step]


def _write_band(converter: Converter, layout: PartLayout, writer: Writer, first: int, band: Values) -> Counts:
    """Convert and write a band. Its arrays are gone before those of the next, which halves the memory."""
    values, counts = _convert_band(converter, layout, band)
    writer.write_rows(first, values)
    return counts


def _convert_band(converter: Converter, layout: PartLayout, band: Values) -> tuple[Values, Counts]:
    """Return the channels (k, width, N) to write, and counts of unusual pixels."""
    others = band[..., layout.others]
    if layout.part.max_code:
        others = others / np.float32(layout.part.max_code)
    if layout.colours is None:
        return others, Counts()
    rgb, decoded = layout.decoder(layout.colours.straight(band))
    values, converted = converter.convert(rgb)
    if (opacity := layout.colours.opacity(band)) is not None:
        values = converter.multiply(values, opacity)
    # OpenImageIO would convert floats to half floats in another array.
    is_half = set(layout.output.types) == {"half"}
    dtype = np.float16 if is_half else np.result_type(np.float32, others)
    return np.concatenate([*values, others], axis=-1, dtype=dtype), decoded + converted
