"""The spectral factor model: m coefficients per spectrum, whose products are the coefficients of products.

Bergner, Möller & Drew, *A Spectral Engine for Visualization*, 2004, section 2. Numbers: docs/palette.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.palette.bounces import Bounces, bounces
from uplift.design.palette.colours import lab_per_rgb, screen_matrix
from uplift.design.palette.sharpen import sharpen

COUNTS = range(3, 13)
"""Coefficients that a model may have; Bergner takes 5 to 7."""
DARK = 0.002
"""Weight of wavelengths that the eye hardly sees, so that none is left out."""


@dataclass(frozen=True, eq=False)
class FactorModel:
    """A sharpened basis of spectra, with what leads into it and from it to colours.

    A surface seen by several reflections has the product of their ``reflectance`` coefficients; lit by a light, that
    product times the ``light`` coefficients; on the screen, the ``rgb`` of that. The light may be the last factor:
    then it changes at the cost of m products and a 3 × m matrix a pixel.

    Parameters
    ----------
    wavelengths : (N,) nm.
    basis : (N, m) sharpened basis.
    transform : (m, m) from coefficients of the principal basis to those of the sharpened one.
    projection : (m, N) from spectra to coefficients; the flat spectrum has coefficients of 1.
    light_projection : (m, N) from powers to the coefficients that tint reflectances most nearly as the power does.
    matrix : (3, m) from coefficients to linear RGB (eq. 17).
    """

    wavelengths: Array
    basis: Array
    transform: Array
    projection: Array
    light_projection: Array
    matrix: Array

    @property
    def count(self) -> int:
        """m."""
        return self.basis.shape[1]

    def reflectance(self, spectra: ArrayLike) -> Array:
        """Coefficients (…, m) of reflectances (…, N) (eq. 3)."""
        return np.asarray(spectra, dtype=float) @ self.projection.T

    def light(self, power: ArrayLike) -> Array:
        """Coefficients (…, m) of spectral powers (…, N); linear, so that mixed lights have mixed coefficients."""
        return np.asarray(power, dtype=float) @ self.light_projection.T

    def product(self, *coefficients: ArrayLike) -> Array:
        """Coefficients (…, m) of the product of spectra (eq. 15)."""
        found = np.asarray(1.0)
        for factor in coefficients:
            found = found * np.asarray(factor, dtype=float)
        return found

    def rgb(self, coefficients: ArrayLike) -> Array:
        """Linear RGB (…, 3) as on a screen, not clipped, of coefficients (…, m)."""
        return np.asarray(coefficients, dtype=float) @ self.matrix.T

    def spectra(self, coefficients: ArrayLike) -> Array:
        """The spectra (…, N) that coefficients (…, m) stand for (eq. 2)."""
        return np.asarray(coefficients, dtype=float) @ self.basis.T


def factor_model(sensor: Sensor, reflectances: Array, lights: Array, count: int = 7) -> FactorModel:
    """The factor model of ``count`` coefficients for materials (E, N) and lights (L, N), sampled as the sensor.

    Smooth lights make the better model for spiky ones too: a spike takes a basis function away from everything else,
    while `FactorModel.light` finds the coefficients that tint surfaces as it does. Raises `OptionError`.
    """
    if count not in COUNTS:
        raise OptionError(f"a factor model of {count} coefficients", hint=f"take {COUNTS[0]} to {COUNTS[-1]}")
    ways = bounces(reflectances, lights)
    basis, projection = _principal(sensor, ways, count)
    transform = sharpen(sensor, basis, projection, ways)
    sharp, projection = basis @ np.linalg.inv(transform), transform @ projection
    matrix = screen_matrix(sensor) @ sharp
    surfaces = bounces(reflectances, np.ones((1, len(sensor.wavelengths))))
    tint = _light_projection(sensor, surfaces.signals, projection, matrix)
    return FactorModel(sensor.wavelengths, sharp, transform, projection, tint, matrix)


def _principal(sensor: Sensor, ways: Bounces, count: int) -> tuple[Array, Array]:
    """(N, m) principal basis of the colour signals as the eye weighs them, and (m, N) its pseudo-inverse.

    Signals are taken to equal luminance half way, as dark ones are noise to no eye but seen less.
    """
    weights = np.sqrt(sensor.cmfs.sum(axis=1) + DARK)
    bright = ways.signals @ sensor.cmfs[:, 1] / sensor.cmfs[:, 1].sum()
    signals = ways.signals / np.sqrt(np.maximum(bright, DARK))[:, None]
    axes = np.linalg.svd(signals * weights, full_matrices=False)[2][:count]
    return (axes / weights).T, axes * weights


def _light_projection(sensor: Sensor, surfaces: Array, projection: Array, matrix: Array) -> Array:
    """(m, N) least squares over surfaces (n, N): matrix · (e * s) against the colour of the full product."""
    weights = lab_per_rgb(sensor, surfaces @ screen_matrix(sensor).T)
    factor = np.einsum("nij,jm,nm->nim", weights, matrix, surfaces @ projection.T)
    full = np.einsum("nij,jl,nl->nil", weights, screen_matrix(sensor), surfaces)
    rows = (3 * len(surfaces), -1)
    return np.linalg.lstsq(factor.reshape(rows), full.reshape(rows), rcond=None)[0]
