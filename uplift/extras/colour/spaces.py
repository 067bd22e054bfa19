"""RGB spaces by name: of colour-science, of OpenColorIO (``$OCIO`` and its built-in
ACES), or by chromaticities.
"""

import functools
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry import tables
from uplift.colorimetry.gamut import Gamut, Primaries, conversion
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.tables import RgbSpace
from uplift.common.arrays import Array
from uplift.common.errors import OptionError, UnknownNameError, unknown_name
from uplift.common.files import check_regular
from uplift.common.text import format_value, parse_float
from uplift.extras.colour.srgb import encode

VARIABLE = "OCIO"
"""Environment variable with the path of a configuration."""
CONFIGURATION_HINT = (
    "correct the environment variable OCIO, or unset it to use the built-in "
    "configuration"
)
BUILT_IN = "ocio://studio-config-latest"
REFERENCE = "ACES2065-1"
AP0 = Primaries((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077), (0.32168, 0.33767))
"""Primaries of the reference (SMPTE ST 2065-1)."""
FIRST_SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "Adobe RGB (1998)")
"""Spaces of colour-science that stand for others with the same primaries."""
MAX_MATRIX_DIFFERENCE = 1e-3
"""Largest difference between matrices of the same primaries, of which some are rounded.
"""
MAX_PRIMARIES_DIFFERENCE = 5e-3
"""Largest difference in linear RGB between primaries that count as equal."""
MAX_CURVE_DIFFERENCE = 0.5
"""Largest difference in 8-bit sRGB codes between tone curves that count as equal."""
ALL_SPACES = "tables.names('RGB space')"
NUMBERS = re.compile(r"[-+\d.eE,;\s]+")


@dataclass(frozen=True, eq=False)
class ImageSpace:
    """The RGB space of colours to read."""

    name: str
    """Name for messages."""
    gamut: Gamut
    """Primaries of the linear RGB that `decode` returns."""
    decode: Callable[[Array], Array] | None = None
    """From codes (..., 3), 0 to 1, to linear RGB (..., 3). None for the transfer
    function of the cube's space.
    """
    floats_are_codes: bool = False
    """Whether floats of the space are codes, too, as those of encoded spaces of
    OpenColorIO.
    """
    mixes_channels: bool = False
    """Whether `decode` computes each component from all three."""
    to_gamut: Array | None = None
    """Matrix (3, 3) from decoded values, such as CIE XYZ, to linear RGB of `gamut`."""

    @property
    def is_encoded(self) -> bool:
        """Whether `decode` is a curve."""
        grey = np.full((1, 3), 0.5)
        return self.decode is not None and not np.allclose(self.decode(grey), grey)

    def matrix(self, target: Gamut) -> Array:
        """Compute the matrix (3, 3) from decoded values to linear RGB of a gamut."""
        matrix = conversion(self.gamut, target)
        return matrix if self.to_gamut is None else matrix @ self.to_gamut

    def matrix_to(self, sensor: Sensor) -> Array | None:
        """Compute the matrix (3, 3) to the linear RGB of a sensor; None if the
        primaries are equal.
        """
        sensor.require_xyz()
        matrix = self.matrix(sensor)
        return (
            None
            if np.abs(matrix - np.eye(3)).max() <= MAX_PRIMARIES_DIFFERENCE
            else matrix
        )

    def agrees_with(self, sensor: Sensor, *, encoded: bool) -> bool:
        """Whether the space is that of a sensor, up to rounding."""
        if (
            sensor.sensitivities is not None
            or self.mixes_channels
            or self.matrix_to(sensor) is not None
        ):
            return False
        if not encoded or self.decode is None:
            return True
        codes = np.repeat(np.arange(256)[:, None] / 255, 3, axis=1)
        difference = encode(self.decode(codes)) - encode(sensor.decoding)[:, None]
        return bool(255 * np.abs(difference).max() <= MAX_CURVE_DIFFERENCE)


@dataclass(frozen=True, eq=False)
class OcioSpace:
    """A colour space of a configuration of OpenColorIO."""

    name: str
    """Its name in the configuration."""
    is_linear: bool
    """Whether its encoding is scene-linear."""
    processor: Any
    """CPU processor to linear RGB of `AP0`."""

    def convert(self, values: Array) -> Array:
        """Convert values. Shapes: ``values`` (…, 3) → (…, 3)."""
        converted = np.array(values, dtype=np.float32, order="C")
        if converted.size:
            self.processor.applyRGB(converted.reshape(-1, 3))
        return converted.astype(float)

    @functools.cached_property
    def matrix(self) -> Array:
        """Matrix (3, 3) of a linear space."""
        return self.convert(np.eye(3)).T

    @property
    def rgb_to_xyz(self) -> Array:
        """Matrix (3, 3) of a linear space to XYZ, which makes it a `Gamut`."""
        return AP0.rgb_to_xyz @ self.matrix

    def as_image_space(self) -> ImageSpace:
        """Return the space with its own primaries if it is linear RGB, else converted
        to `AP0`.
        """
        if self.is_linear:
            white = self.matrix.sum(axis=1)
            is_rgb = np.abs(white - 1).max() <= MAX_MATRIX_DIFFERENCE
            if is_rgb:
                return ImageSpace(self.name, self, lambda codes: codes)
            # In CIE XYZ, (1, 1, 1) is not white.
            return ImageSpace(self.name, AP0, lambda codes: codes, to_gamut=self.matrix)
        return ImageSpace(
            self.name, AP0, self.convert, floats_are_codes=True, mixes_channels=True
        )


