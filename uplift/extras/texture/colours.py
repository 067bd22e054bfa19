"""Colours of an image: conversion to linear RGB in [0, 1] with counts of changes."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from itertools import chain
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Floats, StrPath, Values
from uplift.common.errors import OptionError, TextureError, UpliftWarning, unknown_name
from uplift.common.text import pluralise
from uplift.extras.colour.spaces import ImageSpace
from uplift.extras.texture.channels import (
    HALF_ROUNDING,
    SPECTRAL,
    all_inside,
    colour_channels,
    without_rounding,
)
from uplift.extras.texture.colour_profile import SRGB_SPACE
from uplift.extras.texture.image import Image, Part
from uplift.lattice.entry_boxes import NO_ROWS, OutsideBoxes

ENCODINGS = ("auto", "linear", "encoded")
"""How the numbers of an image are interpreted; ``auto`` takes integers as encoded,
floats as linear.
"""
PAST_TENSE = {
    "error": "refused",
    "clip": "clamped",
    "scale": "scaled",
    "desaturate": "desaturated",
    "desaturate-oklab": "desaturated in Oklab",
}
"""Words for messages, by the names in `uplift.colorimetry.gamut.METHODS`."""
BRIGHT = 10.0
"""Change of a component by gamut mapping that makes lights of an image likely."""
LIGHTS = "if they are lights, convert them with an emission table"
FLOAT_ROUNDING = 1e-6
"""Linear RGB by which floats can leave [0, 1] by rounding."""
HALF_ERROR = 2.0**-11
"""Relative error of half floats."""


def _counted(code: str, text: str) -> Any:
    """Return a field of `Counts`, and the warning about its pixels."""
    return field(default=0, metadata={"code": code, "text": text})


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
        Pixels whose spectra miss their colour, as no reflectance in [0, 1] has it.
    contradicting : int
        Pixels whose photographs under several lights contradict each other.
    max_change : float
        Largest change of a component of linear RGB by gamut mapping.
    painted_outside : int
        Pixels outside [0, 1] after painting over.
    not_lights : int
        Pixels whose colour no light has.
    too_bright : int
        Pixels with numbers above the largest of the channels' type.
    negative : int
        Pixels with numbers below 0, which are clamped.
    """

    pixels: int = 0
    outside: int = _counted(
        "pixels-out-of-gamut",
        "outside [0, 1]: {mapped}, a component by up to {change:.3g}",
    )
    not_finite: int = _counted(
        "pixels-not-finite", "not finite: NaN is replaced by 0, infinity is clamped"
    )
    unrealisable: int = _counted(
        "pixels-unrealisable", "of unrealisable colours: their spectra have less chroma"
    )
    contradicting: int = _counted(
        "photographs-contradict",
        "whose photographs contradict each other: answered by the first alone",
    )
    max_change: float = 0.0
    painted_outside: int = _counted(
        "painted-pixels-out-of-gamut", "outside [0, 1] after painting: {mapped}"
    )
    not_lights: int = _counted(
        "pixels-not-lights",
        "of colours that no light has: moved towards white of the same luminance",
    )
    too_bright: int = _counted(
        "pixels-too-bright",
        "brighter than half floats can store: clamped; use 32-bit channels",
    )
    negative: int = _counted("pixels-negative", "with negative numbers: clamped to 0")

    def __add__(self, other: "Counts") -> "Counts":
        """Counts of both."""
        sums = {
            count.name: getattr(self, count.name) + getattr(other, count.name)
            for count in fields(self)
        }
        return Counts(**sums | {"max_change": max(self.max_change, other.max_change)})

    def warnings(
        self, method: str = "clip", path: StrPath | None = None
    ) -> tuple[UpliftWarning, ...]:
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
        words = {"mapped": PAST_TENSE[method], "change": self.max_change}
        changed = [
            count
            for count in fields(self)
            if count.metadata and getattr(self, count.name)
        ]
        return tuple(
            UpliftWarning(
                f"{getattr(self, count.name):,} of {pluralise(self.pixels, 'pixel')} "
                f"{count.metadata['text'].format(**words)}",
                code=count.metadata["code"],
                path=path,
                hint=LIGHTS
                if count.name == "outside" and self.max_change > BRIGHT
                else "",
            )
            for count in changed
        )


def is_xyz(part: Part) -> bool:
    """Return whether the colours of a part are CIE XYZ."""
    channels = colour_channels(part)
    return channels is not None and channels.is_xyz


