"""The judge of round trips: the observer and the illuminant at 1 nm, and the white and the matrix that a method states.

No method of the chart was fitted to these functions. Cubes of this package are fitted to 380–780 nm at 5 nm, where
other methods would be judged by our choice of range, step and matrix.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.lights import DEFAULT_ILLUMINANT
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science

RANGE = (360.0, 830.0, 1.0)
"""First and last wavelength and step in nm: the tables of the CIE."""


def at_1_nm(sensor: Sensor) -> Sensor:
    """Return a sensor on `RANGE`, where the perfect reflector is white again: the statement of a cube.

    Parameters
    ----------
    sensor : Sensor
        The sensor of a cube.

    Returns
    -------
    Sensor
        The same space, illuminant and observer.
    """
    return observer.on_range(sensor, *RANGE)


def stated_sensor(xyz_to_rgb: Array, illuminant: str = DEFAULT_ILLUMINANT) -> Sensor:
    """Return the sensor on `RANGE` of a stated matrix.

    Parameters
    ----------
    xyz_to_rgb : ndarray, shape (3, 3)
        From XYZ, where white has Y = 1, to linear RGB, as published.
    illuminant : str
        The stated white.

    Returns
    -------
    Sensor
        CIE 1931 observer; the perfect reflector is (1, 1, 1) to the digits of the matrix.
    """
    return replace(at_1_nm(observer.sensor(illuminant=illuminant)), xyz_to_rgb=xyz_to_rgb)


@cache
def ours() -> Sensor:
    """Return the statement of cubes for linear sRGB under D65."""
    return at_1_nm(observer.sensor())


@cache
def published_srgb() -> Sensor:
    """Return the statement of methods for sRGB: the matrix of IEC 61966-2-1, D65."""
    return stated_sensor(colour_science().RGB_COLOURSPACES["sRGB"].matrix_XYZ_to_RGB)


def round_trip(sensor: Sensor, rgb: Array, spectra: Array) -> Array:
    """Compare colours with those of their spectra.

    Parameters
    ----------
    sensor : Sensor
        The judge.
    rgb : ndarray, shape (n, 3)
        Linear RGB.
    spectra : ndarray, shape (n, N)
        Reflectances at the wavelengths of the judge.

    Returns
    -------
    ndarray, shape (n,)
        ΔE00 under the judge's illuminant.
    """
    return delta_e_rgb(sensor, rgb, sensor.rgb(spectra))
