"""Pictures of all passes, decoded to one scene-linear picture, a band of rows at a
time.
"""

import contextlib
import math
import os
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.common.arrays import Array, StrPath, Values
from uplift.common.errors import PassesError, UpliftWarning
from uplift.common.files import check_output
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, Part, open_image
from uplift.extras.images.writer import OutputPart, open_writer
from uplift.extras.scene.passes.bands import CHANNELS
from uplift.extras.scene.passes.decoder import LARGEST, Decoder
from uplift.extras.scene.passes.passes import Passes
from uplift.extras.scene.passes.textures import ATTRIBUTE, pass_mark

FLOATS = {"half", "float", "double"}
NUMBER = re.compile(r"\.(\d{1,2})(?=\.)")
"""Number of a pass in the name of a picture, such as ``room.2.exr``."""


@dataclass(frozen=True)
class Decoded:
    """Outcome of decoding.

    Parameters
    ----------
    target : Path
        The file written.
    counts : Counts
        Numbers of pixels by kind.
    warnings : tuple of UpliftWarning
        Warnings about the pictures, which are not emitted.
    """

    target: Path
    counts: Counts
    warnings: tuple[UpliftWarning, ...]


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture of a pass: its open file, the part with colours, and the indices of R,
    G and B, and of alpha, among its channels.
    """

    image: Image
    part: Part
    rgb: tuple[int, int, int]
    others: tuple[int, ...]


def decode_pictures(
    decoder: Decoder,
    sources: Sequence[StrPath],
    target: StrPath,
    *,
    depth: str = "float",
    force: bool = False,
    progress: ProgressCallback = ignore_progress,
) -> Decoded:
    """Decode the pictures of all passes to one OpenEXR file, atomically.

    Parameters
    ----------
    decoder : Decoder
        Made by `decoder`.
    sources : sequence of path-like
        OpenEXR pictures of the passes in their order, linear floats, of one size.
        Alpha and other channels of the first one are copied, ``Z`` next to XYZ as
        ``first.Z``.
    target : path-like
        OpenEXR file to write.
    depth : {"half", "float"}
        Type of the channels of colour.
    force : bool
        Whether to replace an existing file.
    progress : callable
        Receives a `Progress` of stage ``rows`` after every band.

    Returns
    -------
    Decoded
        Counts and warnings.

    Raises
    ------
    PassesError
        There are too few or too many pictures (``passes-missing``), they are in
        another order or of other passes (``passes-out-of-order``, ``passes-differ``),
        one is named twice or copied (``passes-repeated``) or black
        (``passes-black``), they differ in size (``passes-sizes-differ``), or are not
        linear floats of R, G and B (``passes-not-linear``).
    TextureError
        A picture cannot be read.
    OutputError
        ``target`` cannot be written, exists and ``force`` is off, or is a picture.
    """
    check_output(target, inputs=sources, force=force)
    check_sources(decoder.passes, sources)
    with contextlib.ExitStack() as stack:
        images = [stack.enter_context(open_image(path)) for path in sources]
        pictures = [
            _picture(decoder.passes, image, number)
            for number, image in enumerate(images, 1)
        ]
        _check_sizes(pictures)
        counts = _write(decoder, pictures, target, depth, force, progress)
    warnings = counts.warnings(path=target)
    return Decoded(Path(target), counts, warnings)


def check_sources(passes: Passes, sources: Sequence[StrPath]) -> None:
    """Check the number of pictures, and the numbers in their names if all have one."""
    if len(sources) != passes.count:
        raise PassesError(
            f"pictures must be {passes.count}, one per pass, got {len(sources)}",
            code="passes-missing",
            hint="name the pictures of all passes in their order",
        )
    if len({os.path.realpath(source) for source in sources}) < len(sources):
        raise _repeated()
    names = [Path(source).name for source in sources]
    numbers = [NUMBER.findall(name) for name in names]
    expected = list(range(1, passes.count + 1))
    if passes.count == 1 or not all(numbers):
        return
    last = [int(digits[-1]) for digits in numbers]
    if sorted(last) == expected and last != expected:
        raise PassesError(
            f"pictures must be in the order of the passes, got {', '.join(names)}",
            code="passes-out-of-order",
            hint="name that of the first pass first",
        )


def _picture(passes: Passes, image: Image, number: int) -> Picture:
    """Find the colours of the picture of a pass, counted from 1, and check them."""
    parts = coloured_parts(image)
    if len(parts) > 1:
        names = ", ".join(part.name for part, _ in parts)
        raise PassesError(
            f"a picture must have one part of colours, got {names}",
            code="passes-not-linear",
            path=image.path,
            hint="write each part to a file",
        )
    part, channels = parts[0]
    types = {part.types[index] for index in channels.rgb}
    letters = [part.channels[index].rpartition(".")[2] for index in channels.rgb]
    space = None if part.profile is None else part.profile.space
    is_encoded = space is not None and space.is_encoded
    if types - FLOATS or letters != ["R", "G", "B"] or is_encoded:
        got = ", ".join(sorted(types) if types - FLOATS else letters)
        got += f" of {space.name}" if space is not None else ""
        raise PassesError(
            f"pictures of passes must have channels R, G and B of linear floats, got "
            f"{got}",
            code="passes-not-linear",
            path=image.path,
            hint="render to OpenEXR without a display transform",
        )
    _check_mark(passes, image, number)
    others = [index for index in range(len(part.channels)) if index not in channels.rgb]
    return Picture(image, part, channels.rgb, tuple(others) if number == 1 else ())


def _check_mark(passes: Passes, image: Image, number: int) -> None:
    """Check the attribute of images of passes, which most renderers do not copy."""
    mark = image.header_text(ATTRIBUTE)
    if not mark or mark == pass_mark(passes, number):
        return
    known = [pass_mark(passes, other) for other in range(1, passes.count + 1)]
    if mark in known:
        raise PassesError(
            f"is the picture of pass {known.index(mark) + 1}, in the place of pass "
            f"{number}",
            code="passes-out-of-order",
            path=image.path,
            hint="name the pictures in the order of the passes",
        )
    raise PassesError(
        "is a picture of other passes",
        code="passes-differ",
        path=image.path,
        hint="name the file of passes that it was made with",
    )


def _check_sizes(pictures: Sequence[Picture]) -> None:
    first = pictures[0]
    for picture in pictures[1:]:
        if picture.part.window != first.part.window:
            raise PassesError(
                f"pictures must have one size and place, got {_size(first)} and "
                f"{_size(picture)}",
                code="passes-sizes-differ",
                path=picture.image.path,
                hint="render all passes with one camera and crop",
            )


def _size(picture: Picture) -> str:
    window = picture.part.window
    return f"{window.width} × {window.height} at ({window.x}, {window.y})"


def _write(
    decoder: Decoder,
    pictures: Sequence[Picture],
    target: StrPath,
    depth: str,
    force: bool,
    progress: ProgressCallback,
) -> Counts:
    first = pictures[0]
    output = _output(decoder, first, depth)
    height = first.part.window.height
    counts = Counts()
    totals = np.zeros(CHANNELS * len(pictures))
    with open_writer(target, [output], force=force) as writer:
        writer.start_part(0)
        for row, numbers, others in _bands(pictures, output.rows_per_band):
            colours, counted = decoder.decode(numbers)
            rows = np.concatenate([colours, others], axis=-1, dtype=np.float32)
            counts += counted + writer.write_rows(row, rows)
            totals += np.nansum(np.clip(numbers, 0, LARGEST), axis=(0, 1), dtype=float)
            progress(Progress("rows", row + len(rows), height))
        _check_different(pictures, totals)
    return counts


def _check_different(pictures: Sequence[Picture], totals: Array) -> None:
    """Check the sums (K,) of the numbers of pictures. Those of a black frame alone are
    black, and those of grey surfaces equal.
    """
    sums = totals.reshape(len(pictures), CHANNELS)
    coloured = [tuple(row) for row in sums if np.ptp(row)]
    if len({*coloured}) < len(coloured):
        raise _repeated()
    is_black = ~sums.any(axis=1)
    if is_black.any() and not is_black.all():
        raise PassesError(
            "is black, unlike the pictures of other passes",
            code="passes-black",
            path=pictures[int(is_black.argmax())].image.path,
            hint="render this pass again, with its textures and lights",
        )


def _repeated() -> PassesError:
    return PassesError(
        "pictures must be of different passes, got the same picture twice",
        code="passes-repeated",
        hint="name the picture of each pass once, in their order",
    )


def _output(decoder: Decoder, first: Picture, depth: str) -> OutputPart:
    part = first.part
    names = [
        _copied_name(part.channels[index], decoder.channels) for index in first.others
    ]
    kinds = ["half" if part.types[i] == "half" else "float" for i in first.others]
    metadata = {
        name: value for name, value in part.metadata.items() if name != ATTRIBUTE
    }
    return OutputPart(
        "",
        part.window,
        (*decoder.channels, *names),
        (*[depth] * CHANNELS, *kinds),
        {**metadata, **decoder.header},
        first.image.date(part),
    )


def _copied_name(name: str, taken: Sequence[str]) -> str:
    """Return the name of a copied channel: a layer ``first`` has those, such as depth,
    that XYZ would replace.
    """
    return f"first.{name}" if name in taken else name


def _bands(
    pictures: Sequence[Picture], rows: int
) -> Iterator[tuple[int, Values, Values]]:
    """Yield the first row of a band, its numbers (k, width, K), and the other channels
    of the first picture.
    """
    height = pictures[0].part.window.height
    step = _rows_per_band(pictures, rows)
    for row in range(0, height, step):
        count = min(step, height - row)
        bands = [picture.image.rows(picture.part, row, count) for picture in pictures]
        colours = [
            band[..., picture.rgb]
            for band, picture in zip(bands, pictures, strict=True)
        ]
        yield row, np.concatenate(colours, axis=-1), bands[0][..., pictures[0].others]


def _rows_per_band(pictures: Sequence[Picture], rows: int) -> int:
    """Return about ``rows`` that end with tiles, which can only be read as a whole."""
    height = pictures[0].part.window.height
    blocks = [min(picture.part.rows_per_block, height) for picture in pictures]
    block = math.lcm(*blocks)
    return block * max(rows // block, 1)
