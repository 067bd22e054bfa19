"""The colours of images as a scene: `uplift.build` fits only the nodes that answer
them.
"""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask, StrPath
from uplift.common.errors import OptionError, TextureError, warn
from uplift.common.files import file_digest
from uplift.common.progress import Progress, ProgressCallback
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import open_image
from uplift.extras.images.reader import SurfaceReader, check_encoding
from uplift.lattice.entry_boxes import EntryBoxes

BLOCK_PIXELS = 1 << 16
"""Pixels decoded at a time."""
BINS = 64
"""Bins along each channel of encoded RGB: four 8-bit codes wide."""
MAX_PIXELS = 1 << 24
"""Pixels of all textures that are read."""
MAX_LIST = 256
"""Most colours whose spectra a list holds, with an index of one byte per pixel."""
TYPE_BYTES = {"uint8": 1, "uint16": 2, "half": 2}


def as_images(paths: StrPath | Sequence[StrPath]) -> "Images":
    """Return the scene of one image or several."""
    named = [paths] if isinstance(paths, str | os.PathLike) else paths
    return Images(tuple(map(Path, named)))


@dataclass(frozen=True)
class Images:
    """A scene of at least one image; a `SceneLike` of `uplift.build`. Memory holds the
    nodes of the colours only.

    ``encoding``, ``out_of_gamut`` and ``space`` are those of
    `uplift.extras.texture.prepare`. Raises `OptionError`.
    """

    paths: tuple[Path, ...]
    encoding: str = "auto"
    out_of_gamut: str = "clip"
    space: str | None = None

    def __post_init__(self) -> None:
        check_encoding(self.encoding)
        check_method(self.out_of_gamut)
        if not self.paths:
            raise OptionError(
                "a scene must have at least one image, got none",
                hint="name one, or build without a scene",
            )

    def required_points(
        self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback
    ) -> Mask:
        """Return the mask (dim³,) of the nodes that answer the colours of the images;
        see `SceneLike`.

        Raises `TextureError`, and `ColourError` with ``out_of_gamut="error"``. Warns of
        images in another RGB space.
        """
        return boxes.required_points(self.all_colours(sensor, progress))

    def describe(self) -> list[dict[str, Any]]:
        """Return name and digest of each image, and how it was decoded, as
        JSON values.
        """
        decoding = {"encoding": self.encoding, "out_of_gamut": self.out_of_gamut}
        decoding |= {} if self.space is None else {"space": self.space}
        return [
            {"name": path.name, "digest": file_digest(path), **decoding}
            for path in self.paths
        ]

    def all_colours(
        self, sensor: Sensor, progress: ProgressCallback
    ) -> Iterator[Array]:
        """Yield the `colours` of one image after the other."""
        for done, path in enumerate(self.paths):
            progress(Progress("images", done, len(self.paths)))
            yield from self.colours(path, sensor)

    def colours(self, path: Path, sensor: Sensor) -> Iterator[Array]:
        """Yield the colours of an image, linear RGB (n, 3) in [0, 1] of a sensor, block
        by block, also those of transparent pixels.
        """
        return (rgb for rgb, _ in self.blocks(path, sensor, is_whole=True))

    def blocks(
        self, path: Path, sensor: Sensor, step: int = 1, *, is_whole: bool = False
    ) -> Iterator[tuple[Array, Counts]]:
        """Yield the colours of every pixel of this ``step``, as `colours`, and counts
        of those that had to change. Transparent ones are left out unless ``is_whole``.
        """
        reader = SurfaceReader(
            sensor=sensor,
            encoding=self.encoding,
            space=self.space,
            out_of_gamut=self.out_of_gamut,
        )
        with open_image(path) as image:
            for warning in reader.warnings(image):
                warn(warning)
            for part, channels in coloured_parts(image):
                decode = reader.decoder(part)
                for _, band in image.bands(part):
                    pixels = band.reshape(-1, band.shape[-1])
                    for first in range(0, len(pixels), BLOCK_PIXELS * step):
                        chosen = pixels[first : first + BLOCK_PIXELS * step : step]
                        if not is_whole:
                            chosen = chosen[channels.visible(chosen)]
                        rgb, counts = decode(channels.straight(chosen))
                        yield rgb.astype(float), counts


