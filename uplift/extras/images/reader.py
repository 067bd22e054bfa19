"""Colours of an image: from the numbers of a file to linear RGB of a sensor."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import chain

import numpy as np

from uplift.colorimetry.gamut import check_method, map_to_gamut
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Floats, Values
from uplift.common.errors import OptionError, TextureError, UpliftWarning, unknown_name
from uplift.extras.colour.spaces import ImageSpace, find_space
from uplift.extras.images.channels import (
    HALF_ROUNDING,
    SPECTRAL,
    ColourChannels,
    all_inside,
    is_xyz,
    without_rounding,
)
from uplift.extras.images.counts import Counts
from uplift.extras.images.image import Image, Part
from uplift.extras.images.profile import SRGB_SPACE
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
OUTSIDE = "pixels-out-of-gamut"
NOT_FINITE = "pixels-not-finite"
REPLACED = "not finite: NaN is replaced by 0, infinity is clamped"
FLOAT_ROUNDING = 1e-6
"""Linear RGB by which floats can leave [0, 1] by rounding."""
HALF_ERROR = 2.0**-11
"""Relative error of half floats."""
ReadColours = Callable[[Values], tuple[Floats, Counts]]
"""From the numbers of an image (…, 3) to linear RGB (…, 3), and counts of changed
pixels.
"""


@dataclass(frozen=True, eq=False, kw_only=True)
class Reader(ABC):
    """How the colours of images are read as linear RGB of a sensor.

    ``encoding`` ``auto`` takes 8-bit and 16-bit integers as encoded, all else as
    linear. ``space`` is a name, as for `find_space`, by default the one that each file
    states. Raises `UnknownNameError` for unknown names.
    """

    sensor: Sensor
    encoding: str = "auto"
    space: str | None = None

    def __post_init__(self) -> None:
        check_encoding(self.encoding)
        self.named_space  # noqa: B018 - an unknown name raises here

    @cached_property
    def named_space(self) -> ImageSpace | None:
        """The space that the caller names."""
        return None if self.space is None else find_space(self.space)

    @property
    def settings(self) -> dict[str, str]:
        """Description for the header of textures."""
        space = {} if self.space is None else {"space": self.space}
        return {"encoding": self.encoding, **self._mapping, **space}

    @property
    def _mapping(self) -> dict[str, str]:
        """Gamut mapping among the settings: colours are not mapped by default."""
        return {}

    def channels(self, found: ColourChannels) -> ColourChannels:
        """How the colour channels that a part has are read: by default as found."""
        return found

    @abstractmethod
    def decoder(self, part: Part) -> ReadColours:
        """Make the conversion of the numbers of a part."""

    def source_space(self, part: Part) -> ImageSpace | None:
        """Return the space of the colours of a part, None if it is that of the sensor.

        The one that the caller names comes first, then the statement of the file, then
        sRGB for codes and the space of the sensor for floats. Channels X, Y and Z are
        CIE XYZ. Raises `TextureError` if the caller names an RGB space for them.
        """
        named = self.named_space
        if is_xyz(part):
            if named is not None and named.to_gamut is None:
                raise TextureError(
                    f"channels X, Y and Z are CIE XYZ, not RGB of '{named.name}'",
                    hint="leave out the space",
                )
            return named or part.xyz
        stated = None if part.profile is None else part.profile.space
        space = named or stated or (SRGB_SPACE if part.max_code else None)
        encoded = bool(part.max_code)
        agrees = space and space.agrees_with(self.sensor, encoded=encoded)
        return None if agrees else space

    def space_name(self, part: Part) -> str:
        """Name the space in which the colours of a part are read."""
        space = self.source_space(part)
        if space is not None:
            return space.name
        return self.sensor.space if part.max_code else f"linear {self.sensor.space}"

    def warnings(self, image: Image) -> tuple[UpliftWarning, ...]:
        """Return warnings about parts whose space is not known, by unusable statements
        and assumptions, and about spectra, in place of which R, G and B are read.
        """
        assumed = {}
        if self.space is None:
            assumed = dict.fromkeys(map(self._assumption, image.parts))
        warnings = [
            UpliftWarning(problem, code="colour-space-assumed", path=image.path)
            for problem in assumed
            if problem
        ]
        names = chain.from_iterable(part.channels for part in image.parts)
        if any(map(SPECTRAL.fullmatch, names)):
            problem = "the spectra of the image are not used: its R, G and B are"
            unused = UpliftWarning(problem, code="spectra-not-used", path=image.path)
            warnings.append(unused)
        return tuple(warnings)

    def _assumption(self, part: Part) -> str:
        """Return what is assumed about the space of a part, empty if nothing is."""
        stated = part.profile
        if is_xyz(part):
            read_as = "CIE XYZ of white D65"
        elif stated is not None and stated.space is not None:
            read_as = f"those of {stated.name}"
        else:
            read_as = "sRGB" if part.max_code else f"linear {self.sensor.space}"
        if stated is not None and stated.unusable:
            names = ", ".join(stated.unusable)
            return (
                f"the image states a colour space that cannot be used ({names}); its "
                f"colours are read as {read_as}"
            )
        is_srgb = SRGB_SPACE.agrees_with(self.sensor, encoded=False)
        if stated is None and not is_xyz(part) and not is_srgb:
            return (
                f"the image states no colour space; its colours are read as {read_as}"
            )
        return ""

    def to_linear(
        self, part: Part, source: ImageSpace | None
    ) -> Callable[[Values], Values]:
        """Return the function from the numbers (…, 3) of a part to linear values of its
        space, None for the sensor's.
        """

        def decode(codes: Array) -> Array:
            if source is not None and source.decode is not None:
                return source.decode(codes)
            return self.sensor.decode(255 * codes)

        top = part.max_code
        if not top:
            is_encoded = self.encoding == "encoded" or reads_codes(part, source)
            return decode if is_encoded else np.asarray
        is_linear = self.encoding == "linear"
        if source is not None and source.mixes_channels and not is_linear:
            return lambda codes: decode(codes / top)
        # A table, as channels are independent.
        share = np.repeat(np.linspace(0, 1, top + 1)[:, None], 3, axis=1)
        table = (share if is_linear else decode(share)).astype(np.float32)
        if (table == table[:, :1]).all():
            curve = table[:, 0].copy()
            return lambda codes: curve[codes]
        return lambda codes: table[codes, np.arange(3)]


def check_encoding(encoding: str) -> None:
    """Raise `UnknownNameError` unless ``encoding`` is one of `ENCODINGS`."""
    if encoding not in ENCODINGS:
        raise unknown_name(encoding, ENCODINGS, "encoding")


def reads_codes(part: Part, source: ImageSpace | None) -> bool:
    """Return whether the numbers of a part are codes of their space, independent of the
    encoding of floats.
    """
    return bool(part.max_code) or (source is not None and source.floats_are_codes)


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceReader(Reader):
    """Reader of colours in [0, 1], to which others are mapped by the method
    ``out_of_gamut``. Colours in ``boxes`` of entries outside [0, 1] stay.
    """

    out_of_gamut: str = "clip"
    boxes: OutsideBoxes | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_method(self.out_of_gamut)

    @property
    def _mapping(self) -> dict[str, str]:
        return {"out_of_gamut": self.out_of_gamut}

    def decoder(self, part: Part) -> "Decoder":
        """Make the decoder of a part.

        Raises `OptionError` for encoded floats with a mapping other than ``clip`` or
        ``error``, as the encoding ends at 0 and 1, and for ``linear`` with a space
        whose floats are encoded.
        """
        source = self.source_space(part)
        if source is not None and source.floats_are_codes and self.encoding == "linear":
            raise OptionError(
                "the encoding must not be linear for the encoded space "
                f"'{source.name}'",
                hint="name its linear counterpart, or leave the encoding to the space",
            )
        is_encoded = self.encoding == "encoded" and not reads_codes(part, source)
        if is_encoded and self.out_of_gamut not in ("error", "clip"):
            raise OptionError(
                "encoded floats must use the gamut mapping clip or error, got "
                f"'{self.out_of_gamut}'",
                code="encoded-floats-not-mapped",
                hint="their encoding ends at 0 and 1; pass out_of_gamut='clip' or "
                "encoding='linear'",
            )
        if is_encoded and source is not None and source.to_gamut is not None:
            hint = "leave out encoding='encoded'"
            raise OptionError("CIE XYZ must be linear", hint=hint)
        matrix = None if source is None else source.matrix_to(self.sensor)
        return Decoder(
            self,
            self.to_linear(part, source),
            matrix=matrix,
            is_integer=bool(part.max_code),
            maps_codes=is_encoded,
            rounding=_rounding(part, matrix),
        )

    def mapped(self, rgb: Values) -> tuple[Floats, Counts]:
        """Return linear RGB (…, 3) in [0, 1] or in boxes, as decoders do, and counts of
        the changed ones.
        """
        return Decoder(self, np.asarray)(rgb)


@dataclass(frozen=True, eq=False)
class Decoder:
    """Conversion of the colours (…, 3) of a part to linear RGB, made by a
    `SurfaceReader`.

    ``to_linear`` maps the numbers of the part, integers if ``is_integer``, to linear
    values of its space. With ``maps_codes``, codes outside [0, 1] are mapped before
    decoding, as the encoding ends at 0 and 1. ``matrix`` (3, 3) leads from the space of
    the part to that of the sensor; None if they agree. Linear RGB outside [0, 1] by no
    more than ``rounding`` are clipped.
    """

    reader: SurfaceReader
    to_linear: Callable[[Values], Values]
    matrix: Array | None = field(default=None, kw_only=True)
    is_integer: bool = field(default=False, kw_only=True)
    maps_codes: bool = field(default=False, kw_only=True)
    rounding: float = field(default=FLOAT_ROUNDING, kw_only=True)

    def __call__(self, colours: Values) -> tuple[Floats, Counts]:
        """Return linear RGB (…, 3) in [0, 1] or in boxes, and counts of changed pixels.

        Colours outside are mapped to the gamut and NaN is replaced by 0. With the
        method ``error`` both raise a `ColourError`.
        """
        pixels = Counts(colours.size // 3)
        not_finite = outside = Counts()
        if not self.is_integer:
            colours, not_finite = self._finite(colours)
        if self.maps_codes:
            colours, outside = self._mapped(colours, None)
        rgb = self.to_linear(colours)
        if self.matrix is not None:
            rgb = np.asarray(rgb, dtype=float) @ self.matrix.T
        if self.matrix is not None or not self.maps_codes:
            rgb = without_rounding(rgb, self.rounding)
            rgb, outside = self._mapped(rgb, self.reader.boxes)
        return rgb.astype(np.float32, copy=False), pixels + outside + not_finite

    def _finite(self, colours: Values) -> tuple[Values, Counts]:
        """Return colours without NaN and infinity, and their number; with the method
        ``error`` they stay.
        """
        if all_inside(colours):
            return colours, Counts()
        finite = np.asarray(np.isfinite(colours).all(axis=-1))
        if self.reader.out_of_gamut != "error":
            numbers = np.nan_to_num(colours, nan=0.0, posinf=1.0, neginf=0.0)
            clamped = np.clip(numbers, 0, 1)
            colours = np.where(finite[..., None], colours, clamped)
        return colours, Counts.of(NOT_FINITE, (~finite).sum(), REPLACED)

    def _mapped(
        self, colours: Values, boxes: OutsideBoxes | None
    ) -> tuple[Values, Counts]:
        """Return colours in [0, 1] or in boxes, and the number of those that were
        moved.
        """
        if all_inside(colours):
            return colours, Counts()
        method = self.reader.out_of_gamut
        flat = colours.reshape(-1, 3)
        kept = NO_ROWS if boxes is None else boxes.find(flat).rows
        if kept.size:
            flat = flat.copy()
            flat[kept] = 0
        mapped = map_to_gamut(flat, self.reader.sensor, method)
        mapped.rgb[kept] = colours.reshape(-1, 3)[kept]
        counts = outside_counts(mapped.count, method, mapped.max_change)
        return mapped.rgb.reshape(colours.shape), counts


def outside_counts(pixels: int, method: str, largest: float) -> Counts:
    """Count pixels outside [0, 1], of which a component was changed by this most."""
    text = f"outside [0, 1]: {PAST_TENSE[method]}, a component"
    return Counts.of(OUTSIDE, pixels, text, largest)


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
