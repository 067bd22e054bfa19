"""Which channels are the colour, and from what a file holds to linear RGB in [0, 1], with what was wrong counted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import ColourError, OptionError, TextureError
from uplift.io.texture.source import Part, Values

Floats = NDArray[np.float32]
ENCODINGS = ("auto", "linear", "encoded")
PAST_TENSE = {
    "error": "refused",
    "clip": "clamped",
    "scale": "scaled",
    "desaturate": "desaturated",
    "desaturate-oklab": "desaturated in Oklab",
}
"""What is said of pixels, by the names of `uplift.colorimetry.gamut.METHODS`."""
COLOUR_KINDS = {"uint8", "uint16", "half", "float", "double"}


@dataclass(frozen=True)
class Counts:
    """Pixels; those outside [0, 1]; those not finite; those that their spectra may miss.

    ``farthest`` is the largest change, of a component of linear RGB, that brought a pixel inside.
    """

    pixels: int = 0
    outside: int = 0
    not_finite: int = 0
    missed: int = 0
    farthest: float = 0.0

    def __add__(self, other: Counts) -> Counts:
        return Counts(
            self.pixels + other.pixels,
            self.outside + other.outside,
            self.not_finite + other.not_finite,
            self.missed + other.missed,
            max(self.farthest, other.farthest),
        )

    def remarks(self, way: str = "clip") -> tuple[str, ...]:
        """What should be said of them, where ``way`` was what became of those outside."""
        said = {
            f"lie outside [0, 1]: {PAST_TENSE[way]}, a component by up to {self.farthest:.3g}": self.outside,
            "are not finite: NaN is taken for 0, infinity clamped": self.not_finite,
            "are or border on colours that no reflectance has: their spectra have less chroma": self.missed,
        }
        return tuple(f"{count:,} of {self.pixels:,} pixels {text}" for text, count in said.items() if count)


def colour_channels(part: Part) -> tuple[int, int, int] | None:
    """Places of red, green and blue among a part's channels; a grey one is all three; None for no colour.

    That is R, G, B, else those of the only layer that has them, else Y. Raises `TextureError` for several layers,
    and for whole numbers of which nobody knows what they count.
    """
    names = _names(part)
    if names is None:
        return None
    red, green, blue = (part.channels.index(name) for name in names)
    if kinds := {part.kinds[place] for place in (red, green, blue)} - COLOUR_KINDS:
        problem = f"has colours of type {min(kinds)}"
        raise TextureError(problem, hint="make them 8-bit, 16-bit, half or float")
    return red, green, blue


def _names(part: Part) -> tuple[str, str, str] | None:
    layers = [name[:-1] for name in part.channels if name == "R" or name.endswith(".R")]
    layers = [layer for layer in layers if {layer + "G", layer + "B"} <= set(part.channels)]
    if "" in layers:
        return "R", "G", "B"
    if len(layers) > 1:
        names = ", ".join(layer[:-1] for layer in layers)
        raise TextureError(f"has several layers of colour: {names}", hint="make each a part, or a file")
    if layers:
        return layers[0] + "R", layers[0] + "G", layers[0] + "B"
    luma = "Y" in part.channels and not {"RY", "BY"} & set(part.channels)
    return ("Y", "Y", "Y") if luma else None


@dataclass(frozen=True, eq=False)
class Decoder:
    """From colours (…, 3) of a part to linear RGB, as `decoder` made it."""

    function: Callable[[Values], Floats]
    codes: bool
    sensor: Sensor
    way: str

    def __call__(self, colours: Values) -> tuple[Floats, Counts]:
        """Linear RGB (…, 3) in [0, 1], what lies outside brought inside, NaN being 0; and the counts.

        Raises `ColourError` for either where the way is ``error``.
        """
        pixels = colours.size // 3
        if self.codes:
            return self.function(colours), Counts(pixels)
        if colours.size and colours.min() >= 0 and colours.max() <= 1:  # NaN fails both
            return self.function(colours), Counts(pixels)
        finite = np.asarray(np.isfinite(colours).all(axis=-1))
        if self.way != "error":
            clamped = np.clip(np.nan_to_num(colours, nan=0.0, posinf=1.0, neginf=0.0), 0, 1)
            colours = np.where(finite[..., None], colours, clamped)
        try:
            moved = map_to_gamut(colours, self.sensor, self.way)
        except ColourError as error:
            raise ColourError(error.problem, hint="use --out-of-gamut clip, or another way") from error
        unfit = int((~finite).sum())
        return self.function(moved.rgb), Counts(pixels, moved.count, unfit, farthest=moved.max_change)


def check_encoding(encoding: str) -> None:
    """Raises `OptionError` for an unknown one."""
    if encoding not in ENCODINGS:
        raise OptionError(f"unknown encoding '{encoding}'", hint=f"use one of {', '.join(ENCODINGS)}")


def decoder(sensor: Sensor, part: Part, encoding: str, way: str = "clip") -> Decoder:
    """8-bit and 16-bit codes are encoded as the sensor's space has it, all else is linear, unless told otherwise.

    ``way`` is what becomes of what lies outside [0, 1] (`uplift.colorimetry.gamut.METHODS`). Raises `OptionError` for encoded
    floats that should be moved: encodings end at 0 and 1.
    """
    if part.codes:
        share = np.linspace(0, 1, part.codes + 1)
        values = share if encoding == "linear" else sensor.decode(255 * share)
        table = values.astype(np.float32)
        return Decoder(lambda codes: table[codes], True, sensor, way)
    if encoding == "encoded":
        if way not in ("error", "clip"):
            problem = f"encoded floats end at 0 and 1: there is nothing beyond to {way}"
            raise OptionError(problem, hint="use --out-of-gamut clip, or --encoding linear")
        return Decoder(lambda floats: sensor.decode(255 * floats).astype(np.float32), False, sensor, way)
    return Decoder(lambda floats: floats.astype(np.float32, copy=False), False, sensor, way)
