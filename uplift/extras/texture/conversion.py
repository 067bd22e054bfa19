"""Conversion of one image, a band of rows at a time, so that memory does not grow with
its height.
"""

import os
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.arrays import StrPath, Values
from uplift.common.errors import TextureError, UpliftWarning
from uplift.common.files import check_output, file_digest
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.images.channels import ColourChannels, colour_channels_by_part
from uplift.extras.images.converter import Band, Converter, ImageConverter
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, Part, open_image
from uplift.extras.images.reader import ReadColours
from uplift.extras.images.writer import OutputPart, Writer, open_writer

SOURCE = "uplift.source"
"""Attribute with the size and the SHA-256 digest of the image that a texture was made
of.
"""
LOSSLESS = {"half": "half", "uint": "uint", "uint8": "half"}
"""OpenEXR types that hold all values of a type, by that type; float for others.
Integers become [0, 1].
"""


@dataclass(frozen=True)
class Conversion:
    """Outcome of the conversion of an image.

    Parameters
    ----------
    source, target : Path
        The image read and the file written.
    counts : Counts
        Numbers of pixels, and of those that were changed.
    warnings : tuple of UpliftWarning
        Warnings about the image. They are data: `convert` does not emit them, as it may
        run in another process.
    seconds : float
        Wall-clock time.
    spaces : tuple of str
        RGB spaces in which colours were read, ``linear sRGB`` for floats of the cube's
        space.
    facts : tuple of str
        What was found out about the image, such as its exposure.
    """

    source: Path
    target: Path
    counts: Counts
    warnings: tuple[UpliftWarning, ...]
    seconds: float
    spaces: tuple[str, ...] = ()
    facts: tuple[str, ...] = ()


def convert(
    converter: Converter,
    source: StrPath,
    target: StrPath,
    *,
    also: Sequence[StrPath] = (),
    force: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Conversion:
    """Convert the colours of an image and write the result as OpenEXR, atomically.

    Channels that are not colours pass through, parts and windows stay. Colours that the
    file holds multiplied by alpha are divided by it before the conversion and
    multiplied after.

    Parameters
    ----------
    converter : Converter
        Made by `prepare`, `prepare_masked`, `prepare_lights`, `prepare_several_lights`
        or `uplift.extras.relight.relighter`, or a coat of paint
        (`uplift.extras.paint.overpainter`).
    source : path-like
        OpenEXR, Radiance HDR, PNG, JPEG or TIFF image.
    target : path-like
        OpenEXR file to write.
    also : sequence of path-like
        Further photographs of the image, for `prepare_several_lights`.
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
        The image has encoded floats, and the gamut mapping is neither ``clip`` nor
        ``error``.
    ColourError
        A colour lies outside [0, 1] and the gamut mapping is ``error``, or the cube,
        built for a scene, lacks the nodes for it.
    """
    begin = time.perf_counter()
    check_output(target, inputs=[source, *also], force=force)
    made_of = {SOURCE: source_stamp(source, *also)}
    further = [Path(path) for path in also]
    with open_image(source) as image, converter.open(image, further) as to_rows:
        layouts = [
            _layout(converter, to_rows, image, part, colours, made_of)
            for part, colours in colour_channels_by_part(image)
        ]
        outputs = [layout.output for layout in layouts]
        with open_writer(target, outputs, force=force) as writer:
            counts = _write(layouts, image, to_rows, writer, progress)
        warnings = (*counts.warnings(source), *converter.reader.warnings(image))
    coloured = [layout.part for layout in layouts if layout.colours]
    spaces = tuple(dict.fromkeys(map(converter.reader.space_name, coloured)))
    seconds = time.perf_counter() - begin
    return Conversion(
        Path(source), Path(target), counts, warnings, seconds, spaces, to_rows.facts
    )


def source_stamp(*sources: StrPath) -> str:
    """Return the attribute `SOURCE` of textures of an image, or of several photographs.
    Raises `TextureError`.
    """
    digests = [file_digest(source, TextureError) for source in sources]
    sizes = [os.stat(source).st_size for source in sources]
    stamps = zip(sizes, digests, strict=True)
    return ", ".join(f"{size} {digest}" for size, digest in stamps)


@dataclass(frozen=True, eq=False)
class _Layout:
    """Which channels of a part are colours, and how they are decoded; which pass
    through (indices ``others``), and how the part is written.
    """

    part: Part
    colours: ColourChannels | None
    others: tuple[int, ...]
    decode: ReadColours
    output: OutputPart


def _layout(
    converter: Converter,
    to_rows: ImageConverter,
    image: Image,
    part: Part,
    colours: ColourChannels | None,
    made_of: Mapping[str, str],
) -> _Layout:
    if colours is not None:
        colours = converter.reader.channels(colours)
    rgb = () if colours is None else colours.rgb
    others = tuple(index for index in range(len(part.channels)) if index not in rgb)
    names = tuple(part.channels[index] for index in others)
    types = tuple(LOSSLESS.get(part.types[index], "float") for index in others)
    if colours is not None:
        converted = (*"RGB", *converter.channels)
        if duplicates := set(converted) & set(names):
            raise TextureError(
                f"channel '{min(duplicates)}' exists next to the colour and would be "
                "written twice",
                hint="remove that channel",
            )
        names = (*converted, *names)
        types = (*(converter.depth,) * len(converted), *types)
    header = {**part.metadata, **converter.header, **to_rows.header(part), **made_of}
    output = OutputPart(part.name, part.window, names, types, header, image.date(part))
    return _Layout(part, colours, others, converter.reader.decoder(part), output)


def _write(
    layouts: Sequence[_Layout],
    image: Image,
    to_rows: ImageConverter,
    writer: Writer,
    progress: ProgressCallback,
) -> Counts:
    """Convert and write all bands of all parts."""
    total = sum(layout.part.window.height for layout in layouts)
    counts = Counts()
    done = 0
    for layout in layouts:
        writer.start_part(layout.part.number)
        for first, band in _bands(image, layout):
            counts += _write_band(layout, to_rows, writer, first, band)
            done += len(band)
            progress(Progress("rows", done, total))
    return counts


def _bands(image: Image, layout: _Layout) -> Iterator[tuple[int, Values]]:
    """Yield bands to write, with the number of their first row."""
    step = layout.output.rows_per_band
    for first, band in image.bands(layout.part):
        for start in range(0, len(band), step):
            yield first + start, band[start : start + step]


def _write_band(
    layout: _Layout, to_rows: ImageConverter, writer: Writer, first: int, band: Values
) -> Counts:
    """Convert and write a band. Its arrays are gone before those of the next, which
    halves the memory.
    """
    others = band[..., layout.others]
    counts = Counts()
    values: tuple[Values, ...] = ()
    if layout.part.max_code:
        others = others / np.float32(layout.part.max_code)
    if layout.colours is not None:
        rgb, decoded = layout.decode(layout.colours.straight(band))
        opacity = layout.colours.opacity(band)
        values, converted = to_rows.rows(Band(layout.part, first, rgb, opacity))
        counts = decoded + converted
    dtype = np.result_type(np.float32, others)
    rows = np.concatenate([*values, others], axis=-1, dtype=dtype)
    return counts + writer.write_rows(first, rows)