def source_space(
    part: Part, sensor: Sensor, chosen: ImageSpace | None = None
) -> ImageSpace | None:
    """Return the space of the colours of a part, None if it is that of the sensor.

    The one that the caller names comes first, then the statement of the file, then sRGB
    for codes and the space of the sensor for floats. Channels X, Y and Z are CIE XYZ.
    Raises `TextureError` if the caller names an RGB space for them.
    """
    if is_xyz(part):
        if chosen is not None and chosen.to_gamut is None:
            raise TextureError(
                f"channels X, Y and Z are CIE XYZ, not RGB of '{chosen.name}'",
                hint="leave out the space",
            )
        return chosen or part.xyz
    stated = None if part.profile is None else part.profile.space
    space = chosen or stated or (SRGB_SPACE if part.max_code else None)
    agrees = space and space.agrees_with(sensor, encoded=bool(part.max_code))
    return None if agrees else space


def space_warnings(
    image: Image, sensor: Sensor, chosen: ImageSpace | None = None
) -> tuple[UpliftWarning, ...]:
    """Return warnings about parts whose space is not known, by unusable statements and
    assumptions, and about spectra, in place of which R, G and B are read.
    """
    problems = dict[str, UpliftWarning]()
    for part in image.parts if chosen is None else ():
        if problem := _space_problem(part, sensor):
            problems[problem] = UpliftWarning(
                problem, code="colour-space-assumed", path=image.path
            )
    names = chain.from_iterable(part.channels for part in image.parts)
    if any(map(SPECTRAL.fullmatch, names)):
        problem = "the spectra of the image are not used: its R, G and B are"
        problems[problem] = UpliftWarning(
            problem, code="spectra-not-used", path=image.path
        )
    return tuple(problems.values())


def _space_problem(part: Part, sensor: Sensor) -> str:
    """Return what is assumed about the space of a part, empty if nothing is."""
    stated = part.profile
    if is_xyz(part):
        read_as = "CIE XYZ of white D65"
    elif stated is not None and stated.space is not None:
        read_as = f"those of {stated.name}"
    else:
        read_as = "sRGB" if part.max_code else f"linear {sensor.space}"
    if stated is not None and stated.unusable:
        names = ", ".join(stated.unusable)
        return (
            f"the image states a colour space that cannot be used ({names}); its "
            f"colours are read as {read_as}"
        )
    if (
        stated is None
        and not is_xyz(part)
        and not SRGB_SPACE.agrees_with(sensor, encoded=False)
    ):
        return f"the image states no colour space; its colours are read as {read_as}"
    return ""


