"""Exact colours in cells with a corner that has not its own colour (docs/mathematics.md, 9). Needs numpy only.

A wide-gamut lattice has corners of colours that no reflectance has, and stores other colours there. Mixtures of such
corners miss the requested colour, although most colours of their cells are realisable.
"""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array, Indices, Values
from uplift.cube import CubeData
from uplift.lookup.nodes import cells
from uplift.lookup.refine import change_to_rgb
from uplift.models.matmul import matmul_rows


def inexact_rows(data: CubeData, rgb: Array) -> Indices:
    """Return the rows of linear RGB (n, 3) in [0, 1] whose nodes do not all have their own colours."""
    if data.inexact_cells is None:
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(data.inexact_cells[cells(data, rgb)])


def with_colours(data: CubeData, spectra: Values, at_sensor: Array, rgb: Array, wavelengths: Array) -> Values:
    """Move mixtures to their colours, or to the nearest realisable ones.

    Parameters
    ----------
    data : CubeData
        The cube.
    spectra : ndarray, shape (n, N)
        Reflectances in [0, 1] at any wavelengths.
    at_sensor : ndarray, shape (n, M)
        The same reflectances at the wavelengths of the sensor.
    rgb : ndarray, shape (n, 3)
        Linear RGB.
    wavelengths : ndarray, shape (N,)
        Wavelengths of ``spectra`` in nm.

    Returns
    -------
    ndarray, shape (n, N)
        Reflectances in [0, 1]; unchanged, bit for bit, where they have their colours.
    """
    model = data.model
    change = change_to_rgb(data, at_sensor, rgb)
    linear = model.unsquash(spectra) + matmul_rows(change, model.basis(wavelengths).T)
    return np.where((change != 0).any(axis=1)[:, None], model.squash(linear), spectra)
