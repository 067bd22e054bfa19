"""Differences between the spectra of neighbouring lattice points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.models import reflectance

NO_PAIR = -1.0
"""Placeholder for a difference to an absent point."""


@dataclass(frozen=True, eq=False)
class Smoothness:
    """rms differences over wavelength between the spectra of neighbours along an axis."""

    differences: NDArray[np.float32]  # (k,) Difference of every pair of neighbours, in units of reflectance
    steepest: Array  # (2, 3) Linear RGB of the pair that differs most


def compute_smoothness(data: CubeData) -> Smoothness:
    """Compare the spectra of all neighbours, each pair once.

    The lattice is processed by planes of equal red: spectra of two planes are in memory at a time.
    """
    parts: list[NDArray[np.float32]] = []
    largest = NO_PAIR
    pair: tuple[tuple[int, ...], ...] = ()
    previous: Array | None = None
    for red in range(data.lattice.dim):
        plane = _plane(data, red)
        for axis, (first, second) in enumerate(_neighbours(previous, plane)):
            rms = np.nan_to_num(np.sqrt(((second - first) ** 2).mean(axis=-1)), nan=NO_PAIR)
            parts.append(rms[rms != NO_PAIR].astype(np.float32))
            if rms.max() > largest:
                largest = float(rms.max())
                pair = _positions(axis, red, np.unravel_index(int(rms.argmax()), rms.shape))
        previous = plane
    return Smoothness(np.concatenate(parts), data.lattice.nodes[np.array(pair)])


def _plane(data: CubeData, red: int) -> Array:
    """Spectra (dim, dim, N) of the points of one red, green first; NaN if absent."""
    dim, wavelengths = data.lattice.dim, data.sensor.wavelengths
    rows = slice(red * dim**2, (red + 1) * dim**2)
    present = data.points.present[rows]
    plane = np.full((dim**2, len(wavelengths)), np.nan)
    plane[present] = reflectance(data.model, data.points.coefficients[rows][present], wavelengths)
    return plane.reshape(dim, dim, -1)


def _neighbours(previous: Array | None, plane: Array) -> list[tuple[Array, Array]]:
    """Pairs along blue and green within a plane, and along red to the previous plane."""
    within = [(plane[:, :-1], plane[:, 1:]), (plane[:-1], plane[1:])]
    return within if previous is None else [*within, (previous, plane)]


def _positions(axis: int, red: int, index: tuple[np.intp, ...]) -> tuple[tuple[int, ...], ...]:
    """Positions (red, green, blue) of two neighbours; ``axis`` 0 is blue, 1 green, 2 red."""
    green, blue = (int(part) for part in index)
    first = [red, green, blue]
    second = list(first)
    if axis == 2:
        first[0] -= 1
    else:
        second[2 - axis] += 1
    return tuple(first), tuple(second)
