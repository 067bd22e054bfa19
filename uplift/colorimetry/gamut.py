"""Display gamuts by primaries and white, and gamut mapping of linear RGB outside [0, 1]
(docs/guides/acescg.md).

Fishkin 1983, *Applying Color Science to Computer Graphics*, chapters 4 and 6: a colour
too bright for the display is scaled (6.1); a chromaticity outside the triangle of the
primaries moves toward white on a straight line, which keeps the dominant wavelength
(6.2.3). There the thesis keeps R + G + B, here the luminance is kept.

In Oklab (Ottosson 2020, "A perceptual color space for image processing") lines of
constant hue are nearly straight.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import (
    as_rgb,
    format_rgb,
    in_unit_cube,
    raise_out_of_gamut,
)
from uplift.common.arrays import Array, Mask, Values, blocks
from uplift.common.errors import ColourError, OptionError, unknown_name

BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)
"""XYZ to the cone responses of Bradford adaptation (Lam 1985; the matrix of ICC.1:2022,
annex E).
"""

Chromaticity = tuple[float, float]
"""CIE x, y."""
PRIMARIES = "give x,y of red, green, blue and white"
CONES = np.array(
    [
        [0.8189330101, 0.3618667424, -0.1288597137],
        [0.0329845436, 0.9293118715, 0.0361456387],
        [0.0482003018, 0.2643662691, 0.6338517070],
    ]
)
"""XYZ under D65 to cone responses."""
OKLAB = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""Cube roots of cone responses to L, a, b."""
NEARLY = 2.5e-3
"""Linear RGB, relative to the largest component, by which a line in Oklab may leave the
gamut before its edge.

The boundary is concave near blue: lines from grey leave sRGB by 0.0008, ACEScg by
0.0021, and return.
"""
HALVINGS = 24
"""Bisection steps along a line."""

LARGEST = 1e300
"""Colours are scaled down to components of this magnitude where sums of three could
overflow.
"""

BLOCK = 1 << 13
"""Colours mapped per block; the temporary arrays of a block fit into a processor's
cache.
"""


class Gamut(Protocol):
    """An RGB space whose linear RGB in [0, 1] can be displayed, such as `Primaries` and
    sensors.
    """

    @property
    def rgb_to_xyz(self) -> Array:
        """Matrix from linear RGB to XYZ; white, (1, 1, 1), has Y = 1. Shape (3, 3)."""
        ...


@dataclass(frozen=True)
class Primaries:
    """A display gamut by the chromaticities of its primaries and white.

    Parameters
    ----------
    red, green, blue : tuple of float
        CIE x, y of the primaries.
    white : tuple of float
        CIE x, y of the white, inside their triangle.

    Raises
    ------
    OptionError
        The primaries do not span a triangle with the white inside.
    """

    red: Chromaticity
    green: Chromaticity
    blue: Chromaticity
    white: Chromaticity
    lengths: Array = field(init=False, repr=False, compare=False)
    """X + Y + Z of each primary at full power: ρ, γ and β of equation 4.5; shape (3,).
    """
    rgb_to_xyz: Array = field(init=False, repr=False, compare=False)
    """Matrix from linear RGB to XYZ; white has Y = 1; shape (3, 3)."""

    def __post_init__(self) -> None:
        # Equation 4.4: the columns are the chromaticities (x, y, 1 − x − y) times their
        # lengths, and add up to white.
        *columns, white = np.array(
            [
                [x, y, 1 - x - y]
                for x, y in (self.red, self.green, self.blue, self.white)
            ]
        )
        with np.errstate(all="ignore"):
            matrix = np.array(columns).T
            regular = abs(np.linalg.det(matrix)) > 1e-6  # False for NaN
            lengths = (
                np.linalg.solve(matrix, white / white[1]) if regular else np.zeros(3)
            )
            if not ((lengths > 0) & np.isfinite(lengths)).all():
                problem = (
                    "primaries must span a triangle with the white inside, got "
                    f"({self})"
                )
                raise OptionError(problem, hint=PRIMARIES)
        object.__setattr__(self, "lengths", lengths)
        object.__setattr__(self, "rgb_to_xyz", matrix * lengths)

    @classmethod
    def of(cls, numbers: Sequence[float]) -> "Primaries":
        """Create primaries from eight numbers, in the order of OpenEXR headers.

        Parameters
        ----------
        numbers : sequence of float, length 8
            x, y of red, green, blue and white.

        Returns
        -------
        Primaries

        Raises
        ------
        OptionError
            There are not eight numbers, or they do not define a gamut.
        """
        if len(numbers) != 8:
            problem = f"primaries and white are eight numbers, got {len(numbers)}"
            raise OptionError(problem, hint=PRIMARIES)
        pairs = [
            (float(x), float(y))
            for x, y in zip(numbers[::2], numbers[1::2], strict=True)
        ]
        return cls(*pairs)

    def __str__(self) -> str:
        return " ".join(
            f"{x:g},{y:g}" for x, y in (self.red, self.green, self.blue, self.white)
        )


