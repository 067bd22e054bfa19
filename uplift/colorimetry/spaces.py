"""RGB spaces by name: of colour-science, of OpenColorIO, or by chromaticities."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.gamut import Gamut, Primaries, conversion
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.colorimetry.observer import DEFAULT_OBSERVER, look_up_space, sensor
from uplift.colorimetry.ocio import AP0, OcioSpace, find_ocio_space, ocio_names
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import encode
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.common.errors import OptionError, unknown_name
from uplift.common.text import format_value, parse_float

COMMON_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB")
"""Names of colour-science, by the area of the gamut in CIE 1976 u′, v′."""
MAX_PRIMARIES_DIFFERENCE = 5e-3
"""Largest difference in linear RGB between primaries that count as equal."""
MAX_CURVE_DIFFERENCE = 0.5
"""Largest difference in 8-bit sRGB codes between tone curves that count as equal."""
NUMBERS = re.compile(r"[-+\d.eE,;\s]+")


@dataclass(frozen=True, eq=False)
class ImageSpace:
    """The RGB space of colours to read.

    Parameters
    ----------
    name : str
        Name for messages.
    gamut : Gamut
        Primaries of the linear RGB that `decode` returns.
    decode : callable or None
        From codes (..., 3), 0 to 1, to linear RGB (..., 3). None for the transfer function of the cube's space.
    floats_are_codes : bool
        Whether floats of the space are codes, too, as those of encoded spaces of OpenColorIO.
    mixes_channels : bool
        Whether `decode` computes each component from all three.
    """

    name: str
    gamut: Gamut
    decode: Callable[[Array], Array] | None = None
    floats_are_codes: bool = False
    mixes_channels: bool = False

    def matrix_to(self, sensor: Sensor) -> Array | None:
        """Compute the matrix to the linear RGB of a sensor.

        Parameters
        ----------
        sensor : Sensor
            The sensor.

        Returns
        -------
        ndarray of shape (3, 3), or None
            None if the primaries agree.

        Raises
        ------
        ColourError
            The sensor is a camera (``camera-without-xyz``).
        """
        sensor.require_xyz()
        matrix = conversion(self.gamut, sensor)
        return None if np.abs(matrix - np.eye(3)).max() <= MAX_PRIMARIES_DIFFERENCE else matrix

    def agrees_with(self, sensor: Sensor, *, encoded: bool) -> bool:
        """Whether the space is that of a sensor, up to rounding.

        Parameters
        ----------
        sensor : Sensor
            The sensor.
        encoded : bool
            Whether to compare the transfer functions, too.

        Returns
        -------
        bool
        """
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

    Parameters
    ----------
    text : str
        Such as ``"ACEScg"``, ``"lin_rec2020"``, ``"sRGB - Texture"``, or x,y of red, green, blue and white.

    Returns
    -------
    ImageSpace

    Raises
    ------
    UnknownNameError
        The name is unknown.
    OptionError
        The chromaticities are not those of a display, or the configuration of ``$OCIO`` cannot be used.

    Examples
    --------
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
    """Make the image space of a colour space of OpenColorIO.

    Parameters
    ----------
    space : OcioSpace
        The colour space.

    Returns
    -------
    ImageSpace
    """
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


def smallest_space(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str | None:
    """Find the smallest of the common RGB spaces that holds all colours of reflectances.

    Parameters
    ----------
    reflectances : array_like, shape (..., N)
        Reflectances in units of 1 on the wavelengths of `uplift.colorimetry.observer.grid`.
    illuminant : str
        Illuminant that the RGB refer to.
    observer : str
        Colour-matching functions.

    Returns
    -------
    str or None
        One of `COMMON_SPACES`; None if none of them holds all colours.

    Raises
    ------
    UnknownNameError
        The illuminant or the observer is unknown.

    Examples
    --------
    >>> import numpy as np
    >>> smallest_space(np.full(81, 0.5))
    'sRGB'
    """
    for space in COMMON_SPACES:
        candidate = sensor(space, illuminant, observer)
        if candidate.contains(candidate.rgb(reflectances)).all():
            return space
    return None


def holding_note(
    reflectances: ArrayLike, illuminant: str = DEFAULT_ILLUMINANT, observer: str = DEFAULT_OBSERVER
) -> str:
    """Describe the smallest of the common RGB spaces that holds all colours of reflectances.

    Parameters
    ----------
    reflectances : array_like, shape (E, N)
        Reflectances, as for `smallest_space`.
    illuminant : str
        Illuminant that the RGB refer to.
    observer : str
        Colour-matching functions.

    Returns
    -------
    str
        Such as "Display P3 holds all 24".

    Raises
    ------
    UnknownNameError
        The illuminant or the observer is unknown.
    """
    space = smallest_space(reflectances, illuminant, observer)
    if space is None:
        return f"none of {', '.join(COMMON_SPACES)} holds all"
    return f"{space} holds all {len(np.asarray(reflectances))}"
