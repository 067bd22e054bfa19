"""Further photographs of an image, under other lights: how they are read, and how they
fit the first.
"""

import contextlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import lights as find_lights
from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import OptionError, TextureError
from uplift.common.text import pluralise
from uplift.extras.images.channels import ColourChannels, coloured_parts
from uplift.extras.images.image import Image, Part, open_image
from uplift.extras.images.reader import SurfaceReader
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.chart import (
    COLUMNS,
    CORNERS_HINT,
    REPORTED,
    ROWS,
    Patches,
    calibrate,
    check_corners,
    compare_patches,
    corner_orders,
    patch_points,
)
from uplift.extras.photographs.fit import (
    check_aligned,
    estimate_exposure,
    estimate_noise,
    grey_balance,
)
from uplift.extras.photographs.photograph import Noise, Photograph
from uplift.extras.texture.encodings import Sampler

SAMPLED_ROWS = 24
"""Rows of a band that is sampled for exposure and noise."""
SAMPLED_BANDS = 12
"""Bands that are sampled."""
CROP = 256
"""Pixels along the sides of a crop whose alignment is checked."""
MAX_SAMPLE = 1 << 15
"""Pixels from which the exposure is estimated."""
MAX_CAST = 0.1
"""Relative difference of the channels of greys from which the balance is doubted."""
CLIPPED = 0.995
"""Share of the largest code from which a component is clipped."""


@dataclass(frozen=True)
class FurtherPicture:
    """What a further photograph of a sequence is.

    Parameters
    ----------
    light : str or Lamp
        Its light.
    space : str or None
        RGB space of the image, None for the one that the file states.
    camera : str or None
        Camera whose raw values the image has.
    exposure : float or None
        How much brighter it is than the first, None to estimate it.
    """

    light: Illuminant
    space: str | None = None
    camera: str | None = None
    exposure: float | None = None


@dataclass(frozen=True)
class ChartInPicture:
    """A ColorChecker in photographs.

    Parameters
    ----------
    corners : tuple of float
        x and y in pixels of the outer corners of its patches, clockwise from dark skin.
    atlas : str
        File or name of its 24 measured reflectances, in this order.
    """

    corners: tuple[float, ...]
    atlas: str = "macbeth"


@dataclass(frozen=True)
class FurtherPictures:
    """The further photographs of each image.

    Parameters
    ----------
    pictures : tuple of FurtherPicture
        One for each light.
    balance : {"light", "camera", "none"}
        As for `uplift.extras.photographs.photograph`.
    noise : tuple of float or None
        Share and floor, None to estimate them.
    chart : ChartInPicture or None
        A ColorChecker in all photographs, from which exposure, balance and noise are
        taken.
    """

    pictures: tuple[FurtherPicture, ...]
    balance: str = "light"
    noise: tuple[float, float] | None = None
    chart: ChartInPicture | None = None


@dataclass(frozen=True, eq=False)
class Picture:
    """An open photograph, and how its numbers become linear RGB: by a function, and a
    matrix (3, 3) if its space is another.
    """

    image: Image
    part: Part
    channels: ColourChannels
    to_linear: Callable[[Values], Values]
    matrix: Array | None

    @property
    def size(self) -> tuple[int, int]:
        """Width and height."""
        return self.part.window.width, self.part.window.height

    def rows(self, first: int, count: int) -> Array:
        """Linear RGB (count, width, 3) from row ``first``, counted from 0; NaN for what
        is clipped or black.
        """
        band = self.image.rows(self.part, first, count)
        numbers = self.channels.straight(band)
        unknown = self._unknown(numbers)
        with np.errstate(invalid="ignore"):
            linear = np.asarray(self.to_linear(numbers), dtype=float)
        linear = np.where(unknown, np.nan, linear)
        return linear if self.matrix is None else linear @ self.matrix.T

    def _unknown(self, numbers: Values) -> Mask:
        if self.part.max_code:
            return (numbers >= CLIPPED * self.part.max_code) | (numbers <= 0)
        # Negative numbers are colours outside the space, which lights may cause.
        return ~np.isfinite(numbers) | (numbers == 0)


def picture_of(image: Image, reader: SurfaceReader) -> Picture:
    """Return the first part of an image that has colours as a photograph."""
    part, channels = coloured_parts(image)[0]
    decoder = reader.decoder(part)
    return Picture(image, part, channels, decoder.to_linear, decoder.matrix)


