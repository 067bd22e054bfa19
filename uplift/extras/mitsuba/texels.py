"""Texels: the numbers of their spectra, uplifted from RGB or read from spectral
textures, and where they lie.
"""

import contextlib
import json
import re
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Floats, Values
from uplift.common.errors import TextureError, UpliftError, UpliftWarning, unknown_name
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.images import exr_file
from uplift.extras.images.channels import coloured_parts
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, open_image
from uplift.extras.images.reader import Reader
from uplift.extras.texture.encodings import Multipliers
from uplift.extras.texture.uplifter import Uplifter, prepare
from uplift.lookup.blocks import blockwise
from uplift.lookup.cube import Cube
from uplift.models.duality import blended_multipliers
from uplift.models.model import Model, evaluate
from uplift.models.moments import Moments
from uplift.models.registry import from_description

MEAN_WAVELENGTHS = np.arange(380.0, 781.0, 25.0)
"""Wavelengths in nm of the mean reflectance, by which Mitsuba chooses between lobes; it
need not be exact.
"""
THREADS = 2
PADDING = 1
"""Texels around the padded image, which repeat those of the other edge or of the same,
as the mode beyond requires.
"""
FILTERS = ("bilinear", "nearest", "stochastic")
WRAPS = {"repeat": "wrap", "mirror": "symmetric", "clamp": "edge"}
"""Modes beyond the edges, and the modes of `numpy.pad` for them."""
QUANTITIES = ("T", "S0")
"""Beginnings of the names of channels of reflectance and of power in the layout of
Fichet et al. 2021.
"""
WAVELENGTH = re.compile(r"(\d+)(?:,(\d+))?nm")
NUMBERED = re.compile(r"(moment|multiplier)\.\d+")
GREY_WEIGHTS = (1e-8, 1e-6, 1e-4, 1e-3, 1e-2)
"""Weights of grey that rounded moments are mixed with, in turn, until they are those of
a reflectance.
"""
EVEN = 1e-3
"""Tolerance of equidistant wavelengths in nm."""


@dataclass(frozen=True)
class Samples:
    """Reflectances, or powers, at ``count`` even wavelengths from ``start`` to ``end``
    nm, constant outside.
    """

    start: float
    end: float
    count: int
    name = "samples"


@dataclass(frozen=True, eq=False)
class Texels:
    """Numbers (h, w, C), float32, of the texels' spectra, and the mean reflectance.

    The numbers are the multipliers of a model, or reflectances or powers if ``model``
    is `Samples`.
    """

    model: Model | Samples
    numbers: Floats
    mean: float

    def describe(self, wrap: str) -> str:
        """Return a summary for Mitsuba, with the mode beyond the edges."""
        height, width, count = self.numbers.shape
        numbers = "samples" if isinstance(self.model, Samples) else "multipliers"
        return (
            f"UpliftTexture[{width} × {height}, {self.model.name}, {count} {numbers}, "
            f"{wrap}]"
        )


def prepare_texels(cube: Cube, method: str, *, of_entries: bool = False) -> Uplifter:
    """Prepare a cube for texels, with as many multipliers as its nodes or
    ``of_entries`` have.
    """
    return prepare(cube, Multipliers(of_entries), out_of_gamut=method, threads=THREADS)


def uplift_texels(uplifter: Uplifter, rgb: Floats) -> tuple[Texels, Counts]:
    """Uplift linear RGB (h, w, 3) of its decoder to multipliers of spectra that have
    exactly these colours.

    All texels have one number of multipliers: that of the cube's entries if a texel
    lies in the box of an entry, else that of its nodes.
    """
    data = uplifter.cube.data
    colours = rgb.reshape(-1, 3).astype(float)
    inside = data.entry_boxes.find(colours.clip(0, 1)).rows
    if inside.size or data.outside_boxes.find(colours).rows.size:
        method = uplifter.reader.out_of_gamut
        uplifter = prepare_texels(uplifter.cube, method, of_entries=True)
    assert uplifter.pixels.model is not None
    _, multipliers, counts = uplifter.numbers(rgb)
    return model_texels(uplifter.pixels.model, multipliers), counts


def model_texels(model: Model, multipliers: Values) -> Texels:
    """Return texels of multipliers (h, w, C)."""
    means = blockwise(
        lambda rows: evaluate(model, rows, MEAN_WAVELENGTHS).mean(
            axis=1, keepdims=True
        ),
        multipliers,
        1,
    )
    return Texels(model, multipliers, float(means.mean()))


def light_texels(table: EmissionTable, rgb: Array) -> Texels:
    """Uplift linear RGB (h, w, 3) of lights to power; colours that no light has are
    moved towards white.

    Raises `ColourError` for values that are not finite.
    """
    at = table.wavelengths
    power = table.spectrum(rgb, outside="clip", dtype=np.float32, threads=THREADS)
    return Texels(
        Samples(float(at[0]), float(at[-1]), len(at)),
        power,
        float(power.mean(dtype=float)),
    )


