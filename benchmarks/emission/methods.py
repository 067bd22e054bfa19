"""Lights of given chromaticities by other methods."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.lights import Lamps
from uplift.common.arrays import Array
from uplift.fit.solver import solve
from uplift.lights.fit import nearest_lights
from uplift.lights.lattice import chromaticity
from uplift.models.minimum_norm import forward_map
from uplift.models.sigmoid import Sigmoid

PBRT_SCALE = 2.0
"""Largest component of RGB relative to that of the colour which the sigmoid of pbrt-v4 has."""
TOLERANCE, MAX_PASSES = 1e-7, 200
MIREDS = np.linspace(20, 1000, 981)
"""Reciprocal temperatures in 1/MK among which the nearest Planckian radiator is looked up."""
SECOND_RADIATION_CONSTANT = 1.438776877e-2
"""c₂ in m K."""
NEAREST = 8


@dataclass(frozen=True, eq=False)
class SigmoidLights:
    """Sigmoids times D65: power (n, N), and the largest difference (n,) of linear RGB at a scale of 0.5."""

    power: Array
    missed: Array


def sigmoid_times_d65(power: Array, radiometry: Array, rgb_from_xyz: Array, d65: Array) -> SigmoidLights:
    """Return lights with the RGB of others as pbrt-v4 makes them.

    RGB is divided by twice its largest component; a sigmoid reflectance has that colour under D65.

    Parameters
    ----------
    power : ndarray, shape (n, N)
        Lights whose RGB is known.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    rgb_from_xyz : ndarray, shape (3, 3)
        From XYZ to linear sRGB.
    d65 : ndarray, shape (N,)
        CIE D65.

    References
    ----------
    Pharr, Jakob & Humphreys 2023, "Physically based rendering", 4th edition, section 4.6.6, RGBIlluminantSpectrum.
    Jakob & Hanika 2019, eq. 5.
    """
    sensor = rgb_from_xyz @ (radiometry * (d65 / (d65 @ radiometry[:, 1]))[:, None]).T
    rgb = power @ radiometry @ rgb_from_xyz.T
    target = rgb / (PBRT_SCALE * rgb.max(axis=1, keepdims=True))
    model, wavelengths = Sigmoid(0.0, 1.0), np.linspace(0.0, 1.0, len(radiometry))
    found = solve(
        model,
        forward_map(model, wavelengths, sensor),
        np.zeros((len(target), model.count)),
        target,
        tolerance=TOLERANCE,
        max_passes=MAX_PASSES,
    )
    return SigmoidLights(model.squash(found.multipliers @ model.basis(wavelengths).T) * d65, found.distance)


def planck(power: Array, radiometry: Array, wavelengths: Array) -> Array:
    """Return the Planckian radiators of the correlated colour temperatures, moved to the chromaticities.

    Parameters
    ----------
    power : ndarray, shape (n, N)
        Lights whose chromaticity is known.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    wavelengths : ndarray, shape (N,)
        In nm.

    References
    ----------
    CIE 015:2018, 9.5: the correlated colour temperature, by the distance in CIE 1960 uv.
    """
    metres = wavelengths * 1e-9
    exponent = SECOND_RADIATION_CONSTANT / metres * MIREDS[:, None] * 1e-6
    radiators = metres**-5 / np.expm1(exponent)
    uv = chromaticity(power @ radiometry)
    to_1960 = np.array([1.0, 2 / 3])
    apart = (uv[:, None] - chromaticity(radiators @ radiometry)) * to_1960
    return nearest_lights(radiators[np.linalg.norm(apart, axis=-1).argmin(axis=1)], uv, radiometry)


def nearest(lamps: Lamps, unknown: NDArray[np.bool_], radiometry: Array, count: int) -> Array:
    """Return the mean power (L, N), at luminance 1, of the nearest known lamps.

    Parameters
    ----------
    lamps : Lamps
        L lamps of luminance 1.
    unknown : ndarray of bool, shape (L, L)
        Lamps that the prediction of each lamp must not know.
    radiometry : ndarray, shape (N, 3)
        From power to XYZ.
    count : int
        Number of lamps.
    """
    uv = chromaticity(lamps.power @ radiometry)
    apart = np.where(unknown, np.inf, np.linalg.norm(uv[:, None] - uv, axis=-1))
    return np.asarray(lamps.power[np.argsort(apart, axis=1, kind="stable")[:, :count]].mean(axis=1))