@contextlib.contextmanager
def open_further(
    paths: Sequence[Path],
    pictures: Sequence[FurtherPicture],
    first: Picture,
    reader: SurfaceReader,
) -> Iterator[list[Picture]]:
    """Open the further photographs of an image. Raises `TextureError`."""
    with contextlib.ExitStack() as stack:
        opened = []
        for path, stated in zip(paths, pictures, strict=True):
            image = stack.enter_context(open_image(path))
            picture = picture_of(image, replace(reader, space=stated.space))
            if picture.size != first.size:
                raise TextureError(
                    "photographs of one thing must have one size, "
                    f"{first.size[0]} × {first.size[1]}, got "
                    f"{picture.size[0]} × {picture.size[1]}",
                    code="photographs-of-different-sizes",
                    hint="scale it to the size of the first",
                )
            if stated.camera is not None:
                # Raw values are in no RGB space, also if the file states one.
                raw = reader.to_linear(picture.part, None)
                picture = replace(picture, to_linear=raw, matrix=None)
            opened.append(picture)
        yield opened


@dataclass(frozen=True, eq=False)
class Fitted:
    """Exposures (L, 3) by channel and noise of the photographs of an image, and what
    to state about them.
    """

    exposures: Array
    noise: Noise
    facts: tuple[str, ...]


def fit(
    prepared: Photographs,
    sample: Sampler,
    further: FurtherPictures,
    first: Picture,
    pictures: Sequence[Picture],
) -> Fitted:
    """Estimate how photographs fit the first one, of which ``sample`` answers linear
    RGB (n, 3) at the wavelengths of the sensor and perhaps at others.
    """
    shifts = []
    for photograph, picture in zip(prepared.further, pictures, strict=True):
        shifts.append(check_aligned(_crops(first, picture), photograph.light))
    if further.chart is not None:
        return _fit_chart(prepared, further.chart, first, pictures)
    bands = [_sampled(picture) for picture in (first, *pictures)]
    noise = _noise(further, bands, (first, *pictures))
    factors = []
    facts = []
    for number, shift in enumerate(shifts):
        photograph = prepared.further[number]
        pixels = _pixels(prepared, sample, bands[0], bands[1 + number])
        stated = further.pictures[number].exposure
        factor, reason = _exposure(prepared, number, pixels, stated)
        factors.append(factor)
        place = "alignment not known" if shift is None else f"shift {shift:.2f} pixels"
        facts += [
            f"{photograph.light}: exposure × {factor:.4g} ({reason}), {place}",
            f"{photograph.light}: {_balance(photograph, pixels)}",
        ]
    source = "as given" if further.noise else "estimated from flat areas"
    facts.append(f"noise {noise.share:.2%} and {noise.floor:.2g} ({source})")
    exposures = np.repeat(np.array(factors)[:, None], 3, axis=1)
    return Fitted(exposures, noise, tuple(facts))


def _fit_chart(
    prepared: Photographs,
    chart: ChartInPicture,
    first: Picture,
    pictures: Sequence[Picture],
) -> Fitted:
    """Take exposure, balance and noise from a chart, and compare its patches with
    their measurements.
    """
    sensor = prepared.cube.data.sensor
    atlas = read_atlas(chart.atlas)
    if len(atlas) != COLUMNS * ROWS:
        raise OptionError(
            f"a chart has {COLUMNS * ROWS} patches, got "
            f"{pluralise(len(atlas), 'entry')} in '{chart.atlas}'",
            hint="measure all patches, row by row",
        )
    measured = resample(atlas, sensor.wavelengths).values
    orders = corner_orders(np.reshape(chart.corners, (4, 2)))
    places = [patch_points(corners) for corners in orders]
    own, *others = [_patches(first, points) for points in places]
    check_corners(sensor, orders, [own, *others], measured)
    further = [_patches(picture, places[0]) for picture in pictures]
    calibration = calibrate(prepared, own, further, measured)
    noise = calibration.noise
    exact = replace(prepared, noise=noise)
    lights = find_lights(REPORTED, sensor.observer, sensor.range)
    errors = compare_patches(exact, calibration, own, further, measured, lights)
    names = [light.name for light in lights]
    facts = [
        f"chart: the first photograph has {calibration.exposure:.4g} × reflectance"
    ]
    for photograph, gain in zip(prepared.further, calibration.gains, strict=True):
        facts.append(f"{photograph.light}: {_factors(gain, '.4g')} (from the chart)")
    means = _labelled(names, np.nanmean(errors, axis=0))
    facts += [
        f"noise {noise.share:.2%} and {noise.floor:.2g} (from the chart)",
        f"ΔE00 of the patches from their measurements, mean: {means}",
    ]
    for name, row in zip(atlas.names, errors, strict=True):
        values = "clipped" if np.isnan(row).any() else _labelled(names, row)
        facts.append(f"  {name}: {values}")
    return Fitted(calibration.gains, noise, tuple(facts))


