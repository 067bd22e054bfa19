"""OpenEXR files: spectral textures, as `uplift texture` writes them, and images of colours, as it reads them."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask
from uplift.common.errors import TextureError, UpliftError, UpliftWarning
from uplift.io.mitsuba.texels import THREADS, Samples, Texels, model_texels
from uplift.io.texture import exr_file
from uplift.io.texture.channels import ColourChannels, colour_channels_by_part
from uplift.io.texture.colours import Counts, Floats, make_decoder, space_warnings
from uplift.io.texture.image import Image, Part, open_image
from uplift.io.texture.lights import prepare_lights
from uplift.io.texture.uplifter import ReadColours
from uplift.lights.lookup import EmissionTable
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


def read_colours(path: Path, sensor: Sensor, method: str) -> tuple[Floats, tuple[UpliftWarning, ...]]:
    """Read linear RGB (h, w, 3) in [0, 1] of an OpenEXR image, as `uplift texture` does, and its warnings.

    The first part with colours counts, other channels do not. Raises `TextureError` and `ColourError`.
    """
    with open_image(path) as image:
        part, channels = _first_colours(image)
        rgb, counts = _decoded(image, part, channels, make_decoder(sensor, part, "auto", method))
        return rgb, (*space_warnings(image, sensor), *counts.warnings(method, path))


def read_lights(path: Path, table: EmissionTable) -> tuple[Floats, tuple[UpliftWarning, ...]]:
    """Read linear RGB (h, w, 3) of the lights in an image, as `uplift lights texture` does, and its warnings.

    Raises `TextureError` and `OptionError`.
    """
    converter = prepare_lights(table, threads=THREADS)
    with open_image(path) as image:
        part, found = _first_colours(image)
        rgb, counts = _decoded(image, part, converter.colour_channels(found), converter.decoder(part))
        return rgb, (*space_warnings(image, converter.sensor), *counts.warnings(path=path))


def _first_colours(image: Image) -> tuple[Part, ColourChannels]:
    """Return the first part with colours."""
    parts = colour_channels_by_part(image)
    return next((part, channels) for part, channels in parts if channels is not None)


def _decoded(image: Image, part: Part, channels: ColourChannels, decode: ReadColours) -> tuple[Floats, Counts]:
    bands, counts = [], Counts()
    for _, rows in image.bands(part):
        rgb, changed = decode(channels.straight(rows))
        bands.append(rgb)
        counts += changed
    return np.concatenate(bands), counts


def _read(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    import OpenEXR

    try:
        part = OpenEXR.File(str(path), separate_channels=True).parts[0]
    except (RuntimeError, IndexError) as error:
        raise TextureError(
            "the OpenEXR file is damaged or incomplete",
            path=path,
            hint="write the file again",
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
            "the numbers of a texture must be finite",
            path=path,
            hint="write the texture again with 'uplift texture'",
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
    try:
        model = from_description(json.loads(header["uplift.model"]))
    except (KeyError, TypeError, ValueError, UpliftError) as error:
        raise _missing_model(path) from error
    if model.count != count:
        raise _missing_model(path)
    return model


def _missing_model(path: Path) -> TextureError:
    return TextureError(
        "the header of a texture must describe the model of its channels in uplift.model",
        path=path,
        hint="write the texture with 'uplift texture', and keep its header in other programs",
    )


def multipliers_of_rounded(model: Moments, moments: Array, shares: Sequence[float] = GREY_SHARES) -> tuple[Array, Mask]:
    """Return multipliers (n, C) of moments (n, C) that were rounded or filtered, and their validity (n,).

    Rounding can move moments of saturated colours out of the moment space. They are mixed with the least of
    ``shares`` of grey that returns them.
    """
    multipliers, valid = model.try_from_storage(moments)
    grey = np.eye(model.count)[0] / 2
    for share in shares:
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
