"""OpenEXR files: spectral textures, as `uplift texture` writes them, and images of colours, as it reads them."""

import contextlib
import json
import re
from functools import partial
from pathlib import Path

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import TextureError, UpliftError, UpliftWarning
from uplift.io.mitsuba.texels import THREADS, Samples, Texels, model_texels
from uplift.io.texture import exr_file
from uplift.io.texture.colours import Counts, Floats, coloured_parts, space_warnings
from uplift.io.texture.image import Image, Values, open_image
from uplift.io.texture.uplifter import Converter
from uplift.lookup.blocks import blockwise
from uplift.models import Moments, from_description
from uplift.models.model import Model
from uplift.models.moments import multipliers_of_rounded

QUANTITIES = ("T", "S0")
"""Beginnings of the names of channels of reflectance and of power in the layout of Fichet et al. 2021."""
WAVELENGTH = re.compile(r"(\d+)(?:,(\d+))?nm")
NUMBERED = re.compile(r"(moment|multiplier)\.\d+")
EVEN = 1e-3
"""Tolerance of equidistant wavelengths in nm."""


def read_texels(path: Path) -> Texels | None:
    """Read a spectral texture; None if the file is not OpenEXR, or has no channels of spectra, moments or multipliers.

    Raises `TextureError` if its numbers are not finite or not moments of a reflectance, its wavelengths not
    equidistant, or its header lacks the description of the model.
    """
    if not (path.is_file() and exr_file.is_exr(path)):
        return None
    with open_image(path) as image:
        channels = image.parts[0].channels
        spectral = next(filter(None, (_spectral_channels(channels, each) for each in QUANTITIES)), None)
        if spectral:
            wavelengths = np.array(sorted(spectral))
            numbers = _numbers(image, [spectral[each] for each in wavelengths])
            return Texels(_samples(wavelengths), numbers, float(numbers.mean(dtype=float)))
        numbered = sorted(name for name in channels if NUMBERED.fullmatch(name))
        if not numbered:
            return None
        model, numbers = _model(image.header_text("uplift.model"), len(numbered)), _numbers(image, numbered)
        if numbered[0].startswith("moment"):
            assert isinstance(model, Moments)
            numbers = blockwise(partial(_multipliers, model), numbers, model.count, np.float32, THREADS)
        return model_texels(model, numbers)


def read_colours(path: Path, converter: Converter) -> tuple[Floats, Counts, tuple[UpliftWarning, ...]]:
    """Read linear RGB (h, w, 3) of an image as `uplift.io.texture.convert` does, with counts and warnings of its space.

    The first part with colours counts, other channels do not. Raises `TextureError`, `ColourError` and `OptionError`.
    """
    with open_image(path) as image:
        part, found = coloured_parts(image)[0]
        channels, decode = converter.colour_channels(found), converter.decoder(part)
        bands, counts = zip(*(decode(channels.straight(rows)) for _, rows in image.bands(part)), strict=True)
        return np.concatenate(bands), sum(counts, Counts()), space_warnings(image, converter.sensor)


def _spectral_channels(channels: tuple[str, ...], quantity: str) -> dict[float, str]:
    """Return the names of the channels of a quantity by wavelength in nm."""
    ends = {name: WAVELENGTH.fullmatch(name.removeprefix(f"{quantity}.")) for name in channels}
    return {float(f"{end[1]}.{end[2] or 0}"): name for name, end in ends.items() if end and name[0] == quantity[0]}


def _numbers(image: Image, names: list[str]) -> Values:
    """Return the channels (h, w, C) of these names."""
    part = image.parts[0]
    places = [part.channels.index(name) for name in names]
    numbers = np.concatenate([rows[..., places].astype(np.float32) for _, rows in image.bands(part)])
    if not np.isfinite(numbers).all():
        raise TextureError("numbers of a texture must be finite", hint="write it again with 'uplift texture'")
    return numbers


def _samples(wavelengths: Array) -> Samples:
    even = np.linspace(wavelengths[0], wavelengths[-1], len(wavelengths))
    if len(wavelengths) < 2 or np.abs(wavelengths - even).max() > EVEN:
        raise TextureError(
            "wavelengths of a spectral texture must be at least two and equidistant",
            hint="write the texture with --wavelengths START:END:STEP",
        )
    return Samples(float(wavelengths[0]), float(wavelengths[-1]), len(wavelengths))


def _model(description: str, count: int) -> Model:
    with contextlib.suppress(KeyError, TypeError, ValueError, UpliftError):
        model = from_description(json.loads(description))
        if model.count == count:
            return model
    raise TextureError(
        "the header of a texture must describe the model of its channels in uplift.model",
        hint="write the texture with 'uplift texture', and keep its header in other programs",
    )


def _multipliers(model: Moments, moments: Array) -> Array:
    multipliers, valid = multipliers_of_rounded(model, moments.astype(float))
    if not valid.all():
        raise TextureError(
            "the moments of a texel belong to no reflectance in [0, 1]",
            hint="write the texture with --depth float, and do not sharpen it",
        )
    return multipliers
