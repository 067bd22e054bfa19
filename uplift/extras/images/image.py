"""Image files as they are: parts, channels, and rows a band at a time (OpenEXR,
Radiance HDR, PNG, JPEG, TIFF).

OpenImageIO reads all formats. Bands hold the numbers of the file, unconverted. Images
are upright: the orientation that EXIF, TIFF or HDR states is applied.
"""

import contextlib
import itertools
import os
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath, Values
from uplift.common.errors import ColourError, TextureError, UpliftError
from uplift.common.files import check_regular
from uplift.common.machine import check_memory
from uplift.common.text import pluralise
from uplift.extras.colour.spaces import ImageSpace
from uplift.extras.images.profile import Profile, read_profile, xyz_space
from uplift.extras.images.statements import PNG, SIGNATURES, read_statements

FORMATS = ("openexr", "hdr", "png", "jpeg", "tiff")
MAX_BAND_BYTES = 1 << 25
"""Size of a band to read, unless the file's own blocks of rows are larger."""
UINT32_SCALE = 2**32 - 1
"""OpenImageIO divides 32-bit integers by this number."""
MAX_EXACT_INTEGER = 1 << 24
"""Integers up to this number pass through 32-bit floats."""
UNKNOWN_PROBLEM = "the image cannot be read"
PNG_INTERLACE = 28
"""Offset of the byte that marks an interlaced PNG file, which can only be decoded in
one piece.
"""
TECHNICAL = frozenset(
    ("compression", "colorInteropID", "DateTime", "ICCProfile", "lineOrder", "name",
    "type", "view", "planarconfig",
     "ResolutionUnit", "Orientation", "chunkCount", "version", "PixelAspectRatio",
     "textureformat",
     "wrapmodes", "CICP", "chromaticities", "multiView", "XResolution", "YResolution")
)  # fmt: skip
"""Attributes that textures do not keep, as they describe the file that is read."""
FILM = frozenset(("smpte:KeyCode", "smpte:TimeCode"))
"""Attributes that are kept although OpenImageIO gives them a prefix, as it does to
those of other formats.
"""
ENVIRONMENTS = ("LatLong Environment", "CubeFace Environment")
"""Values of ``textureformat`` that are kept: they stand for the attribute ``envmap`` of
OpenEXR.
"""
MAX_METADATA = 100
"""Number of attributes that textures keep."""
MAX_METADATA_LENGTH = 10_000
"""Number of characters or numbers of an attribute that textures keep."""
OTHER_COLOURS = {8, 9, 10, 32844, 32845}
"""Photometric interpretations of TIFF that OpenImageIO reads as RGB: CIELAB, ICCLab,
ITULab, LogL and LogLuv.
"""
FORMAT_HINT = "use an EXR, HDR, PNG, JPEG or TIFF image"
SUBSAMPLED = "ubsampled"
"""Part of the error of OpenImageIO for channels of another resolution, such as the
chroma of luminance and chroma.
"""
SUBSAMPLED_HINT = "write R, G and B at full resolution"
MIRRORED = (2, 4, 5, 7)
QUARTERS = {3: 2, 4: 2, 5: 1, 6: 3, 7: 3, 8: 1}
"""Turns to the left that make images of an orientation upright, by 90°."""
MEMORY_HINT = "write the image with smaller tiles or strips, or without interlacing"


@dataclass(frozen=True)
class Window:
    """Data window of a part, its display window (x, y, width, height) and its pixel
    aspect ratio.
    """

    x: int
    y: int
    width: int
    height: int
    display: tuple[int, int, int, int]
    aspect: float


@dataclass(frozen=True)
class Attribute:
    """Value of an attribute, with its type as `OpenImageIO.TypeDesc`."""

    type: Any
    value: Any


