"""Converters, which `uplift.io.texture.convert` applies to an image: a cube, or several cubes chosen by a mask.

Spectra and moments of a mixture of cubes are those of its parts, weighted: moments are linear in the reflectance, so
the mixture of two reflectances of one colour has this colour, and stays in [0, 1]. Multipliers are mixed as moments.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import check_method
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace, find_space
from uplift.common.errors import OptionError, TextureError
from uplift.common.files import check_regular
from uplift.io import exr
from uplift.io.texture.channels import ColourChannels, coloured_parts
from uplift.io.texture.colours import Counts, Floats, check_encoding, make_decoder
from uplift.io.texture.image import Image, Part, Values
from uplift.io.texture.mask import open_mask
from uplift.io.texture.pixel_encoding import PixelEncoding, Sampler, Spectrum
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.lookup.cube import common_sensor
from uplift.lookup.refine import refine_to_rgb

ReadColours = Callable[[Values], tuple[Floats, Counts]]
"""From the numbers of an image (…, 3) to linear RGB (…, 3), and counts of unusual pixels."""
Converted = tuple[tuple[Floats, ...], Counts]
"""Arrays that make the channels (…, 3 + N) side by side, and pixels that the conversion could not represent."""
ConvertRows = Callable[[Part, int, Floats], Converted]
"""Conversion of rows (k, width, 3) of a part, from the row of this number in its window."""


@dataclass(frozen=True, eq=False)
class Converter(ABC):
    """Conversion of linear RGB of a sensor to the channels of an OpenEXR file.

    ``depth`` is the type of the channels, ``channels`` (N,) the names of those after R, G and B, ``header`` the
    attributes of every file, and ``space`` the RGB space of images, None for the one that each file states.
    """

    sensor: Sensor
    depth: str
    encoding: str
    out_of_gamut: str
    channels: tuple[str, ...]
    header: Mapping[str, Any]
    space: ImageSpace | None = field(default=None, kw_only=True)

    @abstractmethod
    def convert(self, rgb: Floats) -> Converted:
        """Arrays that make R, G, B and the channels (…, 3 + N) side by side, for linear RGB (…, 3) of `decoder`."""

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        """Multiply the arrays of `convert`, which are not changed, by alpha (…, 1)."""
        return tuple(each * opacity for each in values)

    def colour_channels(self, found: ColourChannels) -> ColourChannels:
        """How the colour channels that a part has are read: by default as they were found."""
        return found

    def decoder(self, part: Part) -> ReadColours:
        """Conversion of the numbers of a part to linear RGB, by default in [0, 1]."""
        return make_decoder(self.sensor, part, self.encoding, self.out_of_gamut, self.space)

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        """Yield the conversion of rows of an image: by default `convert`, wherever they are."""
        yield lambda part, first, rgb: self.convert(rgb)


@dataclass(frozen=True, eq=False)
class Uplifter(Converter):
    """A converter of colours to spectra, made by `prepare`, for any number of images.

    ``sample`` maps linear RGB (…, 3) to the numbers (…, N) of a pixel, which ``is_linear`` if they are linear in the
    spectrum. ``rgb_error`` maps it to the largest error (…, 1) of the spectrum's colour; None without unrealisable
    nodes.
    """

    cube: Cube
    sample: Sampler
    rgb_error: Sampler | None
    is_linear: bool

    def convert(self, rgb: Floats) -> Converted:
        is_off = 0 if self.rgb_error is None else (self.rgb_error(rgb) > self.cube.data.threshold).sum()
        return (rgb, self.sample(rgb)), Counts(unrealisable=int(is_off))

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        rgb, numbers = values
        return rgb * opacity, numbers * opacity if self.is_linear else numbers


def prepare(
    cube: Cube,
    pixel_encoding: PixelEncoding | None = None,
    *,
    depth: str | None = None,
    encoding: str = "auto",
    out_of_gamut: str = "clip",
    space: str | None = None,
    threads: int = 2,
) -> Uplifter:
    """Prepare a cube for textures.

    Parameters
    ----------
    cube : Cube
        The cube.
    pixel_encoding : PixelEncoding, optional
        `Spectrum` (the default), `Moments` or `Multipliers`.
    depth : {"half", "float"}, optional
        Type of the channels, by default the smallest that is precise enough.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers in images; ``auto`` takes integers as encoded, floats as linear.
    out_of_gamut : str
        Gamut mapping for pixels outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.
    space : str, optional
        RGB space of images, as for `uplift.colorimetry.spaces.find_space`, by default the one that each file states.
    threads : int
        Threads that share a band.

    Returns
    -------
    Uplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        The depth is not precise enough, the cube has no moments, the wavelengths do not ascend, or the encoding or
        gamut mapping is unknown.
    UnknownNameError
        The RGB space is unknown.
    """
    pixels = Spectrum() if pixel_encoding is None else pixel_encoding
    depth = pixels.depths[0] if depth is None else depth
    if depth not in pixels.depths:
        raise OptionError(
            f"depth of {pixels.name} must be {' or '.join(pixels.depths)}, got '{depth}'",
            code="unsupported-depth",
            hint="other types are not precise enough",
        )
    check_encoding(encoding)
    check_method(out_of_gamut)
    channels = pixels.channels(cube)
    settings = {"depth": depth, "encoding": encoding, "out_of_gamut": out_of_gamut}
    settings |= {} if space is None else {"space": space}
    description = json.dumps({**pixels.describe(cube), **settings}, allow_nan=False)
    header = {**exr.attributes(cube.data), "uplift.texture": description, **pixels.header}
    return Uplifter(
        cube.data.sensor,
        depth,
        encoding,
        out_of_gamut,
        channels,
        header,
        cube,
        sample=pixels.make_sampler(cube, threads),
        rgb_error=_rgb_error(cube, threads),
        is_linear=pixels.is_linear,
        space=None if space is None else find_space(space),
    )


def _rgb_error(cube: Cube, threads: int) -> Sampler | None:
    from uplift.lookup import bulk

    has_unrealisable = (cube.data.points.status == Status.UNREALISABLE).any()
    return bulk.max_rgb_error(cube, threads=threads) if has_unrealisable else None


@dataclass(frozen=True, eq=False)
class MaskedUplifter(Converter):
    """A converter of colours to the spectra of n cubes, chosen by an image, made by `prepare_masked`."""

    uplifters: tuple[Uplifter, ...]
    mask: Path

    @contextlib.contextmanager
    def opened(self, image: Image) -> Iterator[ConvertRows]:
        sizes = dict.fromkeys((part.window.width, part.window.height) for part, _ in coloured_parts(image))
        with contextlib.ExitStack() as stack:  # a mask that fits one size only is an error for the other
            mask, *_ = [stack.enter_context(open_mask(self.mask, len(self.uplifters), size)) for size in sizes]
            yield lambda part, first, rgb: self.mix(rgb, mask.rows(first - part.window.y, len(rgb)))

    def convert(self, rgb: Floats) -> Converted:
        return self.uplifters[0].convert(rgb)

    def mix(self, rgb: Floats, weights: Floats) -> Converted:
        """Uplift linear RGB (k, width, 3) in [0, 1] by the cubes, with weights (k, width, n) of sum 1."""
        first = self.uplifters[0]
        is_mixed = weights.max(axis=-1) < 1 if not first.is_linear else np.zeros(rgb.shape[:2], dtype=bool)
        values = np.zeros((*rgb.shape[:2], len(self.channels)), dtype=np.float32)
        moments = np.zeros((np.count_nonzero(is_mixed), len(self.channels)))
        counts = Counts()
        for uplifter, weight in zip(self.uplifters, np.moveaxis(weights, -1, 0), strict=True):
            rows = weight > 0
            if not rows.any():
                continue
            (_, found), counted = uplifter.convert(rgb[rows])
            counts += counted
            mixed, shared = is_mixed[rows], rows[is_mixed]
            values[rows & ~is_mixed] += weight[rows & ~is_mixed][:, None] * found[~mixed]
            if mixed.any():
                parts = uplifter.cube.data.model.to_storage(found[mixed].astype(float))
                moments[shared] += weight[is_mixed][shared][:, None] * parts
        if len(moments):
            data = first.cube.data
            start = data.model.from_storage(moments)
            values[is_mixed] = refine_to_rgb(data, data.model, start, rgb[is_mixed].astype(float))
        return (rgb, values), counts

    def multiply(self, values: tuple[Floats, ...], opacity: Floats) -> tuple[Floats, ...]:
        return self.uplifters[0].multiply(values, opacity)


def prepare_masked(uplifters: Sequence[Uplifter], mask: Path) -> MaskedUplifter:
    """Prepare several cubes for textures.

    Parameters
    ----------
    uplifters : sequence of Uplifter
        Uplifters of at least two cubes, with the same pixel encoding.
    mask : Path
        Image of which cube a pixel belongs to; see `uplift.io.texture.mask`.

    Returns
    -------
    MaskedUplifter
        The converter to pass to `convert`.

    Raises
    ------
    OptionError
        One cube only, cubes of different spaces, or with different channels or, for moments and multipliers, models.
    TextureError
        The mask cannot be read.
    """
    if len(uplifters) < 2:
        raise OptionError(
            f"a mask chooses among at least two cubes, got {len(uplifters)}",
            hint="name the cubes in the order of the numbers in the mask",
        )
    first = uplifters[0]
    common_sensor(each.cube for each in uplifters)
    is_model_stored = first.channels[0][:1].islower()
    models = {json.dumps(each.cube.data.model.describe(), sort_keys=True) for each in uplifters}
    if len({each.channels for each in uplifters}) > 1 or (is_model_stored and len(models) > 1):
        raise OptionError(
            "cubes of one texture must have the same wavelengths or, for moments and multipliers, the same model",
            hint="write spectra at given wavelengths, or build the cubes with the same options",
        )
    check_regular(mask, TextureError, hint="name an image")
    with mask.open("rb") as file:
        mask_digest = hashlib.file_digest(file, "sha256").hexdigest()
    digests = [each.header["uplift.cube"] for each in uplifters]
    description = json.loads(first.header["uplift.texture"]) | {"cubes": digests, "mask": mask_digest}
    header = {**first.header, "uplift.cube": ", ".join(digests), "uplift.texture": json.dumps(description)}
    settings = {each.name: getattr(first, each.name) for each in fields(Converter)}
    return MaskedUplifter(**settings | {"header": header}, uplifters=tuple(uplifters), mask=mask)
