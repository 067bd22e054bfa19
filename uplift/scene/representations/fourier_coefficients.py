"""Fourier coefficients of a spectrum: the smooth part of Sun's composite model.

Kment 2011, sections 4.3 and 5.4. The period is 380–780 nm, so a spectrum whose ends differ has a jump there. The
``count`` real numbers are a_0 to a_m and b_1 to b_m. Choices that the text leaves open: the coefficients are those of
eq. 4.7 over the 5 nm table, with the mean of both ends where they meet. A product, computed point by point as in the
text, keeps as many coefficients as its factors have.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.observer import END, START
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.scene.representations.dense import TABLE_STRIDE, wavelengths, xyz_weights
from uplift.scene.representations.samples import row_sizes


@dataclass(frozen=True, eq=False)
class FourierCoefficients:
    """Coefficients (n, C) of a real Fourier basis.

    The product of two such spectra has twice the highest frequency. At 2C points in the period none of it is aliased
    to a lower one (the "Shannon theorem" of the text).

    Parameters
    ----------
    count : int
        Number of coefficients C.
    waves : ndarray, shape (C, 401)
        Basis functions at the dense wavelengths.
    product_waves : ndarray, shape (C, 2C)
        Basis functions at the points of a product.
    """

    count: int
    waves: Array
    product_waves: Array
    family = "Fourier coefficients"

    @property
    def name(self) -> str:
        return f"F{self.count}"

    def encode_light(self, power: Array) -> Array:
        periodic = power[:, :-1:TABLE_STRIDE].copy()
        periodic[:, 0] = (power[:, 0] + power[:, -1]) / 2
        return _analyse(periodic, self.waves[:, :-1:TABLE_STRIDE])

    def encode_surface(self, reflectance: Array) -> Array:
        return self.encode_light(reflectance)

    def multiply(self, light: Array, surface: Array) -> Array:
        return _analyse((light @ self.product_waves) * (surface @ self.product_waves), self.product_waves)

    def xyz(self, light: Array) -> Array:
        return light @ (self.waves @ xyz_weights())

    def storage(self, code: Array) -> Array:
        return row_sizes(code)


def fourier_coefficients(count: int) -> FourierCoefficients:
    """Make the representation by ``count`` real coefficients, an odd number. Raises `OptionError`."""
    if count < 1 or count % 2 == 0:
        raise OptionError(
            f"number of Fourier coefficients must be odd and positive, got {count}",
            code="even-coefficients",
            hint="a mean and pairs of cosine and sine are an odd number",
        )
    dense = 2 * np.pi * (wavelengths() - START) / (END - START)
    product = np.pi * np.arange(2 * count) / count
    return FourierCoefficients(count, _waves(dense, count), _waves(product, count))


def _waves(phase: Array, count: int) -> Array:
    """Basis (count, K) of 1, cos φ, sin φ, cos 2φ, sin 2φ, … at phases (K,)."""
    orders = np.arange(1, count // 2 + 1)[:, None]
    pairs = np.stack([np.cos(orders * phase), np.sin(orders * phase)], axis=1)
    return np.concatenate([np.ones((1, len(phase))), pairs.reshape(-1, len(phase))])


def _analyse(values: Array, waves: Array) -> Array:
    """Coefficients (n, C) of values (n, K) at K evenly spaced points of a period, for waves (C, K)."""
    return np.asarray(values @ waves.T / (waves**2).sum(axis=1))