@dataclass(frozen=True, eq=False)
class Placement:
    """How texels lie on a surface: filter, mode beyond the edges, and transform (3, 3)
    of the coordinates.
    """

    filter: str
    wrap: str
    to_uv: Array

    @staticmethod
    def read(props: Any) -> "Placement":
        """Read the properties ``filter_type``, ``wrap_mode`` and ``to_uv``. Raises
        `UnknownNameError`.
        """
        matrix = (
            np.array(props["to_uv"].matrix, dtype=float)
            if "to_uv" in props
            else np.eye(3)
        )
        axes = [0, 1, len(matrix) - 1]  # Mitsuba also accepts (4, 4)
        chosen = (
            _choice(props, "filter_type", FILTERS),
            _choice(props, "wrap_mode", tuple(WRAPS)),
        )
        return Placement(*chosen, matrix[np.ix_(axes, axes)])

    def pad(self, numbers: Floats) -> Floats:
        """Return numbers (h, w, C) with `PADDING` texels around them, so that no lookup
        needs to wrap.
        """
        return np.pad(
            numbers, ((PADDING, PADDING), (PADDING, PADDING), (0, 0)), WRAPS[self.wrap]
        )  # type: ignore[call-overload]


def _choice(props: Any, name: str, choices: tuple[str, ...]) -> str:
    """Return a property; the first choice is the default."""
    chosen = str(props.get(name, choices[0]))
    if chosen not in choices:
        raise unknown_name(chosen, choices, name)
    return chosen


def read_texels(path: Path) -> Texels | None:
    """Read a spectral texture; None if the file is not OpenEXR, or has no channels of
    spectra, moments or multipliers.

    Raises `TextureError` if its numbers are not finite or not moments of a reflectance,
    its wavelengths not equidistant, or its header lacks the description of the model.
    """
    if not (path.is_file() and exr_file.is_exr(path)):
        return None
    with open_image(path) as image:
        channels = image.parts[0].channels
        spectral = next(
            filter(
                None,
                (_spectral_channels(channels, quantity) for quantity in QUANTITIES),
            ),
            None,
        )
        if spectral:
            wavelengths = np.array(sorted(spectral))
            numbers = _numbers(image, [spectral[quantity] for quantity in wavelengths])
            return Texels(
                _samples(wavelengths), numbers, float(numbers.mean(dtype=float))
            )
        numbered = sorted(name for name in channels if NUMBERED.fullmatch(name))
        if not numbered:
            return None
        model = _model(image.header_text("uplift.model"), len(numbered))
        numbers = _numbers(image, numbered)
        if numbered[0].startswith("moment"):
            assert isinstance(model, Moments)
            numbers = blockwise(
                partial(_multipliers, model), numbers, model.count, np.float32, THREADS
            )
        return model_texels(model, numbers)


def read_colours(
    path: Path, reader: Reader
) -> tuple[Floats, Counts, tuple[UpliftWarning, ...]]:
    """Read linear RGB (h, w, 3) of an image as `uplift.extras.texture.convert` does,
    with counts and warnings of its space.

    The first part with colours counts, other channels do not. Raises `TextureError`,
    `ColourError` and `OptionError`.
    """
    with open_image(path) as image:
        part, colours = coloured_parts(image)[0]
        channels = reader.channels(colours)
        decode = reader.decoder(part)
        counts = Counts()
        bands = []
        for _, rows in image.bands(part):
            rgb, changed = decode(channels.straight(rows))
            bands.append(rgb)
            counts += changed
        return np.concatenate(bands), counts, reader.warnings(image)


def _spectral_channels(channels: tuple[str, ...], quantity: str) -> dict[float, str]:
    """Return the names of the channels of a quantity by wavelength in nm."""
    ends = {
        name: WAVELENGTH.fullmatch(name.removeprefix(f"{quantity}."))
        for name in channels
    }
    return {
        float(f"{end[1]}.{end[2] or 0}"): name
        for name, end in ends.items()
        if end and name[0] == quantity[0]
    }


def _numbers(image: Image, names: list[str]) -> Values:
    """Return the channels (h, w, C) of these names."""
    part = image.parts[0]
    places = [part.channels.index(name) for name in names]
    numbers = np.concatenate(
        [rows[..., places].astype(np.float32) for _, rows in image.bands(part)]
    )
    if not np.isfinite(numbers).all():
        raise TextureError(
            "numbers of a texture must be finite",
            hint="write it again with 'uplift texture'",
        )
    return numbers


def _samples(wavelengths: Array) -> Samples:
    even = np.linspace(wavelengths[0], wavelengths[-1], len(wavelengths))
    if len(wavelengths) < 2 or np.abs(wavelengths - even).max() > EVEN:
        raise TextureError(
            "wavelengths of a spectral texture must be at least two and equidistant",
            hint="write the texture with equidistant wavelengths",
        )
    return Samples(float(wavelengths[0]), float(wavelengths[-1]), len(wavelengths))


def _model(description: str, count: int) -> Model:
    with contextlib.suppress(KeyError, TypeError, ValueError, UpliftError):
        model = from_description(json.loads(description))
        if model.count == count:
            return model
    raise TextureError(
        "the header of a texture must describe the model of its channels in "
        "uplift.model",
        hint="write the texture with 'uplift texture', and keep its header in other "
        "programs",
    )


def _multipliers(model: Moments, moments: Array) -> Array:
    # Rounding can move moments of saturated colours out of the moment space.
    multipliers, valid = blended_multipliers(moments.astype(float), GREY_WEIGHTS)
    if not valid.all():
        raise TextureError(
            "the moments of a texel belong to no reflectance in [0, 1]",
            hint="write the texture with depth='float', and do not sharpen it",
        )
    return multipliers
