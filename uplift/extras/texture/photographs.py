"""Further photographs of an image, under other lights: how they are read, and how they
fit the first.
"""

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import light as find_light
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask, Values
from uplift.common.errors import OptionError, TextureError
from uplift.common.text import pluralise
from uplift.extras.colour.spaces import find_space
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
from uplift.extras.texture.channels import ColourChannels, coloured_parts
from uplift.extras.texture.colours import Decoder, linear_reader, make_decoder
from uplift.extras.texture.image import Image, Part, open_image
from uplift.extras.texture.uplifter import Sampler
from uplift.lookup.cube import Cube

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
class Fitted:
    """Exposures (L, 3) by channel and noise of the photographs of an image, and what
    to state about them.
    """

    exposures: Array
    noise: Noise
    facts: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Picture:
    """An open photograph, and how its numbers are read."""

    image: Image
    part: Part
    channels: ColourChannels
    decode: Decoder

    def rows(self, first: int, count: int) -> Array:
        """Linear RGB (count, width, 3) from row ``first``, counted from 0; NaN for what
        is clipped or black.
        """
        band = self.image.rows(self.part, first, count)
        numbers = self.channels.straight(band)
        unknown = self._unknown(numbers)
        with np.errstate(invalid="ignore"):
            linear = np.asarray(self.decode.function(numbers), dtype=float)
        linear = np.where(unknown, np.nan, linear)
        if self.decode.matrix is not None:
            linear = linear @ self.decode.matrix.T
        return linear

    def _unknown(self, numbers: Values) -> Mask:
        if self.part.max_code:
            return (numbers >= CLIPPED * self.part.max_code) | (numbers <= 0)
        # Negative numbers are colours outside the space, which lights may cause.
        return ~np.isfinite(numbers) | (numbers == 0)


@contextlib.contextmanager
def open_further(
    further: FurtherPictures,
    paths: Sequence[Path],
    size: tuple[int, int],
    sensor: Sensor,
    encoding: str,
) -> Iterator[list[Picture]]:
    """Open the further photographs of an image of this width and height, whose colours
    are read as linear RGB of a sensor. Raises `TextureError`.
    """
    with contextlib.ExitStack() as stack:
        opened = []
        for path, picture in zip(paths, further.pictures, strict=True):
            one = _open(path, size, sensor, encoding, picture)
            opened.append(stack.enter_context(one))
        yield opened


@contextlib.contextmanager
def _open(
    path: Path,
    size: tuple[int, int],
    sensor: Sensor,
    encoding: str,
    picture: FurtherPicture,
) -> Iterator[Picture]:
    """Open a further photograph of this width and height."""
    with open_image(path) as image:
        part, channels = coloured_parts(image)[0]
        found = part.window.width, part.window.height
        if found != size:
            raise TextureError(
                f"photographs of one thing must have one size, {size[0]} × {size[1]}, "
                f"got {found[0]} × {found[1]}",
                code="photographs-of-different-sizes",
                hint="scale it to the size of the first",
            )
        space = None if picture.space is None else find_space(picture.space)
        decode = make_decoder(sensor, part, encoding, "clip", space)
        if picture.camera is not None:
            # Raw values are in no RGB space, also if the file states one.
            raw = linear_reader(sensor, part, encoding, None)
            decode = replace(decode, function=raw, matrix=None)
        yield Picture(image, part, channels, decode)


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
    names = [photograph.light for photograph in prepared.further]
    shifts = [
        check_aligned(_crops(first, picture), name)
        for picture, name in zip(pictures, names, strict=True)
    ]
    if further.chart is not None:
        return _fit_chart(prepared, further.chart, first, pictures)
    bands = [_sampled(picture) for picture in (first, *pictures)]
    noise, noise_fact = _noise(further, bands, (first, *pictures))
    factors = []
    facts = []
    for number, (name, shift) in enumerate(zip(names, shifts, strict=True)):
        pixels = _pixels(prepared.cube, sample, bands[0], bands[1 + number])
        stated = further.pictures[number].exposure
        factor, reason = _exposure(prepared, number, pixels, stated)
        factors.append(factor)
        place = "alignment not known" if shift is None else f"shift {shift:.2f} pixels"
        facts.append(f"{name}: exposure × {factor:.4g} ({reason}), {place}")
        facts.append(f"{name}: {_balance(prepared.further[number], pixels)}")
    exposures = np.repeat(np.array(factors)[:, None], 3, axis=1)
    return Fitted(exposures, noise, (*facts, noise_fact))


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
    exact = replace(prepared, noise=calibration.noise)
    setting = sensor.observer, *sensor.range
    lights = [find_light(name, *setting) for name in REPORTED]
    errors = compare_patches(exact, calibration, own, further, measured, lights)
    facts = [
        f"chart: the first photograph has {calibration.exposure:.4g} × reflectance"
    ]
    for photograph, gain in zip(prepared.further, calibration.gains, strict=True):
        channels = " ".join(f"{value:.4g}" for value in gain)
        facts.append(f"{photograph.light}: R G B × {channels} (from the chart)")
    noise = calibration.noise
    facts.append(f"noise {noise.share:.2%} and {noise.floor:.2g} (from the chart)")
    means = ", ".join(
        f"{light.name} {mean:.2f}"
        for light, mean in zip(lights, np.nanmean(errors, axis=0), strict=True)
    )
    facts.append(f"ΔE00 of the patches from their measurements, mean: {means}")
    for name, row in zip(atlas.names, errors, strict=True):
        columns = ", ".join(
            f"{light.name} {value:.2f}"
            for light, value in zip(lights, row, strict=True)
        )
        facts.append(f"  {name}: {'clipped' if np.isnan(row).any() else columns}")
    return Fitted(calibration.gains, noise, tuple(facts))


