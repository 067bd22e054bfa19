"""Spectral factor model: m coefficients per spectrum, whose products are the coefficients of products of spectra.

References
----------
S. Bergner, T. Möller, M. S. Drew, *A Spectral Engine for Visualization*, 2004, section 2. Measurements are in
docs/palette.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.design.palette.colours import lab_per_rgb, screen_matrix
from uplift.design.palette.light_paths import LightPaths, make_light_paths
from uplift.design.palette.sharpen import sharpen

COUNTS = range(3, 13)
"""Supported numbers of coefficients; Bergner uses 5 to 7."""
MIN_WEIGHT = 0.002
"""Least weight of a wavelength, so that those of low sensitivity are fitted too."""


@dataclass(frozen=True, eq=False)
class FactorModel:
    """Sharpened basis of spectra with its maps from spectra and to colours.

    Light reflected several times has the product of the `light` coefficients of the source and of the `reflectance`
    coefficients of the surfaces; `rgb` gives its colour. The light may be the last factor: it then changes at the
    cost of m products and a 3 × m matrix per pixel.

    Parameters
    ----------
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm.
    basis : ndarray, shape (N, m)
        Sharpened basis.
    transform : ndarray, shape (m, m)
        From coefficients of the principal basis to those of the sharpened one.
    projection : ndarray, shape (m, N)
        From spectra to coefficients; the flat spectrum has coefficients of 1.
    light_projection : ndarray, shape (m, N)
        From powers to coefficients that tint reflectances as the power does, as nearly as possible.
    matrix : ndarray, shape (3, m)
        From coefficients to linear RGB (eq. 17).
    """

    wavelengths: Array
    basis: Array
    transform: Array
    projection: Array
    light_projection: Array
    matrix: Array

    @property
    def count(self) -> int:
        """Number of coefficients m."""
        return self.basis.shape[1]

    def reflectance(self, spectra: ArrayLike) -> Array:
        """Convert reflectances to coefficients (eq. 3).

        Parameters
        ----------
        spectra : array_like, shape (..., N)
            Reflectances.

        Returns
        -------
        ndarray, shape (..., m)
            Coefficients.
        """
        return np.asarray(spectra, dtype=float) @ self.projection.T

    def light(self, power: ArrayLike) -> Array:
        """Convert powers of lights to coefficients. The map is linear: lights mix as their coefficients do.

        Parameters
        ----------
        power : array_like, shape (..., N)
            Spectral powers.

        Returns
        -------
        ndarray, shape (..., m)
            Coefficients.
        """
        return np.asarray(power, dtype=float) @ self.light_projection.T

    def product(self, *coefficients: ArrayLike) -> Array:
        """Multiply spectra (eq. 15).

        Parameters
        ----------
        *coefficients : array_like, shape (..., m)
            Coefficients of the factors.

        Returns
        -------
        ndarray, shape (..., m)
            Coefficients of the product.
        """
        product = np.asarray(1.0)
        for factor in coefficients:
            product = product * np.asarray(factor, dtype=float)
        return product

    def rgb(self, coefficients: ArrayLike) -> Array:
        """Compute colours on a display.

        Parameters
        ----------
        coefficients : array_like, shape (..., m)
            Coefficients.

        Returns
        -------
        ndarray, shape (..., 3)
            Linear RGB, not clipped.
        """
        return np.asarray(coefficients, dtype=float) @ self.matrix.T

    def spectra(self, coefficients: ArrayLike) -> Array:
        """Reconstruct spectra (eq. 2).

        Parameters
        ----------
        coefficients : array_like, shape (..., m)
            Coefficients.

        Returns
        -------
        ndarray, shape (..., N)
            Spectra of the span of the basis.
        """
        return np.asarray(coefficients, dtype=float) @ self.basis.T


def factor_model(sensor: Sensor, reflectances: Array, lights: Array, count: int = 7) -> FactorModel:
    """Fit a factor model to materials and lights.

    Smooth lights give the better model for spiky ones too. A spike would take a basis function away from the other
    spectra, whereas `FactorModel.light` finds coefficients that tint surfaces as the spike does.

    Parameters
    ----------
    sensor : Sensor
        Wavelengths, observer and RGB space.
    reflectances : ndarray, shape (E, N)
        Materials on the wavelengths of the sensor.
    lights : ndarray, shape (L, N)
        Powers of the lights.
    count : int
        Number of coefficients, from 3 to 12.

    Returns
    -------
    FactorModel
        The model.

    Raises
    ------
    OptionError
        If ``count`` is not supported.
    """
    if count not in COUNTS:
        raise OptionError(f"count must be in [{COUNTS[0]}, {COUNTS[-1]}], got {count}", code="count-out-of-range")
    paths = make_light_paths(reflectances, lights)
    principal, projection = _principal_basis(sensor, paths, count)
    transform = sharpen(sensor, principal, projection, paths)
    basis, projection = principal @ np.linalg.inv(transform), transform @ projection
    matrix = screen_matrix(sensor) @ basis
    single = make_light_paths(reflectances, np.ones((1, len(sensor.wavelengths))))
    tint = _light_projection(sensor, single.signals, projection, matrix)
    return FactorModel(sensor.wavelengths, basis, transform, projection, tint, matrix)


def _principal_basis(sensor: Sensor, paths: LightPaths, count: int) -> tuple[Array, Array]:
    """Principal basis (N, m) of the colour signals weighted by the observer's sensitivity, and its inverse (m, N).

    Signals are scaled half-way to equal luminance: dark ones matter less, but are not negligible.
    """
    weights = np.sqrt(sensor.cmfs.sum(axis=1) + MIN_WEIGHT)
    luminances = paths.signals @ sensor.cmfs[:, 1] / sensor.cmfs[:, 1].sum()
    signals = paths.signals / np.sqrt(np.maximum(luminances, MIN_WEIGHT))[:, None]
    axes = np.linalg.svd(signals * weights, full_matrices=False)[2][:count]
    return (axes / weights).T, axes * weights


def _light_projection(sensor: Sensor, surfaces: Array, projection: Array, matrix: Array) -> Array:
    """Least squares (m, N) over surfaces (n, N): matrix · (e * s) against the colour of the full product."""
    weights = lab_per_rgb(sensor, surfaces @ screen_matrix(sensor).T)
    factor = np.einsum("nij,jm,nm->nim", weights, matrix, surfaces @ projection.T)
    full = np.einsum("nij,jl,nl->nil", weights, screen_matrix(sensor), surfaces)
    rows = (3 * len(surfaces), -1)
    return np.linalg.lstsq(factor.reshape(rows), full.reshape(rows), rcond=None)[0]
