"""Colour channels of an image: which they are, and their division by alpha."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from uplift.common.arrays import Floats, Mask, Values
from uplift.common.errors import OptionError, TextureError
from uplift.extras.images.image import Image, Part

COLOUR_TYPES = {"uint8", "uint16", "half", "float", "double"}
BRIGHTEST = 65504.0
"""The largest half float. Colours that alpha would make brighter are light, and not
divided.
"""
HALF_ROUNDING = 1e-3
"""Linear RGB by which half floats, converted or divided by one another, can leave [0,
1] by rounding.
"""
VECTORS = re.compile(
    r"(.*[._ "
    r"])?(n|ns|ng|p|po|pos|pref|uv)|.*(normal|position|vector|velocity|motion|tangent|world).*",
    re.I,
)
"""Names of layers of renderers whose X, Y and Z are vectors, not CIE XYZ."""
SPECTRAL = re.compile(r"(T|S[0-3])\.\d+,\d+nm|(moment|multiplier)\.\d+")
"""Names of channels of spectral images and textures."""
XYZ = {"X", "Y", "Z"}
CHROMA = {"RY", "BY"}


@dataclass(frozen=True)
class ColourChannels:
    """Indices of the colour channels, and of the alpha that multiplies them, if any.

    ``rgb`` are red, green and blue, all the same for a grey image, or CIE XYZ if
    ``is_xyz``. ``coverage`` is the alpha, whether or not it multiplies colours.
    """

    rgb: tuple[int, int, int]
    alpha: int | None = None
    is_xyz: bool = False
    coverage: int | None = None

    def visible(self, values: Values) -> Mask:
        """Return which pixels (…) of values (…, channels) are not transparent. Light of
        alpha 0 is visible.
        """
        if self.coverage is None:
            return np.ones(values.shape[:-1], dtype=bool)
        channels = [self.coverage] if self.alpha is None else [*self.rgb, self.alpha]
        return np.asarray(values[..., channels].any(axis=-1))

    def straight(self, values: Values) -> Values:
        """Return the colours (…, 3) of values (…, channels), divided by alpha if they
        are multiplied by it.

        Light without opacity, such as a glow of alpha 0, is not divided. Integers are
        rounded, and limited to the largest.
        """
        colours = values[..., self.rgb]
        if self.alpha is None:
            return colours
        alpha = values[..., [self.alpha]]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            divided = np.where(colours == 0, 0, colours / alpha)
        is_light = self._is_light(values)
        if np.issubdtype(values.dtype, np.integer):
            top = np.iinfo(values.dtype).max
            codes = np.rint(np.minimum(divided, 1) * top)
            return np.where(is_light, colours, codes).astype(values.dtype)
        straight = np.where(is_light, colours, divided)
        return straight if self.is_xyz else without_rounding(straight)

    def opacity(self, values: Values) -> Floats | None:
        """Return the factor (…, 1) in [0, 1] of converted colours; None if no colours
        are divided.

        It is 0 for NaN, and 1 for colours that `straight` does not divide.
        """
        if self.alpha is None:
            return None
        alpha = values[..., [self.alpha]]
        is_integer = np.issubdtype(alpha.dtype, np.integer)
        scale = np.iinfo(alpha.dtype).max if is_integer else 1
        with np.errstate(invalid="ignore"):  # signalling NaN
            opacity = np.clip(np.nan_to_num(alpha / scale, nan=0.0), 0, 1)
        return np.where(self._is_light(values), 1, opacity).astype(np.float32)

    def _is_light(self, values: Values) -> Mask:
        """Return the mask (…, 1) of finite colours that alpha would make brighter than
        half floats hold.
        """
        assert self.alpha is not None
        with np.errstate(invalid="ignore"):  # signalling NaN
            colours = np.abs(values[..., self.rgb].astype(float))
            alpha = np.abs(values[..., [self.alpha]].astype(float))
        brightest = colours.max(axis=-1, keepdims=True)
        return (brightest > BRIGHTEST * alpha) & np.isfinite(brightest)


def without_rounding(rgb: Values, tolerance: float = HALF_ROUNDING) -> Values:
    """Clip colours that lie outside [0, 1] by no more than rounding."""
    if all_inside(rgb):
        return rgb
    inside = np.clip(rgb, 0, 1)
    is_rounding = np.abs(rgb - inside).max(axis=-1, keepdims=True) <= tolerance
    return np.where(is_rounding, inside, rgb)


def all_inside(colours: Values) -> bool:
    """Return whether there are colours, and all are in [0, 1]."""
    return bool(
        colours.size and colours.min() >= 0 and colours.max() <= 1
    )  # NaN fails both


def colour_channels(part: Part) -> ColourChannels | None:
    """Find the colour channels of a part: R, G and B, else X, Y and Z (CIE XYZ), else a
    grey Y; or None.

    R, G and B, and X, Y and Z, may be those of a layer, if it is the only one that has
    them. Raises `TextureError` for several layers of colours, and for integers of
    unknown scale.
    """
    names, alpha = _colour_names(part)
    if not names:
        return None
    first, second, third = map(part.channels.index, names)
    types = {part.types[first], part.types[second], part.types[third]} - COLOUR_TYPES
    if types:
        raise TextureError(
            f"colour channels must be 8-bit, 16-bit, half or float, got {min(types)}",
            hint="convert them",
        )
    coverage = part.channels.index(alpha) if alpha in part.channels else None
    return ColourChannels(
        (first, second, third),
        coverage if part.has_associated_alpha else None,
        is_xyz=names[0].endswith("X"),
        coverage=coverage,
    )


def is_xyz(part: Part) -> bool:
    """Return whether the colours of a part are CIE XYZ."""
    channels = colour_channels(part)
    return channels is not None and channels.is_xyz


def _colour_names(part: Part) -> tuple[list[str], str]:
    """Return the names of the colour channels, none if there are none, and the name of
    their alpha.
    """
    for letters in ("RGB", "XYZ"):
        layers = _layers(part, letters)
        if len(layers) > 1:
            names = ", ".join(layer[:-1] for layer in layers)
            raise TextureError(
                f"a part must have one layer of colour, got {names}",
                hint="write each layer as a part",
            )
        if layers:
            return [layers[0] + letter for letter in letters], layers[0] + "A"
    is_grey = "Y" in part.channels and not (XYZ - {"Y"} | CHROMA) & set(part.channels)
    return (["Y"] * 3 if is_grey else []), "A"


def _layers(part: Part, letters: str) -> list[str]:
    """Return the layers with channels of these letters, ``foo.`` for ``foo.R``; only ""
    if the part itself has them.
    """
    names = set(part.channels)
    first = letters[0]
    others = letters[1:]
    ends = [
        name[:-1]
        for name in part.channels
        if name == first or name.endswith(f".{first}")
    ]
    layers = [layer for layer in ends if names.issuperset(map(layer.__add__, others))]
    if letters == "XYZ":
        layers = [
            layer for layer in layers if not VECTORS.fullmatch(layer.removesuffix("."))
        ]
    return [""] if "" in layers else layers


def colour_channels_by_part(image: Image) -> list[tuple[Part, ColourChannels | None]]:
    """Return every part and its colour channels. Raises `TextureError` if no part has
    any.
    """
    parts = [(part, colour_channels(part)) for part in image.parts]
    if not any(colours for _, colours in parts):
        names = dict.fromkeys(
            chain.from_iterable(part.channels for part in image.parts)
        )
        if set(names) & CHROMA:
            hint = (
                "convert luminance and chroma to R, G and B, or remove the chroma for "
                "a grey image"
            )
        else:
            hint = (
                "name them R, G and B, or X, Y and Z for CIE XYZ, or Y alone for a "
                "grey image"
            )
        raise TextureError(f"no colour channels among {', '.join(names)}", hint=hint)
    return parts


def coloured_parts(image: Image) -> list[tuple[Part, ColourChannels]]:
    """Return the parts that have colours, at least one. Raises `TextureError`."""
    return [
        (part, colours)
        for part, colours in colour_channels_by_part(image)
        if colours is not None
    ]


def channel_names(lights: Sequence[str]) -> list[str]:
    """Return the names of lights as parts of the names of channels. Raises
    `OptionError` for two that become one name.

    >>> channel_names(["FL3.1", "my lamp"])
    ['FL3_1', 'my_lamp']
    """
    names = [re.sub(r"[^\w-]", "_", light) for light in lights]
    if len(set(names)) < len(names):
        problem = f"two lights have one name of a channel, got {', '.join(names)}"
        raise OptionError(problem, hint="rename one of the lamps")
    return names
