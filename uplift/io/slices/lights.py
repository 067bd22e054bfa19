"""An emission table as OpenEXR: its answers over the chromaticity diagram."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.observer import sensor
from uplift.io.slices import exr
from uplift.io.slices.slices import check_slices
from uplift.lights.chromaticity_map import ALL, map_chromaticities
from uplift.lights.lookup import EmissionTable
from uplift.lights.table import emission_digest

STEP = 0.002
"""Size of a pixel in u′v′."""
SAMPLED = np.arange(400.0, 701.0, 20.0)
"""Wavelengths in nm of the channels of power."""
COMMENTS = (
    "The answers of an emission table at luminance 1 over the CIE 1976 chromaticity diagram: u′ increases to the "
    "right, v′ upwards. A: 1 for chromaticities of lights; elsewhere lamp is -1 and all other channels are 0. R, G, B: "
    "linear RGB. expectedError: ΔE00 of surfaces, to a measured lamp of the same chromaticity. lamp: number of the "
    "exact lamp in whose disc the pixel is, -1 for none; uplift.lamps has their names. power: spectral power, where "
    "the equal-energy light of luminance 1 has 1."
)
"""The ``comments`` attribute."""


def write_light_slices(table: EmissionTable, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write the answers of an emission table over the chromaticity diagram as one OpenEXR image.

    The channels are 32-bit floats: ``R``, ``G``, ``B``, ``A``, ``expectedError``, ``lamp`` and ``power.400nm`` to
    ``power.700nm``. Attributes have the u′v′ of the lower left corner and of a pixel's size.

    Parameters
    ----------
    table : EmissionTable
        The table.
    path : path-like
        File to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        The path does not end in ``.exr`` (code ``unknown-suffix``), cannot be written, or exists and ``force`` is
        false.
    """
    check_slices(path, force=force)
    part = exr.make_part("chromaticities", {**light_attributes(table), "comments": COMMENTS}, _channels(table))
    exr.write_parts([part], path, force=force)


def light_attributes(table: EmissionTable) -> dict[str, Any]:
    """Return header attributes that identify an emission table.

    Parameters
    ----------
    table : EmissionTable
        The table.

    Returns
    -------
    dict
        Attributes of OpenEXR by name; ``uplift.cube`` is the digest of the table's content.
    """
    return {
        "chromaticities": exr.chromaticities(sensor(table.space)),
        "uplift.cube": emission_digest(table.data),
        "uplift.space": table.space,
        "uplift.observer": table.observer,
        "uplift.lamps": "; ".join(table.lamp_names),
        "uplift.u": ALL.u[0],
        "uplift.v": ALL.v[0],
        "uplift.step": STEP,
    }


def _channels(table: EmissionTable) -> dict[str, NDArray[Any]]:
    """Channels (height, width) by name."""
    found = map_chromaticities(table, ALL, STEP)
    power = np.zeros((*found.inside.shape, len(SAMPLED)))
    power[found.inside] = table.spectrum_of_xyz(found.xyz[found.inside], SAMPLED)
    return {
        **{letter: found.rgb[..., i] * found.inside for i, letter in enumerate("RGB")},
        "A": found.inside,
        "expectedError": found.error * found.inside,
        "lamp": found.lamp,
        **{f"power.{wavelength:g}nm": power[..., i] for i, wavelength in enumerate(SAMPLED)},
    }
