"""Which channels are the colour, and from what a file holds to linear RGB in [0, 1], with what was wrong counted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple, dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.errors import OptionError, TextureError
from uplift.lookup import Cube
from uplift.texture.source import Part, Values

Floats = NDArray[np.float32]
ENCODINGS = ("auto", "linear", "encoded")
GREY = ("Y",)


@dataclass(frozen=True)
class Counts:
    """Pixels, and those that were no colours: clamped, not finite, or such that no reflectance has them."""

    pixels: int = 0
    outside: int = 0
    not_finite: int = 0
    unrealisable: int = 0

    def __add__(self, other: Counts) -> Counts:
        return Counts(*(mine + its for mine, its in zip(astuple(self), astuple(other), strict=True)))

    def remarks(self) -> tuple[str, ...]:
        """What should be said of them."""
        all_of_them = f"of {self.pixels:,} pixels"
        said = {
            f"{self.outside:,} {all_of_them} lie outside [0, 1]: clamped": self.outside,
            f"{self.not_finite:,} {all_of_them} are not finite: NaN is taken for 0": self.not_finite,
            f"{self.unrealisable:,} {all_of_them} have colours that no reflectance has: "
            "their spectra have less chroma": self.unrealisable,
        }
        return tuple(text for text, count in said.items() if count)


def colour_channels(part: Part) -> tuple[int, int, int] | None:
    """Places of red, green and blue among a part's channels; a grey one is all three; None for no colour.

    That is R, G, B, else those of the only layer that has them, else Y. Raises `TextureError` for several layers.
    """
    layers = {name[:-1] for name in part.channels if name.endswith("R")}
    layers = {layer for layer in layers if all(layer + letter in part.channels for letter in "GB")}
    if "" in layers or len(layers) == 1:
        layer = "" if "" in layers else layers.pop()
        red, green, blue = (part.channels.index(layer + letter) for letter in "RGB")
        return red, green, blue
    if layers:
        names = ", ".join(sorted(layer[:-1] for layer in layers))
        raise TextureError(f"has several layers of colour: {names}", remedy="make each a part, or a file")
    if "Y" in part.channels and not {"RY", "BY"} & set(part.channels):
        grey = part.channels.index("Y")
        return grey, grey, grey
    return None


@dataclass(frozen=True, eq=False)
class Decoder:
    """From colours (…, 3) of a part to linear RGB, as `decoder` made it."""

    function: Callable[[Values], Floats]
    codes: bool

    def __call__(self, colours: Values) -> tuple[Floats, Counts]:
        """Linear RGB (…, 3) in [0, 1]: what lies outside is clamped, NaN becomes 0; and the counts."""
        pixels = colours.size // 3
        if self.codes:
            return self.function(colours), Counts(pixels)
        if colours.size and colours.min() >= 0 and colours.max() <= 1:  # NaN fails both
            return self.function(colours), Counts(pixels)
        finite = np.isfinite(colours).all(axis=-1)
        outside = ((colours < 0) | (colours > 1)).any(axis=-1) & finite
        clamped = np.clip(np.nan_to_num(colours, nan=0.0, posinf=1.0, neginf=0.0), 0, 1)
        return self.function(clamped), Counts(pixels, int(outside.sum()), int((~finite).sum()))


def decoder(cube: Cube, part: Part, encoding: str) -> Decoder:
    """8-bit and 16-bit codes are encoded as the cube's space has it, all else is linear, unless told otherwise.

    Raises `OptionError`.
    """
    if encoding not in ENCODINGS:
        raise OptionError(f"unknown encoding '{encoding}'", remedy=f"use one of {', '.join(ENCODINGS)}")
    if part.codes:
        share = np.linspace(0, 1, part.codes + 1)
        values = share if encoding == "linear" else cube.decode(255 * share)
        table = values.astype(np.float32)
        return Decoder(lambda codes: table[codes], codes=True)
    if encoding == "encoded":
        return Decoder(lambda floats: cube.decode(255 * floats).astype(np.float32), codes=False)
    return Decoder(lambda floats: floats.astype(np.float32, copy=False), codes=False)
