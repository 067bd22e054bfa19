"""Factor model (section 2): m coefficients per spectrum, whose products are those of
products of spectra.
"""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, as_array
from uplift.common.errors import OptionError
from uplift.extras.colour.light_sets import PALETTE_LIGHTS
from uplift.extras.papers.palette.colours import illuminant, lab_per_rgb, screen_matrix
from uplift.extras.papers.palette.sharpen import make_light_paths, sharpen
from uplift.lookup.cube import load

COUNTS = range(3, 13)  # supported numbers of coefficients; Bergner uses 5 to 7
# least weight of a wavelength, so that those of low sensitivity are fitted too
MIN_WEIGHT = 0.002
# Linear R, G and B of the colours whose spectra stand for all materials; denser among
# dark colours.
NODES = np.linspace(0.02, 0.98, 5) ** 2


@dataclass(frozen=True, eq=False)
class FactorModel:
    """Sharpened basis of spectra with its maps from spectra and to colours.

    Light reflected several times has the product of the `light` coefficients of the
    source and of the `reflectance` coefficients of the surfaces; `rgb` gives its
    colour. The light may be the last factor: it then changes at the cost of m products
    and a 3 × m matrix per pixel.
    """

    wavelengths: Array  # (N,) in nm
    basis: Array  # (N, m)
    # (m, m) from coefficients of the principal basis to those of the sharpened one
    transform: Array
    # (m, N) from spectra to coefficients, which are 1 for the flat spectrum
    projection: Array
    # (m, N) from powers to the coefficients that tint reflectances as the power does
    light_projection: Array
    matrix: Array  # (3, m) from coefficients to linear RGB (eq. 17)

    @property
    def count(self) -> int:
        """Number of coefficients m."""
        return self.basis.shape[1]

    def reflectance(self, spectra: ArrayLike) -> Array:
        """Convert reflectances (..., N) to coefficients (..., m) (eq. 3)."""
        return as_array(spectra) @ self.projection.T

    def light(self, power: ArrayLike) -> Array:
        """Convert powers (..., N) to coefficients (..., m). The map is linear: lights
        mix as their coefficients do.
        """
        return as_array(power) @ self.light_projection.T

    def product(self, *coefficients: ArrayLike) -> Array:
        """Multiply spectra by their coefficients (..., m) (eq. 15)."""
        product = np.asarray(1.0)
        for factor in coefficients:
            product = product * as_array(factor)
        return product

    def rgb(self, coefficients: ArrayLike) -> Array:
        """Return the linear RGB (..., 3) of coefficients (..., m), not clipped."""
        return as_array(coefficients) @ self.matrix.T

    def spectra(self, coefficients: ArrayLike) -> Array:
        """Reconstruct spectra (..., N) from coefficients (..., m) (eq. 2)."""
        return as_array(coefficients) @ self.basis.T


def standard_model(sensor: Sensor, count: int = 7) -> FactorModel:
    """Fit the standard factor model.

    Parameters
    ----------
    sensor : Sensor
        Wavelengths, observer and RGB space.
    count : int
        Number of coefficients, from 3 to 12.

    Returns
    -------
    FactorModel
        The model, the same on every machine up to rounding.

    Raises
    ------
    OptionError
        If ``count`` is not supported.
    """
    materials = np.array(list(itertools.product(NODES, repeat=3)))
    reflectances = load().reflectance(materials, sensor.wavelengths)
    lights = np.array([illuminant(sensor, name) for name in PALETTE_LIGHTS])
    return factor_model(sensor, reflectances, lights, count)


def factor_model(
    sensor: Sensor, reflectances: Array, lights: Array, count: int = 7
) -> FactorModel:
    """Fit a factor model of ``count`` coefficients to materials (E, N) and lights (L,
    N).

    Smooth lights give the better model for spiky ones too. A spike would take a basis
    function away from the other spectra, whereas `FactorModel.light` finds coefficients
    that tint surfaces as the spike does.
    """
    if count not in COUNTS:
        raise OptionError(f"count must be in [{COUNTS[0]}, {COUNTS[-1]}], got {count}")
    paths = make_light_paths(reflectances, lights)
    principal, projection = _principal_basis(sensor, paths.prod(axis=0), count)
    transform = sharpen(sensor, principal, projection, paths)
    basis = principal @ np.linalg.inv(transform)
    projection = transform @ projection
    matrix = screen_matrix(sensor) @ basis
    single = make_light_paths(reflectances, np.ones((1, len(sensor.wavelengths))))
    tint = _light_projection(sensor, single.prod(axis=0), projection, matrix)
    return FactorModel(sensor.wavelengths, basis, transform, projection, tint, matrix)


def linear_product(model: FactorModel, first: ArrayLike, *others: ArrayLike) -> Array:
    """Multiply spectra of the span of the basis, given by coefficients (..., m),
    without sharpening (eq. 5–7).

    Every factor is an m × m matrix Λ: products are exact, projected into the span.
    """
    # Products of basis functions, B⁺_i (B_j * B_k).
    basis = model.basis
    tensor = np.einsum("in,nj,nk->ijk", model.projection, basis, basis, optimize=True)
    product = as_array(first)
    for factor in others:
        matrix = np.einsum("ijk,...k->...ij", tensor, as_array(factor))
        product = np.einsum("...ij,...j->...i", matrix, product)
    return product


def _principal_basis(sensor: Sensor, signals: Array, count: int) -> tuple[Array, Array]:
    """Return the principal basis (N, m) of signals (n, N) weighted by the sensitivity,
    and its inverse (m, N).

    Signals are scaled half-way to equal luminance: dark ones matter less, but are not
    negligible.
    """
    weights = np.sqrt(sensor.cmfs.sum(axis=1) + MIN_WEIGHT)
    luminances = signals @ sensor.cmfs[:, 1] / sensor.cmfs[:, 1].sum()
    signals = signals / np.sqrt(np.maximum(luminances, MIN_WEIGHT))[:, None]
    axes = np.linalg.svd(signals * weights, full_matrices=False)[2][:count]
    return (axes / weights).T, axes * weights


def _light_projection(
    sensor: Sensor, surfaces: Array, projection: Array, matrix: Array
) -> Array:
    """Return least squares (m, N) over surfaces (n, N): matrix · (e * s) against the
    colour of the full product.
    """
    weights = lab_per_rgb(sensor, surfaces @ screen_matrix(sensor).T)
    factor = np.einsum("nij,jm,nm->nim", weights, matrix, surfaces @ projection.T)
    full = np.einsum("nij,jl,nl->nil", weights, screen_matrix(sensor), surfaces)
    rows = (3 * len(surfaces), -1)
    return np.linalg.lstsq(factor.reshape(rows), full.reshape(rows), rcond=None)[0]