@dataclass(frozen=True, eq=False)
class ColourSet:
    """Scene of linear RGB (n, 3) for `uplift.build`: the cube gets the nodes that the
    colours need.
    """

    rgb: Array

    def required_points(
        self, boxes: EntryBoxes, sensor: Sensor, progress: ProgressCallback
    ) -> Mask:
        """Nodes (dim³,) that the colours need."""
        return boxes.required_points([self.rgb])

    def describe(self) -> list[dict[str, Any]]:
        """An empty list: colours have no source files."""
        return []


@dataclass(frozen=True, eq=False)
class PixelSample:
    """Distinct linear RGB (n, 3), and the share (n,) of the sampled pixels that have
    each; shares sum to 1.
    """

    rgb: Array
    share: Array


@dataclass(frozen=True, eq=False)
class SampledColours:
    """Disjoint samples of the textures' pixels, to choose candidates by and to verify
    the result.

    Textures with fewer pixels than both need together have all pixels in both.
    ``colour_bins`` (n, 3) has a colour of every bin that has any pixel, in linear RGB.
    ``pixels`` are all those of the textures, ``size`` their bytes as RGB, and ``few``
    (n, 3) their different colours if these are at most `MAX_LIST`.
    """

    predicting: PixelSample
    confirming: PixelSample
    colour_bins: Array
    pixels: int
    size: int
    few: Array | None


def sample_colours(
    images: Images, sensor: Sensor, sizes: tuple[int, int], progress: ProgressCallback
) -> SampledColours:
    """Sample about ``sizes`` pixels to predict and to confirm, all pixels with equal
    probability.

    The sample is the same every time. Of more than `MAX_PIXELS`, only every so many are
    read. Warns of colours that change. Raises `TextureError`, also for images without
    pixels.
    """
    counts = [_pixel_count(path) for path in images.paths]
    total, size = map(sum, zip(*counts, strict=True))
    if not total:
        raise no_pixels()
    step = -(-total // MAX_PIXELS)
    first = sizes[0] * step / total
    last = first + sizes[1] * step / total
    rng = np.random.default_rng(0)
    bins = np.full((BINS**3, 3), np.nan)
    few = np.empty((0, 3))
    samples: tuple[list[Array], list[Array]] = [], []
    for done, path in enumerate(images.paths):
        progress(Progress("textures", done, len(images.paths)))
        changed = Counts()
        for rgb, counted in images.blocks(path, sensor, step):
            changed += counted
            bins[bin_index(sensor, rgb)] = rgb
            lot = rng.random(len(rgb))
            samples[0].append(rgb[(lot < first) | (last > 1)])
            samples[1].append(rgb[(lot >= first) & (lot < last) | (last > 1)])
            if step == 1 and len(few) <= MAX_LIST:
                few = np.unique(np.concatenate([few, rgb]), axis=0)
        for warning in changed.warnings(path=path):
            warn(warning)
    occupied = bins[~np.isnan(bins[:, 0])]
    if not len(occupied):
        raise no_pixels()
    predicting, confirming = (
        _distinct(np.concatenate(sample), occupied) for sample in samples
    )
    is_few = step == 1 and len(few) <= MAX_LIST
    return SampledColours(
        predicting, confirming, occupied, total, size, few if is_few else None
    )


def no_pixels() -> TextureError:
    """The error for images that show nothing."""
    return TextureError(
        "images must have visible pixels, got none", hint="name an image with pixels"
    )


def _pixel_count(path: Path) -> tuple[int, int]:
    """Pixels of the parts of an image that have colour channels, and the bytes of their
    RGB.
    """
    with open_image(path) as image:
        parts = [
            (part.window.width * part.window.height, part)
            for part, _ in coloured_parts(image)
        ]
    return sum(count for count, _ in parts), sum(
        3 * count * TYPE_BYTES.get(part.types[0], 4) for count, part in parts
    )


def bin_index(sensor: Sensor, rgb: Array) -> Any:
    """Return the numbers (n,) of the bins of linear RGB (n, 3), of `BINS` along each
    channel of encoded RGB.
    """
    codes = np.interp(rgb, sensor.decoding, np.linspace(0, BINS, 256))
    red, green, blue = np.minimum(codes, BINS - 1).astype(int).T
    return (red * BINS + green) * BINS + blue


def _distinct(sample: Array, occupied: Array) -> PixelSample:
    """Each sampled colour once; the colours of the bins for an empty sample."""
    rgb, counts = np.unique(
        sample if len(sample) else occupied, axis=0, return_counts=True
    )
    return PixelSample(rgb, counts / counts.sum())
