"""Colour channels of an image, and their conversion to linear RGB in [0, 1]."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, TextureError, UpliftWarning
from uplift.io.texture.alpha import ColourChannels, without_rounding
from uplift.io.texture.source import Part, Values
from uplift.io.texture.source_space import source_space

Floats = NDArray[np.float32]

ENCODINGS = ("auto", "linear", "encoded")
"""How the numbers of an image are interpreted; ``auto`` takes integers as encoded, floats as linear."""
PAST_TENSE = {
    "error": "refused",
    "clip": "clamped",
    "scale": "scaled",
    "desaturate": "desaturated",
    "desaturate-oklab": "desaturated in Oklab",
}
"""Words for messages, by the names in `uplift.colorimetry.gamut.METHODS`."""
COLOUR_TYPES = {"uint8", "uint16", "half", "float", "double"}


@dataclass(frozen=True)
class Counts:
    """Numbers of pixels that were not plain colours in [0, 1].

    Parameters
    ----------
    pixels : int
        All pixels.
    outside : int
        Pixels outside [0, 1].
    not_finite : int
        Pixels with NaN or infinity.
    unrealisable : int
        Pixels whose spectra may miss their colour, as no reflectance in [0, 1] has it.
    max_change : float
        Largest change of a component of linear RGB by gamut mapping.
    painted_outside : int
        Pixels outside [0, 1] after painting over.
    not_lights : int
        Pixels whose colour no light has.
    too_bright : int
        Pixels with numbers above the largest of the channels' type.
    """

    pixels: int = 0
    outside: int = 0
    not_finite: int = 0
    unrealisable: int = 0
    max_change: float = 0.0
    painted_outside: int = 0
    not_lights: int = 0
    too_bright: int = 0

    def __add__(self, other: Counts) -> Counts:
        """Counts of both."""
        sums = {each.name: getattr(self, each.name) + getattr(other, each.name) for each in fields(self)}
        return Counts(**sums | {"max_change": max(self.max_change, other.max_change)})

    def warnings(self, method: str = "clip", path: str | os.PathLike[str] | None = None) -> tuple[UpliftWarning, ...]:
        """Return a warning for every count of changed pixels above 0.

        Parameters
        ----------
        method : str
            The gamut mapping that was used, one of `uplift.colorimetry.gamut.METHODS`.
        path : path-like, optional
            The image, for the location of the warnings.

        Returns
        -------
        tuple of UpliftWarning
            The warnings. They are not emitted.
        """
        past, change = PAST_TENSE[method], f"a component by up to {self.max_change:.3g}"
        counts = (
            self.outside,
            self.not_finite,
            self.unrealisable,
            self.painted_outside,
            self.not_lights,
            self.too_bright,
        )
        outside, not_finite, unrealisable, painted, not_lights, too_bright = (
            f"{count:,} of {self.pixels:,} pixels" for count in counts
        )
        warnings = (
            UpliftWarning(f"{outside} lie outside [0, 1]: {past}, {change}", code="pixels-out-of-gamut", path=path),
            UpliftWarning(
                f"{not_finite} are not finite: NaN is replaced by 0, infinity is clamped",
                code="pixels-not-finite",
                path=path,
            ),
            UpliftWarning(
                f"{unrealisable} are close to unrealisable colours: their spectra have less chroma",
                code="pixels-unrealisable",
                path=path,
            ),
            UpliftWarning(
                f"{painted} lie outside [0, 1] after painting: {past}",
                code="painted-pixels-out-of-gamut",
                path=path,
            ),
            UpliftWarning(
                f"{not_lights} have colours that no light has: moved towards white of the same luminance",
                code="pixels-not-lights",
                path=path,
            ),
            UpliftWarning(
                f"{too_bright} are brighter than half floats can store: clamped",
                code="pixels-too-bright",
                path=path,
                hint="use 32-bit channels",
            ),
        )
        return tuple(warning for count, warning in zip(counts, warnings, strict=True) if count)


def colour_channels(part: Part) -> ColourChannels | None:
    """Find the colour channels of a part: R, G, B, else those of the only layer that has them, else Y.

    Parameters
    ----------
    part : Part
        A part of an image.

    Returns
    -------
    ColourChannels or None
        None for a part without colour.

    Raises
    ------
    TextureError
        Several layers have colours (code ``ambiguous-colour-layers``), or the colours are integers of unknown
        scale (``unsupported-colour-type``).
    """
    names = _colour_names(part)
    if names is None:
        return None
    red, green, blue = (part.channels.index(name) for name in names)
    if types := {part.types[channel] for channel in (red, green, blue)} - COLOUR_TYPES:
        raise TextureError(
            f"colour channels must be 8-bit, 16-bit, half or float, got {min(types)}",
            code="unsupported-colour-type",
            hint="convert them",
        )
    alpha = names[0][:-1] + "A"
    is_multiplied = part.has_associated_alpha and alpha in part.channels
    return ColourChannels((red, green, blue), part.channels.index(alpha) if is_multiplied else None)


def _colour_names(part: Part) -> tuple[str, str, str] | None:
    layers = [name[:-1] for name in part.channels if name == "R" or name.endswith(".R")]
    layers = [layer for layer in layers if {layer + "G", layer + "B"} <= set(part.channels)]
    if "" in layers:
        return "R", "G", "B"
    if len(layers) > 1:
        names = ", ".join(layer[:-1] for layer in layers)
        raise TextureError(
            f"a part must have one layer of colour, got {names}",
            code="ambiguous-colour-layers",
            hint="write each layer as a part or a file",
        )
    if layers:
        return layers[0] + "R", layers[0] + "G", layers[0] + "B"
    is_luminance = "Y" in part.channels and not {"RY", "BY"} & set(part.channels)
    return ("Y", "Y", "Y") if is_luminance else None


@dataclass(frozen=True, eq=False)
class Decoder:
    """Conversion of the colours (…, 3) of a part to linear RGB of a sensor, made by `make_decoder`.

    Parameters
    ----------
    function : callable
        From the numbers of the part to linear RGB of its space.
    is_bounded : bool
        Whether these are always in [0, 1].
    maps_codes : bool
        Whether codes outside [0, 1] are mapped before decoding, as the encoding ends at 0 and 1.
    matrix : ndarray of shape (3, 3), or None
        From the space of the part to that of the sensor, None if they agree.
    sensor : Sensor
        The sensor.
    method : str
        Gamut mapping.
    """

    function: Callable[[Values], Values]
    is_bounded: bool
    maps_codes: bool
    matrix: Array | None
    sensor: Sensor
    method: str

    def __call__(self, colours: Values) -> tuple[Floats, Counts]:
        """Return linear RGB (…, 3) in [0, 1], and counts of the pixels that were changed.

        Colours outside are mapped to the gamut and NaN is replaced by 0. With the method ``error`` both raise a
        `ColourError`.
        """
        not_finite = outside = 0
        max_change = 0.0
        if not self.is_bounded:
            colours, not_finite = self._finite(colours)
        if self.maps_codes:
            colours, outside, max_change = self._mapped(colours)
        rgb = self.function(colours)
        if self.matrix is not None:
            rgb = without_rounding(np.asarray(rgb, dtype=float) @ self.matrix.T)
        if self.matrix is not None or not (self.is_bounded or self.maps_codes):
            rgb, outside, max_change = self._mapped(rgb)
        counts = Counts(colours.size // 3, outside, not_finite, max_change=max_change)
        return rgb.astype(np.float32, copy=False), counts

    def _finite(self, colours: Values) -> tuple[Values, int]:
        """Return colours without NaN and infinity, and their number; with the method ``error`` they stay."""
        if _all_inside(colours):
            return colours, 0
        finite = np.asarray(np.isfinite(colours).all(axis=-1))
        if self.method != "error":
            clamped = np.clip(np.nan_to_num(colours, nan=0.0, posinf=1.0, neginf=0.0), 0, 1)
            colours = np.where(finite[..., None], colours, clamped)
        return colours, int((~finite).sum())

    def _mapped(self, colours: Values) -> tuple[Values, int, float]:
        """Return colours in [0, 1], the number of those that were outside, and the largest change."""
        if _all_inside(colours):
            return colours, 0, 0.0
        mapped = map_to_gamut(colours, self.sensor, self.method)
        return mapped.rgb, mapped.count, mapped.max_change


def _all_inside(colours: Values) -> bool:
    return bool(colours.size and colours.min() >= 0 and colours.max() <= 1)  # NaN fails both


def check_encoding(encoding: str) -> None:
    """Raise `OptionError` (code ``unknown-encoding``) unless ``encoding`` is one of `ENCODINGS`."""
    if encoding not in ENCODINGS:
        raise OptionError(
            f"unknown encoding '{encoding}'",
            code="unknown-encoding",
            hint=f"use one of {', '.join(ENCODINGS)}",
        )


def make_decoder(
    sensor: Sensor, part: Part, encoding: str, method: str = "clip", space: ImageSpace | None = None
) -> Decoder:
    """Make the decoder of a part.

    Parameters
    ----------
    sensor : Sensor
        The sensor whose linear RGB are wanted.
    part : Part
        The part of an image.
    encoding : {"auto", "linear", "encoded"}
        Interpretation of the numbers; ``auto`` takes 8-bit and 16-bit integers as encoded, all else as linear.
    method : str
        Gamut mapping for colours outside [0, 1], one of `uplift.colorimetry.gamut.METHODS`.
    space : ImageSpace, optional
        The space of the colours, by default the one that the file states; see `source_space`.

    Returns
    -------
    Decoder
        The conversion to linear RGB.

    Raises
    ------
    OptionError
        Encoded floats with a mapping other than ``clip`` or ``error``, as the encoding ends at 0 and 1
        (code ``encoded-floats-not-mapped``), or ``linear`` for a space whose floats are encoded
        (``encoding-contradicts-space``).
    """
    source = source_space(part, sensor, space)
    matrix = None if source is None else source.matrix_to(sensor)
    if source is not None and source.floats_are_codes and encoding == "linear":
        raise OptionError(
            f"the encoding must not be linear for the encoded space '{source.name}'",
            code="encoding-contradicts-space",
            hint="name its linear counterpart, or leave the encoding to the space",
        )
    if part.max_code:
        return Decoder(integer_reader(sensor, part.max_code, encoding, source), True, False, matrix, sensor, method)
    if source is not None and source.floats_are_codes and source.decode is not None:
        return Decoder(source.decode, False, False, matrix, sensor, method)
    if encoding == "encoded":
        if method not in ("error", "clip"):
            raise OptionError(
                f"encoded floats must use the gamut mapping clip or error, got '{method}'",
                code="encoded-floats-not-mapped",
                hint="their encoding ends at 0 and 1; pass out_of_gamut='clip' or encoding='linear'",
            )
        return Decoder(code_decoder(sensor, source), False, True, matrix, sensor, method)
    return Decoder(lambda floats: floats, False, False, matrix, sensor, method)


def code_decoder(sensor: Sensor, source: ImageSpace | None) -> Callable[[Values], Values]:
    """Return the function from codes in [0, 1] of a space, None for that of the sensor, to linear values."""
    if source is None or source.decode is None:
        return lambda codes: sensor.decode(255 * codes)
    return source.decode


def integer_reader(
    sensor: Sensor, max_code: int, encoding: str, source: ImageSpace | None
) -> Callable[[Values], Values]:
    """Return the function from integers (…, 3) to linear values, by a table where channels are independent."""
    decode = code_decoder(sensor, source)
    if source is not None and source.mixes_channels:
        return lambda codes: decode(codes / max_code)
    share = np.repeat(np.linspace(0, 1, max_code + 1)[:, None], 3, axis=1)
    table = (share if encoding == "linear" else decode(share)).astype(np.float32)
    if (table == table[:, :1]).all():
        curve = table[:, 0].copy()
        return lambda codes: curve[codes]
    return lambda codes: np.stack([table[:, k][codes[..., k]] for k in range(3)], axis=-1)
