"""All mixing models of RGB by name: spectral ones, by uplifting with a cube, and
heuristics of RGB.

HSL: hue, saturation and lightness in [0, 1], hue 0 is red, 1/3 green, 2/3 blue (GSPC,
"Status Report of the Graphics Standards Planning Committee", 1979; Fishkin 1983,
section 5.3.5).

RYB-HSL (Fishkin 1983, section 10.4): the centroid in the double cone of figure 10.3,
whose radius is chroma. Two errors in the printed hue map are corrected: its middle
third subtracts 1/3, but only adding continues from yellow (1/6 → 1/3); and its slope of
1/2 jumps to 2/3 at blue, where a slope of 2/3 joins both ends. Green, 1/3, maps to 4/9.

Phosphor curves (Fishkin 1983, chapter 7): the curve of a colour is the sum of the
monitor's phosphor spectra that display it (eq. 7.1). Curves are treated as
transmittances and multiplied as filters (eq. 9.1). The result is the monitor RGB that
matches the product.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT
from uplift.colorimetry.tables import samples
from uplift.common.arrays import Array
from uplift.extras.paint.coats import Dyes
from uplift.extras.paint.duntley import beam_to_diffuse, diffuse_to_beam
from uplift.extras.paint.optics import (
    Surface,
    as_shares,
    average_areas,
    stack_filters,
    weighted_sum,
)
from uplift.extras.paint.pigments import (
    CONSTANT,
    SQUARE_ROOT,
    Pigment,
    Scattering,
    dispersive,
    from_opaque,
)
from uplift.lookup.cube import Cube

# from components (..., n, K) and parts (..., n) to the mixture (..., K)
Mix = Callable[[Array, Array], Array]
CRT = "Typical CRT Brainard 1997"
"""Phosphors of a cathode-ray tube, measured by D. H. Brainard."""
OIL = Surface.of_index(1.5)
# For each sixth of the hues: indices of red, green and blue among (largest, rising,
# smallest, falling).
SEXTANTS = np.array([[0, 1, 2], [3, 0, 2], [2, 0, 1], [2, 3, 0], [1, 2, 0], [0, 2, 3]])
RGB_WHEEL = (0.0, 1 / 6, 2 / 3, 1.0)
RYB_WHEEL = (0.0, 1 / 3, 2 / 3, 1.0)  # hues of red, yellow, blue and red again


def mixers(cube: Cube) -> dict[str, Mix]:
    """Return the models by title, from linear RGB (n, 3) and parts (..., n) to linear
    RGB (..., 3), which may leave the gamut: spectral ones, for colours uplifted by a
    cube, and heuristics of RGB.
    """
    sensor = cube.data.sensor
    law = dispersive(sensor)
    paints = _paints(law)

    def in_oil(spectra: Array, parts: Array) -> Array:
        return OIL.apply(paints(OIL.beneath(spectra), parts))

    def in_beam(spectra: Array, parts: Array) -> Array:
        return diffuse_to_beam(paints(beam_to_diffuse(spectra), parts))

    def dyes(spectra: Array, parts: Array) -> Array:
        return Dyes(spectra).coat(parts).over(1.0)

    def uplifted(mix: Mix) -> Mix:
        return lambda rgb, parts: sensor.rgb(mix(cube.reflectance(rgb), parts))

    return {
        "Kubelka–Munk": uplifted(paints),
        "Kubelka–Munk, in oil (index 1.5)": uplifted(in_oil),
        "Kubelka–Munk, S = √R": uplifted(_paints(SQUARE_ROOT)),
        "Kubelka–Munk, S = 1": uplifted(_paints(CONSTANT)),
        "Amy's approximation": uplifted(_paints(law, Pigment.amy_opaque_reflectance)),
        "Duntley, in directed light": uplifted(in_beam),
        "dyes on white": uplifted(dyes),
        "filters": uplifted(stack_filters),
        "average of RGB": average_areas,  # Fishkin 1983, eq. 8.3
        "product of RGB": stack_filters,  # eq. 9.2
        "RYB-HSL": lambda rgb, parts: mix_ryb(np.clip(rgb, 0, 1), parts),  # 10.4
        "phosphor curves": mix_phosphors,  # chapter 7
    }


def _paints(
    scattering: Scattering,
    reflectance: Callable[[Pigment], Array] = Pigment.opaque_reflectance,
) -> Mix:
    """Return the mixer of the reflectances of opaque paints."""

    def mix(spectra: Array, parts: Array) -> Array:
        return reflectance(from_opaque(spectra, scattering).mix(parts))

    return mix


def hsl_to_rgb(hsl: ArrayLike) -> Array:
    """Convert hue, saturation and lightness (..., 3) to RGB.

    The largest and the smallest component follow from lightness and saturation as in
    HSL, the third as in HSV. Only the sixth of the hue circle that contains the hue is
    computed (Fishkin 1983, 5.3.5).
    """
    hue, saturation, lightness = np.moveaxis(np.asarray(hsl, dtype=float), -1, 0)
    largest = np.where(
        lightness <= 0.5,
        lightness * (1 + saturation),
        lightness + saturation - lightness * saturation,
    )
    smallest = 2 * lightness - largest
    position = 6 * (hue % 1)
    sextant = np.minimum(position.astype(int), 5)  # −1e-17 % 1 is 1
    change = (largest - smallest) * (position - sextant)
    values = np.stack([largest, smallest + change, smallest, largest - change], axis=-1)
    return np.take_along_axis(values, SEXTANTS[sextant], axis=-1)


def rgb_to_hsl(rgb: ArrayLike) -> Array:
    """Convert RGB (..., 3) in [0, 1] to hue, saturation and lightness."""
    rgb = np.asarray(rgb, dtype=float)
    largest = rgb.max(axis=-1)
    smallest = rgb.min(axis=-1)
    chroma = largest - smallest
    lightness = (largest + smallest) / 2
    red, green, blue = np.moveaxis(rgb, -1, 0)
    safe = np.where(chroma > 0, chroma, 1)
    position = np.select(
        [largest == red, largest == green],
        [(green - blue) / safe % 6, (blue - red) / safe + 2],
        (red - green) / safe + 4,
    )
    hue = np.where(chroma > 0, position / 6 % 1, 0)
    return np.stack([hue, _saturation(chroma, lightness), lightness], axis=-1)


def _saturation(chroma: Array, lightness: Array) -> Array:
    """Return chroma as a fraction of the largest of its lightness; 0 of black and
    white.
    """
    largest = np.minimum(2 * lightness, 2 - 2 * lightness)
    return np.where(largest > 0, chroma / np.where(largest > 0, largest, 1), 0)


def mix_ryb(rgb: ArrayLike, parts: ArrayLike) -> Array:
    """Mix RGB (..., n, 3) in [0, 1] by parts (..., n) as paints on the wheel of red,
    yellow and blue.
    """
    rgb = np.asarray(rgb, dtype=float)
    # To the double cone: x, y and lightness.
    hue, _, lightness = np.moveaxis(rgb_to_hsl(rgb), -1, 0)
    angle = 2 * np.pi * np.interp(hue, RGB_WHEEL, RYB_WHEEL)
    chroma = rgb.max(axis=-1) - rgb.min(axis=-1)
    cone = np.stack(
        [chroma * np.cos(angle), chroma * np.sin(angle), lightness], axis=-1
    )
    # The centroid, and back.
    x, y, lightness = np.moveaxis(weighted_sum(cone, as_shares(parts)), -1, 0)
    hue = np.interp(np.arctan2(y, x) / (2 * np.pi) % 1, RYB_WHEEL, RGB_WHEEL)
    saturation = _saturation(np.hypot(x, y), lightness)
    return hsl_to_rgb(np.stack([hue, np.minimum(saturation, 1), lightness], axis=-1))


def mix_phosphors(rgb: ArrayLike, thickness: ArrayLike) -> Array:
    """Mix linear RGB (..., n, 3) as filters of a thickness (..., n) with phosphor
    curves.
    """
    curves, to_rgb = phosphor_curves()
    return np.maximum(
        stack_filters(np.asarray(rgb, dtype=float) @ curves, thickness) @ to_rgb.T, 0
    )


@cache
def phosphor_curves() -> tuple[Array, Array]:
    """Return the curves (3, N) of a cathode-ray tube's primaries, and the matrix (3, N)
    from a curve to its RGB.

    The curve of white is scaled to a maximum of 1 (Fishkin 1983, section 7.2), so that
    no curve amplifies light.
    """
    phosphors = samples("display", CRT).T
    matching = observer.matching_functions()
    white = observer.light(DEFAULT_ILLUMINANT).white
    curves = phosphors * np.linalg.solve((phosphors @ matching).T, white)[:, None]
    curves /= curves.sum(axis=0).max()
    return curves, np.asarray(
        np.linalg.solve((curves @ matching).T, matching.T), dtype=float
    )
