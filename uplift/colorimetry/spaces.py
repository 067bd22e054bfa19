"""RGB spaces by name: of colour-science, of OpenColorIO, or by chromaticities."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import Gamut, Primaries, conversion
from uplift.colorimetry.ocio import AP0, OcioSpace, find_ocio_space, ocio_names
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value, parse_float

SHORT_NAMES = {
    "ap0": "ACES2065-1",
    "ap1": "ACEScg",
    "rec709": "ITU-R BT.709",
    "bt709": "ITU-R BT.709",
    "rec2020": "ITU-R BT.2020",
    "bt2020": "ITU-R BT.2020",
    "p3": "Display P3",
    "prophoto": "ProPhoto RGB",
}
"""Names of colour-science by usual short ones, in lower case and without punctuation."""
FIRST_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "Adobe RGB (1998)")
"""Spaces of colour-science that stand for others with the same primaries."""
MAX_MATRIX_DIFFERENCE = 1e-3
"""Largest difference between matrices of the same primaries, of which some are rounded."""
MAX_PRIMARIES_DIFFERENCE = 5e-3
"""Largest difference in linear RGB between primaries that count as equal."""
MAX_CURVE_DIFFERENCE = 0.5
"""Largest difference in 8-bit sRGB codes between tone curves that count as equal."""
NUMBERS = re.compile(r"[-+\d.eE,;\s]+")


@dataclass(frozen=True, eq=False)
class ImageSpace:
    """The RGB space of colours to read."""

    name: str
    """Name for messages."""
    gamut: Gamut
    """Primaries of the linear RGB that `decode` returns."""
    decode: Callable[[Array], Array] | None = None
    """From codes (..., 3), 0 to 1, to linear RGB (..., 3). None for the transfer function of the cube's space."""
    floats_are_codes: bool = False
    """Whether floats of the space are codes, too, as those of encoded spaces of OpenColorIO."""
    mixes_channels: bool = False
    """Whether `decode` computes each component from all three."""

    def matrix_to(self, sensor: Sensor) -> Array | None:
        """Compute the matrix to the linear RGB of a sensor. Shape (3, 3)."""
        sensor.require_xyz()
        matrix = conversion(self.gamut, sensor)
        return None if np.abs(matrix - np.eye(3)).max() <= MAX_PRIMARIES_DIFFERENCE else matrix

    def agrees_with(self, sensor: Sensor, *, encoded: bool) -> bool:
        """Whether the space is that of a sensor, up to rounding."""
        if sensor.sensitivities is not None or self.mixes_channels or self.matrix_to(sensor) is not None:
            return False
        if not encoded or self.decode is None:
            return True
        codes = np.repeat(np.arange(256)[:, None] / 255, 3, axis=1)
        difference = encode(self.decode(codes)) - encode(sensor.decoding)[:, None]
        return bool(255 * np.abs(difference).max() <= MAX_CURVE_DIFFERENCE)


def find_space(text: str) -> ImageSpace:
    """Find an RGB space by name, or by chromaticities.

    Names of the configuration in ``$OCIO`` come first, then those of colour-science and short ones such as ``AP1`` or
    ``rec2020``, then those of the configuration that OpenColorIO contains.

    >>> find_space("rec2020").name, find_space("lin_ap1_scene").name
    ('ITU-R BT.2020', 'ACEScg')
    """
    if NUMBERS.fullmatch(text):
        return ImageSpace(text, _parse_primaries(text))
    if (found := find_ocio_space(text, built_in=False)) is not None:
        return from_ocio(found)
    try:
        space = look_up_space(text, ocio=False)
    except KeyError:
        found = find_ocio_space(text)
        if found is None:
            known = (*colour_science().RGB_COLOURSPACES, *ocio_names())
            raise unknown_name(text, known, "RGB space") from None
        return from_ocio(found)
    return ImageSpace(space.name, Primaries.of([*space.primaries.ravel(), *space.whitepoint]), space.cctf_decoding)


def from_ocio(space: OcioSpace) -> ImageSpace:
    """Make the image space of a colour space of OpenColorIO."""
    if space.is_linear:
        matrix = space.to_ap0(np.eye(3)).T
        return ImageSpace(space.name, LinearGamut(AP0.rgb_to_xyz @ matrix), lambda codes: codes)
    return ImageSpace(space.name, AP0, space.to_ap0, floats_are_codes=True, mixes_channels=True)


@dataclass(frozen=True, eq=False)
class LinearGamut:
    """A gamut by its matrix from linear RGB to XYZ, shape (3, 3)."""

    rgb_to_xyz: Array


def _parse_primaries(text: str) -> Primaries:
    try:
        numbers = [parse_float(word) for word in re.split(r"[,;\s]+", text.strip())]
    except ValueError as error:
        raise OptionError(
            f"primaries must be the name of a space or eight numbers, got {format_value(text)}",
            code="invalid-primaries",
            hint="give x,y of red, green, blue and white",
        ) from error
    return Primaries.of(numbers)


def look_up_space(name: str, *, ocio: bool = True) -> Any:
    """Find an RGB space of colour-science."""
    table = colour_science().RGB_COLOURSPACES
    for each in (name, SHORT_NAMES.get(re.sub(r"[ ._-]", "", name.casefold()), name)):
        if each in table:
            return table[each]
    found = find_ocio_space(name) if ocio else None
    if found is not None:
        for each in (*FIRST_SPACES, *table):
            if _same_primaries(table[each], found):
                return table[each]
    raise unknown_name(name, table, "RGB space")


def _same_primaries(space: Any, found: OcioSpace) -> bool:
    expected = conversion(Primaries.of([*space.primaries.ravel(), *space.whitepoint]), AP0)
    return bool(np.abs(found.to_ap0(np.eye(3)).T - expected).max() <= MAX_MATRIX_DIFFERENCE)
