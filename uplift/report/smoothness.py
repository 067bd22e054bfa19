"""How fast spectra change from one lattice point to the next."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.models import reflectance

NO_PAIR = -1.0
"""In place of a difference, where a neighbour is absent."""


@dataclass(frozen=True, eq=False)
class Smoothness:
    """rms over wavelength between the spectra of neighbours along an axis.

    Parameters
    ----------
    differences : (k,) of every pair of neighbours, in units of reflectance.
    steepest : (2, 3) linear RGB of the two lattice points that differ most.
    """

    differences: NDArray[np.float32]
    steepest: Array


def smoothness(data: CubeData) -> Smoothness:
    """Every pair once. Works plane by plane of equal red: two planes of spectra are in memory at a time."""
    parts: list[NDArray[np.float32]] = []
    largest = NO_PAIR
    pair: tuple[tuple[int, ...], ...] = ()
    before: Array | None = None
    for red in range(data.lattice.dim):
        plane = _plane(data, red)
        for axis, (first, second) in enumerate(_neighbours(before, plane)):
            apart = np.nan_to_num(np.sqrt(((second - first) ** 2).mean(axis=-1)), nan=NO_PAIR)
            parts.append(apart[apart != NO_PAIR].astype(np.float32))
            if apart.max() > largest:
                largest = float(apart.max())
                pair = _pair(axis, red, np.unravel_index(int(apart.argmax()), apart.shape))
        before = plane
    return Smoothness(np.concatenate(parts), data.lattice.nodes[np.array(pair)])


def _plane(data: CubeData, red: int) -> Array:
    """(dim, dim, N) spectra of the lattice points of one red, green first; NaN where absent."""
    dim, at = data.lattice.dim, data.sensor.wavelengths
    rows = slice(red * dim**2, (red + 1) * dim**2)
    there = data.points.present[rows]
    plane = np.full((dim**2, len(at)), np.nan)
    plane[there] = reflectance(data.model, data.points.coefficients[rows][there], at)
    return plane.reshape(dim, dim, -1)


def _neighbours(before: Array | None, plane: Array) -> list[tuple[Array, Array]]:
    """Pairs along blue and green within a plane, and along red to the plane before."""
    within = [(plane[:, :-1], plane[:, 1:]), (plane[:-1], plane[1:])]
    return within if before is None else [*within, (before, plane)]


def _pair(axis: int, red: int, place: tuple[np.intp, ...]) -> tuple[tuple[int, ...], ...]:
    """Positions (red, green, blue) of two neighbours; ``axis`` 0 is blue, 1 green, 2 red."""
    green, blue = (int(index) for index in place)
    first = [red, green, blue]
    second = list(first)
    if axis == 2:
        first[0] -= 1
    else:
        second[2 - axis] += 1
    return tuple(first), tuple(second)