@dataclass(frozen=True, eq=False)
class Decoder:
    """Conversion of the colours (…, 3) of a part to linear RGB of a sensor, made by
    `make_decoder`.

    ``function`` maps the numbers of the part, integers if ``is_integer``, to linear
    values of its space. With ``maps_codes``, codes outside [0, 1] are mapped before
    decoding, as the encoding ends at 0 and 1. ``matrix`` (3, 3) leads from the space of
    the part to that of the sensor; None if they agree. Linear RGB in the boxes of
    entries ``outside`` [0, 1] are not mapped, and those outside [0, 1] by no more than
    ``rounding`` are clipped.
    """

    function: Callable[[Values], Values]
    is_integer: bool
    maps_codes: bool
    matrix: Array | None
    sensor: Sensor
    method: str
    outside: OutsideBoxes | None = None
    rounding: float = FLOAT_ROUNDING

    def __call__(self, colours: Values) -> tuple[Floats, Counts]:
        """Return linear RGB (…, 3) in [0, 1] or in boxes, and counts of the pixels that
        were changed.

        Colours outside are mapped to the gamut and NaN is replaced by 0. With the
        method ``error`` both raise a `ColourError`.
        """
        not_finite = outside = 0
        max_change = 0.0
        if not self.is_integer:
            colours, not_finite = self._finite(colours)
        if self.maps_codes:
            colours, outside, max_change = self._mapped(colours)
        rgb = self.function(colours)
        if self.matrix is not None:
            rgb = np.asarray(rgb, dtype=float) @ self.matrix.T
        if self.matrix is not None or not self.maps_codes:
            rgb = without_rounding(rgb, self.rounding)
            rgb, outside, max_change = self._mapped(rgb, self.outside)
        counts = Counts(colours.size // 3, outside, not_finite, max_change=max_change)
        return rgb.astype(np.float32, copy=False), counts

    def _finite(self, colours: Values) -> tuple[Values, int]:
        """Return colours without NaN and infinity, and their number; with the method
        ``error`` they stay.
        """
        if all_inside(colours):
            return colours, 0
        finite = np.asarray(np.isfinite(colours).all(axis=-1))
        if self.method != "error":
            numbers = np.nan_to_num(colours, nan=0.0, posinf=1.0, neginf=0.0)
            clamped = np.clip(numbers, 0, 1)
            colours = np.where(finite[..., None], colours, clamped)
        return colours, int((~finite).sum())

    def _mapped(
        self, colours: Values, boxes: OutsideBoxes | None = None
    ) -> tuple[Values, int, float]:
        """Return colours in [0, 1] or in boxes, the number of those that were moved,
        and the largest change.
        """
        if all_inside(colours):
            return colours, 0, 0.0
        flat = colours.reshape(-1, 3)
        kept = NO_ROWS if boxes is None else boxes.find(flat).rows
        if kept.size:
            flat = flat.copy()
            flat[kept] = 0
        mapped = map_to_gamut(flat, self.sensor, self.method)
        mapped.rgb[kept] = colours.reshape(-1, 3)[kept]
        return mapped.rgb.reshape(colours.shape), mapped.count, mapped.max_change


def check_encoding(encoding: str) -> None:
    """Raise `UnknownNameError` unless ``encoding`` is one of `ENCODINGS`."""
    if encoding not in ENCODINGS:
        raise unknown_name(encoding, ENCODINGS, "encoding")


def make_decoder(
    sensor: Sensor,
    part: Part,
    encoding: str,
    method: str = "clip",
    space: ImageSpace | None = None,
    outside: OutsideBoxes | None = None,
) -> Decoder:
    """Make the decoder of a part to linear RGB of a sensor, for the gamut mapping
    ``method``.

    ``encoding`` ``auto`` takes 8-bit and 16-bit integers as encoded, all else as
    linear. ``space`` is by default the one that the file states. Colours in the boxes
    of entries ``outside`` [0, 1] stay. Raises `OptionError` for encoded floats with a
    mapping other than ``clip`` or ``error``, as the encoding ends at 0 and 1, and for
    ``linear`` with a space whose floats are encoded.
    """
    source = source_space(part, sensor, space)
    matrix = None if source is None else source.matrix_to(sensor)
    if source is not None and source.floats_are_codes and encoding == "linear":
        raise OptionError(
            f"the encoding must not be linear for the encoded space '{source.name}'",
            hint="name its linear counterpart, or leave the encoding to the space",
        )
    is_encoded = encoding == "encoded" and not reads_codes(part, source)
    if is_encoded and method not in ("error", "clip"):
        raise OptionError(
            f"encoded floats must use the gamut mapping clip or error, got '{method}'",
            code="encoded-floats-not-mapped",
            hint="their encoding ends at 0 and 1; pass out_of_gamut='clip' or "
            "encoding='linear'",
        )
    if is_encoded and source is not None and source.to_gamut is not None:
        raise OptionError("CIE XYZ must be linear", hint="leave out encoding='encoded'")
    function = linear_reader(sensor, part, encoding, source)
    rounding = _rounding(part, matrix)
    return Decoder(
        function,
        bool(part.max_code),
        is_encoded,
        matrix,
        sensor,
        method,
        outside,
        rounding,
    )


def _rounding(part: Part, matrix: Array | None) -> float:
    """Return linear RGB by which white of a part, converted by a matrix, can leave [0,
    1] by rounding.
    """
    if matrix is None:
        return FLOAT_ROUNDING
    if "half" not in part.types:
        return HALF_ROUNDING
    white = np.linalg.solve(matrix, np.ones(3))
    largest = np.abs(matrix) @ np.abs(white)
    return max(HALF_ROUNDING, HALF_ERROR * float(largest.max()))


def reads_codes(part: Part, source: ImageSpace | None) -> bool:
    """Return whether the numbers of a part are codes of their space, independent of the
    encoding of floats.
    """
    return bool(part.max_code) or (source is not None and source.floats_are_codes)


def linear_reader(
    sensor: Sensor, part: Part, encoding: str, source: ImageSpace | None
) -> Callable[[Values], Values]:
    """Return the function from the numbers (…, 3) of a part to linear values of its
    space, None for the sensor's.
    """
    to_linear = (source and source.decode) or (lambda codes: sensor.decode(255 * codes))
    if not part.max_code:
        is_encoded = encoding == "encoded" or reads_codes(part, source)
        return to_linear if is_encoded else np.asarray
    if source is not None and source.mixes_channels and encoding != "linear":
        return lambda codes: to_linear(codes / part.max_code)
    # A table, as channels are independent.
    share = np.repeat(np.linspace(0, 1, part.max_code + 1)[:, None], 3, axis=1)
    table = (share if encoding == "linear" else to_linear(share)).astype(np.float32)
    if (table == table[:, :1]).all():
        curve = table[:, 0].copy()
        return lambda codes: curve[codes]
    return lambda codes: table[codes, np.arange(3)]