def find_space(text: str) -> ImageSpace:
    """Find an RGB space by chromaticities, or by name: of ``$OCIO``, colour-science, or
    the built-in configuration.

    >>> find_space("rec2020").name, find_space("lin_ap1_scene").name
    ('ITU-R BT.2020', 'ACEScg')
    """
    if NUMBERS.fullmatch(text):
        try:
            numbers = [parse_float(word) for word in re.split(r"[,;\s]+", text.strip())]
        except ValueError as error:
            problem = (
                "primaries must be the name of a space or eight numbers, got "
                f"{format_value(text)}"
            )
            hint = "give x,y of red, green, blue and white"
            raise OptionError(problem, hint=hint) from error
        return ImageSpace(text, Primaries.of(numbers))
    if (found := find_ocio_space(text, built_in=False)) is not None:
        return found.as_image_space()
    space = tables.rgb_space(text)
    if space is None:
        if (found := find_ocio_space(text)) is not None:
            return found.as_image_space()
        _check_colours(text)
        spaces = _configuration(BUILT_IN).getColorSpaces()
        names = [space.getName() for space in spaces if not space.isData()]
        known = (*tables.names("RGB space"), *names)
        raise unknown_name(text, known, "RGB space", ALL_SPACES)
    is_xyz = np.array_equal(space.primaries, np.eye(3)[:, :2])
    if is_xyz and (found := find_ocio_space(space.name)) is not None:
        return (
            found.as_image_space()
        )  # colour-science takes the white of CIE XYZ-D65 for that of illuminant E
    return ImageSpace(space.name, primaries_of(space), space.cctf_decoding)


def look_up_space(name: str) -> RgbSpace:
    """Find an RGB space of colour-science, also by the name of OpenColorIO of a space
    with the same primaries.
    """
    if (found := tables.rgb_space(name)) is not None:
        return found
    if (space := find_ocio_space(name)) is not None:
        for known in map(tables.rgb_space, (*FIRST_SPACES, *tables.names("RGB space"))):
            if known is not None:
                difference = space.matrix - conversion(primaries_of(known), AP0)
                if np.abs(difference).max() <= MAX_MATRIX_DIFFERENCE:
                    return known
    _check_colours(name)
    raise unknown_name(name, tables.names("RGB space"), "RGB space", ALL_SPACES)


def primaries_of(space: RgbSpace) -> Primaries:
    """Return the primaries and white of an RGB space of colour-science."""
    return Primaries.of([*space.primaries.ravel(), *space.whitepoint])


def _check_colours(name: str) -> None:
    """Raise `UnknownNameError` for the name of a data space of OpenColorIO."""
    for place in (os.environ.get(VARIABLE), BUILT_IN):
        if not place or not name.isprintable():
            continue
        space = _configuration(place).getColorSpace(name)
        if space is not None and space.isData():
            raise UnknownNameError(
                f"'{name}' is a data space of OpenColorIO: its numbers are not colours",
                hint=f"name an RGB space; {ALL_SPACES} lists all",
            )


def find_ocio_space(name: str, *, built_in: bool = True) -> OcioSpace | None:
    """Find a colour space of OpenColorIO by name, alias or role."""
    for place in filter(
        None, (os.environ.get(VARIABLE), BUILT_IN if built_in else None)
    ):
        import PyOpenColorIO

        try:
            config = _configuration(place)
            space = config.getColorSpace(name) if name.isprintable() else None
            if space is None or space.isData():
                continue
            processor = PyOpenColorIO.Config.GetProcessorToBuiltinColorSpace(
                config, space.getName(), REFERENCE
            )
            cpu = processor.getOptimizedCPUProcessor(
                PyOpenColorIO.OPTIMIZATION_LOSSLESS
            )
        except PyOpenColorIO.Exception as error:
            raise OptionError(
                (
                    "the configuration of OpenColorIO cannot be used: "
                    f"{' '.join(str(error).split())}"
                ),
                path=place,
                hint=CONFIGURATION_HINT,
            ) from error
        return OcioSpace(space.getName(), space.getEncoding() == "scene-linear", cpu)
    return None


@functools.lru_cache(maxsize=4)
def _configuration(place: str) -> Any:
    import PyOpenColorIO

    if not place.startswith("ocio:"):
        check_regular(place, OptionError, hint=CONFIGURATION_HINT)
    return PyOpenColorIO.Config.CreateFromFile(place)
