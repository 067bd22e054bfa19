"""Libraries: measured spectra that shape the prior but do not constrain the cube (docs/prior.md)."""

from __future__ import annotations

import functools
from collections.abc import Collection
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

from uplift.common.arrays import Array
from uplift.common.errors import unknown_name

FILE = "library.npz"
"""Package data, written by tools/ship_library.py."""
SAME_RMS = 1e-3
"""rms difference within which spectra are the same measurement."""
STEPS = 10_000
"""Steps of reflectance from 0 to 1 in the file."""


@dataclass(frozen=True, eq=False)
class Family:
    """Spectra measured together, which deviate from smooth spectra in a common way.

    Parameters
    ----------
    name : str
        Name of the family.
    measured : ndarray, shape (E, N)
        Reflectances at the wavelengths of the sensor.
    spread : float
        Variance of the family's own deviation, relative to that of the deviation which all materials share.
    related : float, default 0
        Share, 0 to 1, of the family's own deviation that the materials of a cube are expected to have as well: 0 for
        a family like any other, 1 for the family that they belong to.
    """

    name: str
    measured: Array
    spread: float
    related: float = 0.0


@functools.cache
def _shipped() -> tuple[Family, ...]:
    with (files(__package__) / FILE).open("rb") as file, np.load(file, allow_pickle=False) as table:
        measured = np.cumsum(table["steps"], axis=1, dtype=np.int64) / STEPS
        rows = np.split(measured, np.cumsum(table["counts"])[:-1])
        named = zip(table["names"].tolist(), rows, table["spreads"].tolist(), strict=True)
        return tuple(Family(*row) for row in named)


def shipped_library(leave_out: Collection[str] = ()) -> tuple[Family, ...]:
    """Return the library that comes with the package.

    Parameters
    ----------
    leave_out : collection of str, optional
        Names of families to leave out, for tests on them.

    Returns
    -------
    tuple of Family
        Families, on the wavelengths of every sensor.

    Raises
    ------
    UnknownNameError
        A name in ``leave_out`` is unknown.

    Examples
    --------
    >>> [family.name for family in shipped_library(leave_out=["pmc", "tcs", "vs"])]
    ['checker', 'cie2017', 'rawtoaces', 'otsu2018']
    """
    families = _shipped()
    names = [family.name for family in families]
    for name in leave_out:
        if name not in names:
            raise unknown_name(name, names, "library family")
    return tuple(family for family in families if family.name not in leave_out)


def families_with(measured: Array) -> tuple[str, ...]:
    """Find the families of the shipped library that contain given spectra, to leave them out of tests on these spectra.

    Parameters
    ----------
    measured : ndarray, shape (n, 81)
        Reflectances at the wavelengths of the sensors.

    Returns
    -------
    tuple of str
        Names of the families with a spectrum that differs from one of ``measured`` by an rms of at most `SAME_RMS`.
    """
    from scipy.spatial import cKDTree

    if not len(measured):
        return ()
    tree, limit = cKDTree(measured), SAME_RMS * np.sqrt(measured.shape[1])
    nearest = {family.name: tree.query(family.measured)[0].min() for family in shipped_library()}
    return tuple(name for name, distance in nearest.items() if distance <= limit)