@dataclass(frozen=True)
class Part:
    """One part of a file; files of formats other than OpenEXR have one.

    ``types`` of the channels are half, float, uint, uint8 or uint16. ``rows_per_block``
    rows are decoded together. ``metadata`` are statements of the file that textures
    keep, such as its author, frame rate or camera.
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
    metadata: Mapping[str, Attribute] = field(default_factory=dict)
    has_associated_alpha: bool = False
    """Whether colours next to an alpha are multiplied by it."""
    xyz: ImageSpace | None = None
    """Space of channels of CIE XYZ."""

    @property
    def max_code(self) -> int:
        """Largest value if all channels are 8-bit or all are 16-bit
        integers, else 0.
        """
        codes = {frozenset(["uint8"]): 255, frozenset(["uint16"]): 65535}
        return codes.get(frozenset(self.types), 0)


@dataclass(frozen=True, eq=False)
class Image:
    """An open image file. ``pixels`` are all rows of one that is not stored upright."""

    path: Path
    parts: tuple[Part, ...]
    handle: Any
    pixels: Values | None = None

    def bands(self, part: Part) -> Iterator[tuple[int, Values]]:
        """Yield the number of the first row, counted from 0, and rows (k, width,
        channels): integers if all channels are, else floats.
        """
        window = part.window
        block = window.width * len(part.channels) * 4 * part.rows_per_block
        step = part.rows_per_block * max(1, MAX_BAND_BYTES // block)
        for first in range(0, window.height, step):
            yield first, self.rows(part, first, min(step, window.height - first))

    def rows(self, part: Part, first: int, count: int) -> Values:
        """Read rows (count, width, channels) from row ``first`` of the window, as
        `bands` does.
        """
        if self.pixels is not None:
            return self.pixels[first : first + count]
        self.handle.seek_subimage(part.number, 0)
        first += part.window.y
        end = first + count
        if part.max_code:
            return self._read(part, first, end, part.types[0])
        integers = [index for index, name in enumerate(part.types) if name == "uint"]
        values = self._read(part, first, end, "double" if integers else "float")
        for index in integers:
            numbers = self._read(part, first, end, "uint", index)[..., 0]
            if numbers.max(initial=0) > MAX_EXACT_INTEGER:
                raise TextureError(
                    f"integers must be at most {MAX_EXACT_INTEGER}, got "
                    f"{numbers.max()} in channel '{part.channels[index]}'",
                    hint="remove that channel",
                )
            values[..., index] = numbers / UINT32_SCALE
        return values

    def date(self, part: Part) -> str:
        """Return the date that a part states, else that of the file, as EXIF writes
        it.
        """
        modified = time.gmtime(self.path.stat().st_mtime)
        return part.date or time.strftime("%Y:%m:%d %H:%M:%S", modified)

    def header_text(self, name: str) -> str:
        """Return a text attribute of the first part, empty if it is missing."""
        return str(self.handle.spec(0).get_string_attribute(name))

    def _read(
        self, part: Part, first: int, end: int, dtype: str, channel: int | None = None
    ) -> Values:
        import OpenImageIO

        window = part.window
        kind = OpenImageIO.TypeDesc(dtype)
        channels = (
            (0, len(part.channels)) if channel is None else (channel, channel + 1)
        )
        if part.is_tiled:
            columns = (window.x, window.x + window.width)
            rows = self.handle.read_tiles(*columns, first, end, 0, 1, *channels, kind)
        else:
            rows = self.handle.read_scanlines(first, end, 0, *channels, kind)
        problem = read_error(self.handle)  # the only sign of a truncated JPEG
        if rows is None or problem:
            raise TextureError(
                f"rows {first} to {end - 1} cannot be read: "
                f"{problem or UNKNOWN_PROBLEM}",
                code="file-unreadable",
                path=self.path,
                hint="the file is damaged: write it again",
            )
        return np.asarray(rows)


@contextlib.contextmanager
def errors_at(path: Path) -> Iterator[None]:
    """Locate the errors of images and colours that have no path."""
    try:
        yield
    except (TextureError, ColourError) as error:
        error.path = path if error.path is None else error.path
        raise


@contextlib.contextmanager
def open_image(path: StrPath) -> Iterator[Image]:
    """Open an image file. A `TextureError` or `ColourError` in the block without a path
    gets this one.

    Raises `TextureError` if the file is missing, damaged, of another format, has
    several values per pixel, too many channels or attributes, names that are not text,
    or blocks of rows that do not fit into memory.
    """
    path = Path(path)
    with contextlib.ExitStack() as stack:
        stack.enter_context(errors_at(path))
        start = _read_start(path)
        statements = read_statements(path, start)
        handle = _open(path)
        stack.callback(handle.close)
        parts = tuple(_parts(handle, statements))
        is_interlaced = start.startswith(PNG) and start[PNG_INTERLACE:] == b"\1"
        orientation = _orientation(handle)
        for part in parts:
            _check_names(part)
            _check_block(part, is_whole=is_interlaced or orientation > 1)
        image = Image(path, parts, handle)
        yield _upright(image, orientation) if orientation > 1 else image


def _open(path: Path) -> Any:
    import OpenImageIO

    config = OpenImageIO.ImageSpec()
    # Keep colours as stored, not multiplied by alpha.
    config["oiio:UnassociatedAlpha"] = 1
    # Bands are read, which are compared with memory.
    OpenImageIO.attribute("limits:imagesize_MB", 0)
    handle = OpenImageIO.ImageInput.open(utf8_name(path, TextureError), config)
    if handle is None:
        problem = read_error(OpenImageIO) or UNKNOWN_PROBLEM
        hint = SUBSAMPLED_HINT if SUBSAMPLED in problem else FORMAT_HINT
        raise TextureError(problem, code="file-unreadable", hint=hint)
    return handle


def _check_names(part: Part) -> None:
    for name in (part.name, *part.channels):
        if not _is_text(name):
            raise TextureError(
                f"names of parts and channels must be UTF-8, got {name!a}",
                hint="rename it",
            )


def _check_block(part: Part, *, is_whole: bool) -> None:
    """Check that the rows that are decoded together fit into memory."""
    height = part.window.height
    rows = height if is_whole else min(part.rows_per_block, height)
    check_memory(
        rows * part.window.width * len(part.channels) * 4,
        f"a block of {pluralise(rows, 'row')}, decoded together,",
        TextureError,
        MEMORY_HINT,
    )


def _read_start(path: Path) -> bytes:
    check_regular(path, TextureError, hint=FORMAT_HINT)
    try:
        with path.open("rb") as file:
            start = file.read(PNG_INTERLACE + 1)
    except OSError as error:
        raise TextureError(
            f"cannot be read: {error.strerror}",
            code="file-unreadable",
            hint=FORMAT_HINT,
        ) from error
    # OpenImageIO would try all its formats, for minutes if the file is large
    if not start.startswith(SIGNATURES):
        raise TextureError("unsupported image format", hint=FORMAT_HINT)
    return start


def _parts(handle: Any, statements: Mapping[str, Any]) -> Iterator[Part]:
    if handle.format_name() not in FORMATS:
        raise TextureError(
            f"unsupported image format {handle.format_name()}", hint=FORMAT_HINT
        )
    number = 0
    while handle.seek_subimage(number, 0):
        yield _part(handle.spec(), number, statements)
        number += 1
        if handle.format_name() != "openexr":  # pages of a TIFF are separate images
            return


def _orientation(handle: Any) -> int:
    """Return the orientation of an image by the numbers of EXIF, which are also those
    of OpenImageIO for the axes of HDR files, but for two that it takes for each other.
    """
    if handle.format_name() == "openexr":
        return 1
    orientation: int = handle.spec().get_int_attribute("Orientation", 1)
    is_swapped = handle.format_name() == "hdr" and orientation in (6, 8)
    return 14 - orientation if is_swapped else orientation


def _upright(image: Image, orientation: int) -> Image:
    """Turn an image of one part."""
    (part,) = image.parts
    pixels = image.rows(part, 0, part.window.height)
    if orientation in MIRRORED:
        pixels = pixels[:, ::-1]
    quarters = QUARTERS.get(orientation, 0)
    pixels = np.rot90(pixels, quarters)
    aspect = part.window.aspect ** (-1 if quarters % 2 else 1)
    height, width, _ = pixels.shape
    window = Window(0, 0, width, height, (0, 0, width, height), aspect)
    return Image(image.path, (replace(part, window=window),), image.handle, pixels)


def _part(spec: Any, number: int, statements: Mapping[str, Any]) -> Part:
    if spec.deep or spec.depth > 1:
        raise TextureError("an image must have one value per pixel", hint="flatten it")
    if spec.get_int_attribute("tiff:PhotometricInterpretation") in OTHER_COLOURS:
        raise TextureError(
            "the colours of a TIFF must be RGB, grey or CMYK", hint="convert it to RGB"
        )
    formats = spec.channelformats or (spec.format,) * spec.nchannels
    display = (spec.full_x, spec.full_y, spec.full_width, spec.full_height)
    aspect = spec.get_float_attribute("PixelAspectRatio", 1.0)
    date = str(spec.get_string_attribute("DateTime"))
    return Part(
        number=number,
        name=spec.get_string_attribute("oiio:subimagename"),
        window=Window(spec.x, spec.y, spec.width, spec.height, display, aspect),
        channels=tuple(spec.channelnames),
        types=tuple(map(str, formats)),
        rows_per_block=spec.tile_height
        or max(spec.get_int_attribute("oiio:RowsPerChunk", 1), 1),
        is_tiled=bool(spec.tile_width),
        profile=read_profile(spec, statements),
        date=date if _is_text(date) and date else None,
        metadata=_metadata(spec),
        has_associated_alpha=not spec.get_int_attribute("oiio:UnassociatedAlpha"),
        xyz=xyz_space(spec),
    )


def _metadata(spec: Any) -> dict[str, Attribute]:
    """Return the attributes that are not about how the image is stored."""
    kept = (
        attribute
        for attribute in spec.extra_attribs
        if _is_kept(attribute.name, attribute.value)
    )
    return {
        attribute.name: Attribute(attribute.type, attribute.value)
        for attribute in itertools.islice(kept, MAX_METADATA)
    }


def _is_kept(name: str, value: Any) -> bool:
    if name == "textureformat":
        return value in ENVIRONMENTS
    is_own = name in FILM or not set(name) & set(":.")
    return is_own and name not in TECHNICAL and _is_text(name) and _is_kept_value(value)


def _is_kept_value(value: Any) -> bool:
    """Return whether a value is text, a number, or a tuple of either, and neither empty
    nor long. Bytes are not.
    """
    if isinstance(value, str | tuple):
        if not 0 < len(value) <= MAX_METADATA_LENGTH:
            return False
        return (
            _is_text(value)
            if isinstance(value, str)
            else all(map(_is_kept_value, value))
        )
    return isinstance(value, int | float)


def _is_text(name: str) -> bool:
    """Return whether a text of OpenImageIO is Unicode. Bytes that are not UTF-8 become
    lone surrogates.
    """
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def read_error(source: Any) -> str:
    """Return the pending error of OpenImageIO or one of its objects on one line, empty
    if there is none.
    """
    try:
        return " ".join(source.geterror().split())
    except UnicodeDecodeError:  # it quotes bytes of the file
        return UNKNOWN_PROBLEM


def utf8_name(path: Path, error: type[UpliftError]) -> str:
    """Return the name of a file for OpenImageIO, which opens only names that are UTF-8.
    Raises ``error``.
    """
    name = os.fspath(path)
    try:
        name.encode()
    except UnicodeEncodeError as cause:
        raise error(
            "the file name is not UTF-8", path=path, hint="rename the file"
        ) from cause
    return name