def _factors(values: Array, form: str) -> str:
    return f"R G B × {' '.join(format(value, form) for value in values)}"


def _labelled(names: Sequence[str], values: Array) -> str:
    pairs = zip(names, values, strict=True)
    return ", ".join(f"{name} {value:.2f}" for name, value in pairs)


def _patches(picture: Picture, points: Array) -> Patches:
    """Sample the patches of a chart at x, y (24, n, 2) in pixels."""
    width, height = picture.size
    x, y = np.floor(points).astype(int).transpose(2, 0, 1)
    if not ((x >= 0) & (x < width) & (y >= 0) & (y < height)).all():
        raise OptionError(
            "the chart must lie in the picture, whose width and height in pixels are "
            f"{width} and {height}",
            hint=CORNERS_HINT,
        )
    first = int(y.min())
    rows = picture.rows(first, int(y.max()) - first + 1)
    values = rows[y - first, x]
    return Patches(values.mean(axis=1), values.var(axis=1))


class _Pixels(NamedTuple):
    """Linear RGB (n, 3) of pixels in the first photograph and in a further one, NaN
    where unknown, and the spectra (n, N) that the first lets expect.
    """

    rgb: Array
    others: Array
    expected: Array


def _pixels(
    prepared: Photographs, sample: Sampler, first: list[Array], other: list[Array]
) -> _Pixels:
    """Take some of the pixels of bands of two photographs."""
    rgb = np.concatenate([band.reshape(-1, 3) for band in first])
    values = np.concatenate([band.reshape(-1, 3) for band in other])
    known = np.flatnonzero(np.isfinite(rgb).all(axis=1))
    rows = known[:: max(len(known) // MAX_SAMPLE, 1)]
    colours = np.clip(rgb[rows], 0, 1)
    count = len(prepared.cube.wavelengths)
    expected = sample(colours.astype(np.float32))[:, :count]
    return _Pixels(colours, values[rows], expected.astype(float))


def _exposure(
    prepared: Photographs, number: int, pixels: _Pixels, stated: float | None
) -> tuple[float, str]:
    """Return the exposure of the further photograph of this number, and a remark."""
    if stated is not None:
        return stated, "as given"
    factor, spread = estimate_exposure(prepared, number, *pixels)
    if abs(np.log(factor)) <= spread:
        return 1.0, f"estimated {factor:.4g}, within what materials differ by"
    return factor, "estimated"


def _balance(further: Photograph, pixels: _Pixels) -> str:
    """State what greys show of the white balance of a further photograph."""
    ratio = grey_balance(further, *pixels)
    if ratio is None:
        return "no greys to check the white balance by"
    doubt = "; check the balance" * bool(np.abs(ratio - 1).max() > MAX_CAST)
    return f"greys have {_factors(ratio, '.3f')} of what is expected{doubt}"


def _noise(
    further: FurtherPictures, bands: list[list[Array]], pictures: Sequence[Picture]
) -> Noise:
    """Return the noise of the noisiest photograph, unless it is stated."""
    if further.noise:
        return Noise(*further.noise)
    estimates = [
        estimate_noise(band, picture.part.max_code)
        for band, picture in zip(bands, pictures, strict=True)
    ]
    return Noise(*np.max(estimates, axis=0).tolist())


def _sampled(picture: Picture) -> list[Array]:
    """Return some bands of rows, evenly spread."""
    _, height = picture.size
    count = min(SAMPLED_ROWS, height)
    starts = np.unique(np.linspace(0, height - count, SAMPLED_BANDS).astype(int))
    return [picture.rows(int(start), count) for start in starts]


def _crops(first: Picture, second: Picture) -> list[tuple[Array, Array]]:
    """Return the brightness of crops of two photographs: the middle and the corners."""
    width, height = first.size
    rows = min(CROP, height)
    columns = min(CROP, width)
    crops = []
    for start in sorted({0, (height - rows) // 2, height - rows}):
        one, other = (
            np.nan_to_num(picture.rows(start, rows)).sum(axis=-1)
            for picture in (first, second)
        )
        for left in sorted({0, (width - columns) // 2, width - columns}):
            place = slice(left, left + columns)
            crops.append((one[:, place], other[:, place]))
    return crops
