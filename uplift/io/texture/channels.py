"""Channels that hold the colours of a part, and colours multiplied by alpha, as OpenEXR stores them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.errors import TextureError
from uplift.io.texture.image import Image, Part, Values

COLOUR_TYPES = {"uint8", "uint16", "half", "float", "double"}
HALF_ROUNDING = 1e-3
"""Linear RGB by which half floats, converted or divided by one another, can leave [0, 1] by rounding."""


@dataclass(frozen=True)
class ColourChannels:
    """Indices of red, green and blue, all the same for a grey image, and of the alpha that multiplies them, if any."""

    rgb: tuple[int, int, int]
    alpha: int | None = None

    def straight(self, values: Values) -> Values:
        """Return the colours (…, 3) of values (…, channels), divided by alpha if they are multiplied by it.

        Where alpha is 0, black stays black and other colours are infinite. Integers are rounded, and limited to the
        largest.
        """
        colours = values[..., self.rgb]
        if self.alpha is None:
            return colours
        alpha = values[..., [self.alpha]]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            divided = np.where(colours == 0, 0, colours / alpha)
        if np.issubdtype(values.dtype, np.integer):
            top = np.iinfo(values.dtype).max
            return np.rint(np.minimum(divided, 1) * top).astype(values.dtype)
        return without_rounding(divided)

    def opacity(self, values: Values) -> NDArray[np.float32] | None:
        """Return what to multiply converted colours by, (…, 1) in [0, 1]; None if they were not divided.

        Where alpha is NaN, the opacity is 0.
        """
        if self.alpha is None:
            return None
        alpha = values[..., [self.alpha]]
        scale = np.iinfo(alpha.dtype).max if np.issubdtype(alpha.dtype, np.integer) else 1
        return np.clip(np.nan_to_num(alpha / scale, nan=0.0), 0, 1).astype(np.float32)


def without_rounding(rgb: Values) -> Values:
    """Clip colours that lie outside [0, 1] by no more than the rounding of half floats."""
    inside = np.clip(rgb, 0, 1)
    is_rounding = np.abs(rgb - inside).max(axis=-1, keepdims=True) <= HALF_ROUNDING
    return np.where(is_rounding, inside, rgb)


def colour_channels(part: Part) -> ColourChannels | None:
    """Find the colour channels of a part: R, G, B, else those of the only layer that has them, else Y; or None.

    Raises `TextureError` for several layers of colours, and for integers of unknown scale.
    """
    layers = [name[:-1] for name in part.channels if name == "R" or name.endswith(".R")]
    layers = [layer for layer in layers if {layer + "G", layer + "B"} <= set(part.channels)]
    if "" in layers:
        layers = [""]
    if len(layers) > 1:
        found = ", ".join(layer[:-1] for layer in layers)
        raise TextureError(
            f"a part must have one layer of colour, got {found}", hint="write each layer as a part or a file"
        )
    if layers:
        names, alpha = [layers[0] + letter for letter in "RGB"], layers[0] + "A"
    elif "Y" in part.channels and not {"RY", "BY"} & set(part.channels):  # luminance, not luma with chroma
        names, alpha = ["Y"] * 3, "A"
    else:
        return None
    red, green, blue = map(part.channels.index, names)
    if types := {part.types[channel] for channel in (red, green, blue)} - COLOUR_TYPES:
        raise TextureError(
            f"colour channels must be 8-bit, 16-bit, half or float, got {min(types)}", hint="convert them"
        )
    is_multiplied = part.has_associated_alpha and alpha in part.channels
    return ColourChannels((red, green, blue), part.channels.index(alpha) if is_multiplied else None)


def colour_channels_by_part(image: Image) -> list[tuple[Part, ColourChannels | None]]:
    """Return every part and its colour channels. Raises `TextureError` if no part has any."""
    parts = [(part, colour_channels(part)) for part in image.parts]
    if not any(colours for _, colours in parts):
        names = ", ".join(dict.fromkeys(name for part in image.parts for name in part.channels))
        raise TextureError(f"no colour channels among {names}", hint="name them R, G and B, or Y")
    return parts


def coloured_parts(image: Image) -> list[tuple[Part, ColourChannels]]:
    """Return the parts that have colours, at least one. Raises `TextureError`."""
    return [(part, colours) for part, colours in colour_channels_by_part(image) if colours is not None]
