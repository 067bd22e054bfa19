"""Sensors: the linear map from reflectance to linear RGB, as plain arrays
(docs/mathematics.md, 1).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.illuminants import Illuminant, Lamp
from uplift.common.arrays import Array, Mask, Values, as_array, as_nm
from uplift.common.errors import ColourError

SLACK = 1e-6
"""Distance from [0, 1] that counts as rounding, of conversions in single precision."""
ROUNDING = 1e-12
"""Size of a number that is printed as 0."""
MIN_CODE = 10
"""Largest of three whole numbers from which they are taken for 8-bit codes."""

DECODE = "convert 8-bit codes with Cube.decode"


def in_unit_cube(rgb: Values) -> Mask:
    """Test whether (…) RGB (…, 3) are in gamut: in [0, 1], up to `SLACK`; False for
    NaN.
    """
    return np.asarray(((rgb >= -SLACK) & (rgb <= 1 + SLACK)).all(axis=-1))


def as_rgb(rgb: ArrayLike) -> Values:
    """Convert to an array of RGB triples. Shapes: ``rgb`` (…, 3) → (…, 3)."""
    is_single = isinstance(rgb, np.ndarray) and rgb.dtype == np.float32
    if getattr(rgb, "dtype", None) == np.uint8:
        problem = "linear RGB must be floats, got an array of 8-bit codes"
        raise ColourError(problem, code="rgb-like-codes", hint=DECODE)
    array: Values = as_array(rgb, ColourError, np.float32 if is_single else float)
    if array.ndim == 0 or array.shape[-1] != 3:
        hint = "pass [R, G, B], or colours of shape (…, 3), without alpha"
        raise ColourError(
            f"a colour is three numbers, got an array of shape {array.shape}", hint=hint
        )
    return array


def raise_out_of_gamut(outside: Array) -> NoReturn:
    """Raise the error for colours outside [0, 1]. Shapes: ``outside`` (n, 3)."""
    colour = outside[0]
    text = f"linear RGB {format_rgb(colour)}"
    if in_unit_cube(np.round(colour, 5)):
        text = f"linear RGB {format_rgb(colour, '.9g')}"  # the digits that are outside
    if not np.isfinite(colour).all():
        raise ColourError(f"{text} is not finite", hint="pass numbers in [0, 1]")
    problem = f"{text} lies outside [0, 1]"
    if (
        (colour == np.round(colour)).all()
        and colour.min() >= 0
        and MIN_CODE <= colour.max() <= 255
    ):
        raise ColourError(problem, code="rgb-like-codes", hint=DECODE)
    hint = "map it with uplift.colorimetry.gamut.map_to_gamut"
    raise ColourError(problem, code="rgb-out-of-gamut", hint=hint)


def format_rgb(rgb: Array, digits: str = "g") -> str:
    """Format a colour (3,) for a message. Rounding errors of 0 are 0."""
    return (
        "("
        + ", ".join(
            "0" if abs(value) < ROUNDING else f"{value:{digits}}" for value in rgb
        )
        + ")"
    )


@dataclass(frozen=True, eq=False)
class Light:
    """An illuminant with an observer: the linear map from reflectance to XYZ.

    Parameters
    ----------
    name : str
        Name of the illuminant.
    xyz : ndarray, shape (3, N)
        Weights; ``xyz @ reflectance`` is XYZ, with Y = 1 for the perfect reflector.
    lamp : Lamp, optional
        The measured lamp, whose name alone does not identify it.
    """

    name: str
    xyz: Array
    lamp: Lamp | None = None

    @property
    def illuminant(self) -> Illuminant:
        """The lamp, or the name of the illuminant."""
        return self.lamp or self.name

    @cached_property
    def white(self) -> Array:
        """XYZ of the perfect reflector, shape (3,)."""
        return self.xyz.sum(axis=1)


@dataclass(frozen=True, eq=False)
class Sensor:
    """Observer, illuminant and RGB space combined to a 3×N matrix.

    Parameters
    ----------
    space, illuminant, observer : str
        Names, as colour-science spells them.
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm, evenly spaced, ascending.
    cmfs : ndarray, shape (N, 3)
        Colour-matching functions.
    power : ndarray, shape (N,)
        Relative spectral power of the illuminant.
    xyz_to_rgb : ndarray, shape (3, 3)
        XYZ under the illuminant, where white has Y = 1, to linear RGB, where white is
        (1, 1, 1). For a camera, an approximation, for distances between colours only.
    decoding : ndarray, shape (256,)
        Linear value of each 8-bit code of the space. Those of log curves begin below 0
        and end above 1.
    sensitivities : ndarray, shape (N, 3), optional
        Spectral sensitivities of a camera, whose raw values the RGB are. By default RGB
        are a linear map of XYZ.
    """

    space: str
    illuminant: str
    observer: str
    wavelengths: Array
    cmfs: Array
    power: Array
    xyz_to_rgb: Array
    decoding: Array
    sensitivities: Array | None = None

    def __post_init__(self) -> None:
        as_nm(self.wavelengths)

    @property
    def range(self) -> tuple[float, float, float]:
        """First and last wavelength and step in nm."""
        return (
            float(self.wavelengths[0]),
            float(self.wavelengths[-1]),
            float(np.diff(self.wavelengths[:2])[0]),
        )

    @cached_property
    def light(self) -> Light:
        """The build illuminant."""
        # X, Y, Z of g are Σ x̄ S g / Σ ȳ S, and so on: the perfect reflector, g = 1,
        # has Y = 1.
        weights = self.cmfs * self.power[:, None]
        return Light(self.illuminant, (weights / weights[:, 1].sum()).T)

    @cached_property
    def matrix(self) -> Array:
        """W, shape (3, N): ``W @ reflectance`` is linear RGB; the perfect reflector
        gives (1, 1, 1).
        """
        # W_ci = Σ_k M_ck · XYZ weights of k at wavelength i: colours are linear in the
        # reflectance.
        if self.sensitivities is None:
            return self.xyz_to_rgb @ self.light.xyz
        # Raw values of a camera: each channel is divided by that of the perfect
        # reflector.
        weights = self.sensitivities * self.power[:, None]
        return np.asarray((weights / weights.sum(axis=0)).T)

    def require_xyz(self) -> None:
        """Raise `ColourError` (``camera-without-xyz``) for a camera, whose raw values
        do not determine XYZ.
        """
        if self.sensitivities is not None:
            raise ColourError(
                (
                    f"the colours of '{self.space}' are raw values of a camera, and no "
                    "matrix converts them to or from XYZ"
                ),
                code="camera-without-xyz",
                hint="give raw values, or use a cube of an RGB space",
            )

    @cached_property
    def rgb_to_xyz(self) -> Array:
        """Matrix from linear RGB to XYZ under the build illuminant, shape (3, 3)."""
        return np.asarray(np.linalg.inv(self.xyz_to_rgb))

    def rgb(self, reflectance: ArrayLike) -> Array:
        """Compute the linear RGB of reflectances.

        Parameters
        ----------
        reflectance : array_like, shape (..., N)
            Reflectances in units of 1 at ``wavelengths``.

        Returns
        -------
        ndarray, shape (..., 3)
        """
        return as_array(reflectance) @ self.matrix.T

    def xyz(self, rgb: ArrayLike) -> Array:
        """Convert linear RGB to XYZ under the build illuminant; approximately for a
        camera.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (..., 3)
        """
        return as_array(rgb) @ self.rgb_to_xyz.T

    def grey(self, rgb: ArrayLike) -> Array:
        """Return the greys of the luminances of colours.

        Parameters
        ----------
        rgb : array_like, shape (..., 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (..., 3)
            Linear RGB with equal channels, in [0, 1].
        """
        return np.clip(self.xyz(rgb)[..., 1:2], 0, 1).repeat(3, axis=-1)

    def decode(self, codes: ArrayLike) -> Array:
        """Convert 8-bit codes to linear values.

        Parameters
        ----------
        codes : array_like
            Codes from 0 to 255; fractions are interpolated.

        Returns
        -------
        ndarray
            Linear values, of the same shape.
        """
        return np.interp(as_array(codes), np.arange(256), self.decoding)