SRGB = Primaries((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))
"""The sRGB gamut (IEC 61966-2-1)."""


def conversion(source: Gamut, target: Gamut) -> Array:
    """Compute the matrix (3, 3) between the linear RGB of two gamuts, with Bradford
    adaptation of the white.
    """
    before, after = (
        BRADFORD @ gamut.rgb_to_xyz.sum(axis=1) for gamut in (source, target)
    )
    adapt = np.linalg.solve(BRADFORD, (after / before)[:, None] * BRADFORD)
    matrix = np.linalg.solve(target.rgb_to_xyz, adapt @ source.rgb_to_xyz)
    return matrix / matrix.sum(axis=1, keepdims=True)


def cone_responses(gamut: Gamut) -> Array:
    """Matrix (3, 3) from linear RGB to cone responses, adapted so that the white of the
    gamut gives (1, 1, 1).
    """
    matrix = CONES @ gamut.rgb_to_xyz
    return matrix / matrix.sum(axis=1, keepdims=True)


def oklab(rgb: Array, gamut: Gamut) -> Array:
    """Convert linear RGB (…, 3) to L, a, b (…, 3)."""
    return np.asarray(np.cbrt(rgb @ cone_responses(gamut).T) @ OKLAB.T)


def cube_roots(lab: Array) -> Array:
    """Convert L, a, b (…, 3) to cube roots of cone responses (…, 3)."""
    return np.asarray(lab @ np.linalg.inv(OKLAB).T)


def clip(rgb: Array, gamut: Gamut) -> Array:
    """Clip each component separately, which changes chromaticity, hue and luminance
    (Fishkin, 6.1.1).
    """
    return np.clip(rgb, 0, 1)


def scale(rgb: Array, gamut: Gamut) -> Array:
    """Move toward white at constant luminance until no component is negative, then
    divide by the largest.

    The dominant wavelength is kept. So is the chromaticity of colours that are only too
    bright.
    """
    luminance = rgb @ gamut.rgb_to_xyz[1, :, None]
    inside = _toward_grey(rgb, np.maximum(luminance, 0), np.inf)
    return inside / np.maximum(inside.max(axis=1, keepdims=True), 1)


def desaturate(rgb: Array, gamut: Gamut) -> Array:
    """Move toward white at constant luminance and dominant wavelength until all
    components are in [0, 1].

    A luminance of at least that of white gives white. A luminance of at most 0 gives
    black.
    """
    luminance = rgb @ gamut.rgb_to_xyz[1, :, None]
    return _toward_grey(rgb, np.clip(luminance, 0, 1), 1)


def _toward_grey(rgb: Array, grey: Array, top: float) -> Array:
    """Mix with grey (n, 1) in [0, top], keeping as much colour as all components in [0,
    top] allow.
    """
    # grey + f (rgb − grey) meets 0 at f = grey / (grey − low), and the top at (top −
    # grey) / (high − grey).
    low = rgb.min(axis=1, keepdims=True)
    high = rgb.max(axis=1, keepdims=True)
    below = np.ones_like(grey)
    above = np.ones_like(grey)
    np.divide(grey, grey - low, out=below, where=low < 0)
    np.divide(top - grey, high - grey, out=above, where=high > top)
    return grey + np.minimum(below, above) * (rgb - grey)


