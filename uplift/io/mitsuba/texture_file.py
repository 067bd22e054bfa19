"""OpenEXR files: spectral textures, as `uplift texture` writes them, and images of colours, as it reads them."""

import contextlib
import json
import re
from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array, Mask
from uplift.common.errors import TextureError, UpliftError, UpliftWarning
from uplift.io.mitsuba.texels import THREADS, Samples, Texels, model_texels
from uplift.io.texture import exr_file
from uplift.io.texture.colours import Counts, Floats, coloured_parts, space_warnings
from uplift.io.texture.image import open_image
from uplift.io.texture.uplifter import Converter
from uplift.lookup.blocks import blockwise
from uplift.models import Moments, from_description
from uplift.models.model import Model

QUANTITIES = ("T", "S0")
"""Beginnings of the names of channels of reflectance and of power in the layout of Fichet et al. 2021."""
WAVELENGTH = re.compile(r"(\d+)(?:,(\d+))?nm")
NUMBERED = re.compile(r"(moment|multiplier)\.\d+")
GREY_SHARES = (1e-8, 1e-6, 1e-4, 1e-3, 1e-2)
EVEN = 1e-3
"""Tolerance of equidistant wavelengths in nm."""


def read_texels(path: Path) -> Texels | None:
    """Read a spectral texture; None if the file is not OpenEXR, or has no channels of spectra, moments or multipliers.

    Raises `TextureError` if its numbers are not finite or not moments of a reflectance, its wavelengths not
    equidistant, or its header lacks the description of the model.
    """
    if not (path.is_file() and exr_file.is_exr(path)):
        return None
    exr_file.check_size(path)
    header, channels = _read(path)
    spectral = next(filter(None, (_spectral_channels(channels, each) for each in QUANTITIES)), None)
    numbered = sorted(name for name in channels if NUMBERED.fullmatch(name))
    if spectral:
        wavelengths = np.array(sorted(spectral))
        numbers = _stack(path, channels, [spectral[each] for each in wavelengths])
        return Texels(_samples(path, wavelengths), numbers, float(numbers.mean(dtype=float)))
    if not numbered:
        return None
    model, numbers = _model(path, header, len(numbered)), _stack(path, channels, numbered)
    if numbered[0].startswith("moment"):
        assert isinstance(model, Moments)
        numbers = blockwise(partial(_multipliers, path, model), numbers, model.count, np.float32, THREADS)
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


def _read(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    import OpenEXR

    try:
        part = OpenEXR.File(str(path), separate_channels=True).parts[0]
    except (RuntimeError, IndexError) as error:
        raise TextureError(
            "the OpenEXR file is damaged or incomplete", path=path, hint="write the file again"
        ) from error
    return part.header, part.channels


def _spectral_channels(channels: Iterable[str], quantity: str) -> dict[float, str]:
    """Return the names of the channels of a quantity by wavelength in nm."""
    ends = {name: WAVELENGTH.fullmatch(name.removeprefix(f"{quantity}.")) for name in channels}
    return {float(f"{end[1]}.{end[2] or 0}"): name for name, end in ends.items() if end and name[0] == quantity[0]}


def _stack(path: Path, channels: dict[str, Any], names: list[str]) -> NDArray[Any]:
    numbers = np.stack([channels[name].pixels for name in names], axis=-1).astype(np.float32)
    if not np.isfinite(numbers).all():
        raise TextureError(
            "the numbers of a texture must be finite", path=path, hint="write the texture again with 'uplift texture'"
        )
    return numbers


def _samples(path: Path, wavelengths: Array) -> Samples:
    even = np.linspace(wavelengths[0], wavelengths[-1], len(wavelengths))
    if len(wavelengths) < 2 or np.abs(wavelengths - even).max() > EVEN:
        raise TextureError(
            "wavelengths of a spectral texture must be at least two and equidistant",
            path=path,
            hint="write the texture with --wavelengths START:END:STEP",
        )
    return Samples(float(wavelengths[0]), float(wavelengths[-1]), len(wavelengths))


def _model(path: Path, header: dict[str, Any], count: int) -> Model:
    with contextlib.suppress(KeyError, TypeError, ValueError, UpliftError):
        model = from_description(json.loads(header["uplift.model"]))
        if model.count == count:
            return model
    raise TextureError(
        "the header of a texture must describe the model of its channels in uplift.model",
        path=path,
        hint="write the texture with 'uplift texture', and keep its header in other programs",
    )


def multipliers_of_rounded(model: Moments, moments: Array) -> tuple[Array, Mask]:
    """Return multipliers (n, C) of moments (n, C) that were rounded or filtered, and their validity (n,).

    Rounding can move moments of saturated colours out of the moment space. They are mixed with the least of
    `GREY_SHARES` of grey that returns them.
    """
    multipliers, valid = model.try_from_storage(moments)
    grey = np.eye(model.count)[0] / 2
    for share in GREY_SHARES:
        if valid.all():
            break
        mixed = (1 - share) * moments[~valid] + share * grey
        multipliers[~valid], valid[~valid] = model.try_from_storage(mixed)
    return multipliers, valid


def _multipliers(path: Path, model: Moments, moments: Array) -> Array:
    multipliers, valid = multipliers_of_rounded(model, moments.astype(float))
    if not valid.all():
        raise TextureError(
            "the moments of a texel belong to no reflectance in [0, 1]",
            path=path,
            hint="write the texture with --depth float, and do not sharpen it",
        )
    return multipliers
