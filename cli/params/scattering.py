"""Scattering that is assumed of paints given by one colour, by name."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.colorimetry.sensor import Sensor
    from uplift.common.arrays import Array
    from uplift.design.mixing.pigments import Scattering

SCATTERINGS = ("dispersive", "root", "constant")
"""Names of `make_scattering`, the default first."""


def make_scattering(name: str, sensor: Sensor, further: Array | tuple[()] = ()) -> Scattering:
    """Return the scattering of spectra at the wavelengths of a sensor, followed by ``further`` wavelengths in nm."""
    from uplift.design.mixing.pigments import CONSTANT, SQUARE_ROOT, dispersive

    if name == "dispersive":
        return dispersive(sensor, further)
    return SQUARE_ROOT if name == "root" else CONSTANT