def desaturate_oklab(rgb: Array, gamut: Gamut) -> Array:
    """Move toward grey at constant lightness and hue of Oklab, which keeps the hue of
    reds and yellows better.
    """
    lab = oklab(rgb, gamut)
    # One row per response, then one per component: contiguous rows are twice as fast
    # here.
    grey = np.ascontiguousarray(cube_roots(np.clip(lab[:, :1], 0, 1) * [1, 0, 0]).T)
    chroma = np.ascontiguousarray(cube_roots(lab * [0, 1, 1]).T)
    to_rgb = np.linalg.inv(cone_responses(gamut))
    inner = np.zeros(len(rgb))
    outer = np.ones(len(rgb))
    for _ in range(HALVINGS):
        middle = (inner + outer) / 2
        trial = to_rgb @ _cube(grey + middle * chroma)
        high = trial.max(axis=0)
        fits = (trial.min(axis=0) >= -NEARLY * high) & (high <= 1 + NEARLY)
        inner = np.where(fits, middle, inner)
        outer = np.where(fits, outer, middle)
    return desaturate((to_rgb @ _cube(grey + inner * chroma)).T, gamut)


def _cube(values: Array) -> Array:
    """Third power, faster than numpy's ``**``."""
    return values * values * values


Mapping = Callable[[Array, Gamut], Array]
"""Function from finite linear RGB (n, 3) outside [0, 1] to linear RGB (n, 3) inside, up
to rounding.
"""
MAPPINGS: dict[str, Mapping] = {"clip": clip, "scale": scale, "desaturate": desaturate}
MAPPINGS["desaturate-oklab"] = desaturate_oklab
METHODS = ("error", *MAPPINGS)
"""Names of the methods; ``"error"`` raises instead of moving a colour."""


@dataclass(frozen=True, eq=False)
class GamutMapped:
    """Linear RGB before and after gamut mapping.

    Parameters
    ----------
    requested : ndarray, shape (..., 3)
        Linear RGB before the mapping.
    rgb : ndarray, shape (..., 3)
        Linear RGB after it, in [0, 1].
    outside : ndarray of bool, shape (...)
        Colours that were outside [0, 1].
    """

    requested: Values
    rgb: Values
    outside: Mask

    @property
    def count(self) -> int:
        """Number of colours that were moved.

        Returns
        -------
        int
        """
        return int(self.outside.sum())

    @property
    def max_change(self) -> float:
        """Largest absolute change of a component.

        Returns
        -------
        float
        """
        return float(
            np.abs(self.requested[self.outside] - self.rgb[self.outside]).max(initial=0)
        )


def map_to_gamut(rgb: ArrayLike, gamut: Gamut, method: str = "error") -> GamutMapped:
    """Move linear RGB outside [0, 1] inside; in-gamut colours are unchanged, bit for
    bit.

    Parameters
    ----------
    rgb : array_like, shape (..., 3)
        Linear RGB. float32 stays float32. Deviations by rounding
        (`uplift.colorimetry.sensor.SLACK`) are in gamut.
    gamut : Gamut
        The RGB space of ``rgb``: a cube's sensor, `Primaries`, or `SRGB`.
    method : str
        One of `METHODS`.

    Returns
    -------
    GamutMapped
        The colours before and after, and which of them were moved.

    Raises
    ------
    ColourError
        A colour that needs mapping is not finite, or lies outside [0, 1] and ``method``
        is ``"error"``.
    UnknownNameError
        The method is unknown.

    Examples
    --------
    >>> from uplift.colorimetry.gamut import SRGB
    >>> map_to_gamut([[0.2, 0.4, 0.6], [1.4, 0.2, -0.1]], SRGB, "clip").rgb.tolist()
    [[0.2, 0.4, 0.6], [1.0, 0.2, 0.0]]
    """
    check_method(method)
    requested = as_rgb(rgb)
    outside = ~in_unit_cube(requested)
    inside = np.clip(requested, 0, 1)
    if outside.any():
        rows = requested[outside].astype(float)
        if method == "error":
            raise_out_of_gamut(rows)
        finite = np.isfinite(rows).all(axis=1)
        if not finite.all():
            problem = f"linear RGB {format_rgb(rows[finite.argmin()])} is not finite"
            raise ColourError(problem, hint="fix its source")
        if method != "clip":  # which leaves other channels as they are
            rows *= np.minimum(
                1, LARGEST / np.maximum(np.abs(rows).max(axis=1, keepdims=True), 1)
            )
        mapped = np.concatenate(
            [MAPPINGS[method](rows[block], gamut) for block in blocks(len(rows), BLOCK)]
        )
        inside[outside] = np.clip(mapped, 0, 1)  # removes rounding errors
    return GamutMapped(requested, inside, outside)


def check_method(method: str) -> None:
    """Validate the name of a gamut mapping method."""
    if method not in METHODS:
        raise unknown_name(method, METHODS, "gamut mapping")
