"""The first Fourier coefficients of a spectrum: the smooth part of Sun's composite model.

Kment 2011, 4.3 and 5.4: 380–780 nm is the period, so that a spectrum whose ends differ has a jump there. ``count``
real numbers are a_0 to a_m and b_1 to b_m. Where the text leaves a choice open: coefficients are those of eq. 4.7
over the 5 nm table, with the mean of both ends where they meet; a product, made point by point as the text has it,
keeps as many coefficients as went into it.
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
    """Coefficients (n, C) of ``waves`` (C, 401); ``resampled`` (C, K) has them at as many points as a product needs.

    A product of two such spectra has twice the highest frequency. At 2C points in the period none of it is taken
    for a lower one (the "Shannon theorem" of the text).
    """

    count: int
    waves: Array
    resampled: Array

    @property
    def name(self) -> str:
        return f"F{self.count}"

    @property
    def family(self) -> str:
        return "Fourier coefficients"

    def encode_light(self, power: Array) -> Array:
        periodic = power[:, :-1:TABLE_STRIDE].copy()
        periodic[:, 0] = (power[:, 0] + power[:, -1]) / 2
        return _analysed(periodic, self.waves[:, :-1:TABLE_STRIDE])

    def encode_surface(self, reflectance: Array) -> Array:
        return self.encode_light(reflectance)

    def multiply(self, light: Array, surface: Array) -> Array:
        return _analysed((light @ self.resampled) * (surface @ self.resampled), self.resampled)

    def xyz(self, light: Array) -> Array:
        return light @ (self.waves @ xyz_weights())

    def storage(self, code: Array) -> Array:
        return row_sizes(code)


def fourier_coefficients(count: int) -> FourierCoefficients:
    """``count`` real coefficients, an odd number. Raises `OptionError`."""
    if count < 1 or count % 2 == 0:
        raise OptionError(
            f"{count} Fourier coefficients are no mean with pairs of waves", hint="take an odd number"
        )
    phase = 2 * np.pi * (wavelengths() - START) / (END - START)
    return FourierCoefficients(
        count, _waves(phase, count), _waves(2 * np.pi * np.arange(2 * count) / (2 * count), count)
    )


def _waves(phase: Array, count: int) -> Array:
    """(count, K) of 1, cos, sin, cos 2, sin 2, … at phases (K,)."""
    orders = np.arange(1, count // 2 + 1)[:, None]
    pairs = np.stack([np.cos(orders * phase), np.sin(orders * phase)], axis=1)
    return np.concatenate([np.ones((1, len(phase))), pairs.reshape(-1, len(phase))])


def _analysed(values: Array, waves: Array) -> Array:
    """Coefficients (n, C) of values (n, K), evenly spaced over a period, in waves (C, K)."""
    return np.asarray(values @ waves.T / (waves**2).sum(axis=1))
