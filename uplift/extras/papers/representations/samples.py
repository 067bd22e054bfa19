"""Spectral representations as rows of functions, those by samples, and the dense
spectra that all of them encode.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import mul
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.papers.wavelengths.quadrature import gauss_rule, interpolatory_rule
from uplift.models.arithmetic import blocked_matmul

STEP = 1.0
"""Distance of dense samples in nm, from 380 to 780 nm."""
TABLE_STRIDE = round(observer.STEP / STEP)
"""Dense samples per sample of the 5 nm tables, of 81 samples, in which lights are
published.
"""


def wavelengths() -> Array:
    """Wavelengths (401,) of dense spectra in nm."""
    return np.arange(observer.START, observer.END + STEP / 2, STEP)


@functools.cache
def xyz_weights() -> Array:
    """Weights (401, 3): ``spectra @ xyz_weights()`` is XYZ, where a power of 1 at every
    wavelength has Y = 1.
    """
    cmfs = observer.matching_functions(step=STEP)
    weights = cmfs / cmfs[:, 1].sum()
    weights.setflags(write=False)
    return weights


def hat_functions(points: Sequence[float] | Array) -> Array:
    """Basis (n, 401) of linear interpolation between ascending ``points`` (n,) nm."""
    return np.stack(
        [np.interp(wavelengths(), points, row) for row in np.eye(len(points))]
    )


def interpolation_matrix(points: Array) -> Array:
    """Matrix (401, n) that maps dense spectra to their values at ``points`` (n,) nm,
    linear between samples.
    """
    return np.maximum(1 - np.abs(wavelengths()[:, None] - points), 0)


@dataclass(frozen=True, eq=False)
class Representation:
    """Encoding of spectra that a renderer can multiply (Kment 2011, section 5.4).

    ``name`` is the abbreviation of the thesis with the number of coefficients, such as
    ``PS16``, and ``family`` the method without its size. A code holds n spectra; its
    type belongs to the representation:

    - ``encode_light`` makes a code of spectral powers (n, 401), ``encode_surface`` of
      reflectances;
    - ``multiply`` makes the code of the light that surfaces reflect, which may meet the
      next surface. Row r of a light meets row r of the surfaces;
    - ``xyz`` is XYZ (n, 3) of lights, in the units of `xyz_weights`;
    - ``storage`` are the numbers stored per spectrum (n,), by default those of a code
      that is a single array;
    - ``decode_light`` and ``decode_surface`` are the spectra (n, 401) that a code
      stands for, if it determines them.
    """

    name: str
    family: str
    encode_light: Callable[[Array], Any]
    encode_surface: Callable[[Array], Any]
    xyz: Callable[[Any], Array]
    multiply: Callable[[Any, Any], Any] = mul
    storage: Callable[[Any], Array] = lambda code: np.full(
        len(code), float(code[0].size)
    )
    decode_light: Callable[[Any], Array] | None = None
    decode_surface: Callable[[Any], Array] | None = None

    def numbers(self, powers: Array, reflectances: Array) -> tuple[float, float]:
        """Return the mean numbers stored of a light, and of a surface."""
        light = self.encode_light(powers)
        surface = self.encode_surface(reflectances)
        return float(self.storage(light).mean()), float(self.storage(surface).mean())

    def reflected(self, powers: Array, reflectances: Array) -> Array:
        """Return XYZ (K, n, 3) of every surface under every light."""
        surfaces = self.encode_surface(reflectances)
        lights = (
            self.encode_light(np.broadcast_to(power, reflectances.shape))
            for power in powers
        )
        return np.stack([self.xyz(self.multiply(light, surfaces)) for light in lights])

    def stored(self, powers: Array, reflectances: Array) -> tuple[Array, Array]:
        """Return lights and surfaces (n, 401) as their codes stand for them. Raises
        `OptionError` if they do not.
        """
        if self.decode_light is None:
            raise OptionError(
                f"{self.name} does not determine a spectrum",
                hint="use PS, PF, RS, TM or SG",
            )
        lights = self.decode_light(self.encode_light(powers))
        decode = self.decode_surface or self.decode_light
        return lights, decode(self.encode_surface(reflectances))


def linear(
    name: str, family: str, encoder: Array, weights: Array, decoder: Array | None = None
) -> Representation:
    """Representation whose codes are linear in the spectra, the same for lights and
    surfaces.

    ``spectra @ encoder`` (401, n) is the code, and ``code @ weights`` (n, 3) the XYZ of
    a light. ``code @ decoder`` (n, 401) is a spectrum with this XYZ, if a sample stands
    for one.
    """
    encode = functools.partial(blocked_matmul, matrix=encoder)
    decode = None if decoder is None else lambda code: code @ decoder
    return Representation(
        name, family, encode, encode, lambda light: light @ weights, decode_light=decode
    )


def sample_points(count: int) -> Array:
    """Evenly spaced wavelengths (count,) in nm from end to end."""
    return np.linspace(observer.START, observer.END, count)


def point_samples(count: int) -> Representation:
    """Point sampling (PS): values at evenly spaced wavelengths, both ends included
    (Kment 2011, sections 5.4, 6.1).

    A choice that the text leaves open: XYZ is the integral of the linear interpolant,
    not a sum over equally sampled colour-matching functions. With the sum, the errors
    at 8, 16 and 32 points would not decrease fourfold from one to the next, as those of
    table 6.1 do.
    """
    points = sample_points(count)
    hats = hat_functions(points)
    encoder = interpolation_matrix(points)
    return linear(f"PS{count}", "point sampling", encoder, hats @ xyz_weights(), hats)


def riemann_sums(count: int) -> Representation:
    """Riemann sums (RS): the mean of a spectrum over each of ``count`` cells (Kment
    2011, section 5.4, eq. 5.3).

    Choices that the text leaves open: sums are divided by the width of their cell, so
    that products are sums of the same kind. XYZ are products times the integral of the
    colour-matching functions over the cell.
    """
    overlaps = cell_overlaps(count)
    means = overlaps / overlaps.sum(axis=1, keepdims=True)
    return linear(
        f"RS{count}", "Riemann sums", means.T, overlaps @ xyz_weights(), overlaps
    )


def cell_overlaps(count: int) -> Array:
    """Fraction (count, 401) of the nanometre around each dense sample that lies in each
    cell.

    The cells have equal widths and cover the range. A sample on a border counts half
    for either side, where eq. 5.3 as printed counts it twice.
    """
    edges = np.linspace(observer.START - STEP / 2, observer.END + STEP / 2, count + 1)
    low = wavelengths() - STEP / 2
    high = wavelengths() + STEP / 2
    overlap = np.minimum(edges[1:, None], high) - np.maximum(edges[:-1, None], low)
    return np.maximum(overlap, 0) / STEP


def gauss_samples(count: int) -> Representation:
    """Samples at the nodes of Gaussian quadrature (GQ) with the weight function x̄ + ȳ
    + z̄.

    With n nodes the rule is exact for polynomials of degree 2n − 1 under that weight
    function. Each colour-matching function has its own weights at the same nodes, exact
    for degree n − 1.
    """
    rule = gauss_rule(wavelengths(), xyz_weights().sum(axis=1), count)
    weights = [
        interpolatory_rule(rule.nodes, wavelengths(), masses).weights
        for masses in xyz_weights().T
    ]
    return linear(
        f"GQ{count}",
        "Gaussian quadrature",
        interpolation_matrix(rule.nodes),
        np.stack(weights, axis=1),
    )