def _patches(picture: Picture, points: Array) -> Patches:
    """Sample the patches of a chart at x, y (24, n, 2) in pixels."""
    window = picture.part.window
    x, y = np.floor(points).astype(int).transpose(2, 0, 1)
    inside = (x >= 0) & (x < window.width) & (y >= 0) & (y < window.height)
    if not inside.all():
        raise OptionError(
            "the chart must lie in the picture, whose width and height in pixels are "
            f"{window.width} and {window.height}",
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
    cube: Cube, sample: Sampler, first: list[Array], other: list[Array]
) -> _Pixels:
    """Take some of the pixels of bands of two photographs."""
    rgb = np.concatenate([band.reshape(-1, 3) for band in first])
    values = np.concatenate([band.reshape(-1, 3) for band in other])
    known = np.flatnonzero(np.isfinite(rgb).all(axis=1))
    rows = known[:: max(len(known) // MAX_SAMPLE, 1)]
    colours = np.clip(rgb[rows], 0, 1)
    expected = sample(colours.astype(np.float32))[:, : len(cube.wavelengths)]
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
    channels = " ".join(f"{value:.3f}" for value in ratio)
    text = f"greys have R G B × {channels} of what is expected"
    if np.abs(ratio - 1).max() > MAX_CAST:
        text += "; check the balance"
    return text


def _noise(
    further: FurtherPictures, bands: list[list[Array]], pictures: Sequence[Picture]
) -> tuple[Noise, str]:
    """Return the noise of the noisiest photograph, and a statement."""
    noise = Noise(*further.noise) if further.noise else None
    if noise is None:
        estimates = [
            estimate_noise(band, picture.part.max_code)
            for band, picture in zip(bands, pictures, strict=True)
        ]
        noise = Noise(
            max(estimate.share for estimate in estimates),
            max(estimate.floor for estimate in estimates),
        )
    source = "as given" if further.noise else "estimated from flat areas"
    return noise, f"noise {noise.share:.2%} and {noise.floor:.2g} ({source})"


def _sampled(picture: Picture) -> list[Array]:
    """Return some bands of rows, evenly spread."""
    height = picture.part.window.height
    count = min(SAMPLED_ROWS, height)
    starts = np.unique(np.linspace(0, height - count, SAMPLED_BANDS).astype(int))
    return [picture.rows(int(start), count) for start in starts]


def _crops(first: Picture, second: Picture) -> list[tuple[Array, Array]]:
    """Return the brightness of crops of two photographs: the middle and the corners."""
    window = first.part.window
    rows = min(CROP, window.height)
    columns = min(CROP, window.width)
    crops = []
    for start in sorted({0, (window.height - rows) // 2, window.height - rows}):
        bands = [
            np.nan_to_num(picture.rows(start, rows)).sum(axis=-1)
            for picture in (first, second)
        ]
        for left in sorted({0, (window.width - columns) // 2, window.width - columns}):
            place = slice(left, left + columns)
            crops.append((bands[0][:, place], bands[1][:, place]))
    return crops
