"""What a query says about a colour: its spectrum, where it came from, and how exactly it comes back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array, Indices, Mask
from uplift.cube import CubeData
from uplift.lattice import Status
from uplift.lookup.blocks import BLOCK
from uplift.lookup.cube import Cube

HALF_A_CODE = 0.5
"""A colour sits on an entry if both round to the same 8-bit codes, give or take half of one."""


@dataclass(frozen=True, eq=False)
class QueryResult:
    """One colour: linear RGB (3,), its reflectance (N,) at wavelengths (N,) nm, and its round trip.

    ``asked`` is what ``rgb`` was before it was moved into [0, 1], if it was (`uplift.colorimetry.gamut`);
    ``cell`` is the lowest corner's position along the axes (r, g, b); ``statuses`` are those of the cell's
    corners; ``entry`` is the atlas entry that the colour sits on, if any; ``standard_error`` is by how much, in
    ΔE00 under the cube's reference light, a measurement may be expected to differ, if the cube tells;
    ``realisable`` is whether any reflectance has the colour: if not, the answer has less chroma.
    """

    rgb: Array
    asked: Array
    wavelengths: Array
    reflectance: Array
    round_trip: Array
    delta_e_2000: float
    cell: tuple[int, int, int]
    statuses: tuple[Status, ...]
    entry: str | None
    standard_error: float | None
    realisable: bool


def query(
    cube: Cube,
    rgb: Array,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    asked: Array | None = None,
) -> Iterator[QueryResult]:
    """Answers for linear RGB (n, 3), in order, as they are made. Raises as `Cube.reflectance`.

    ``asked`` (n, 3) is what they were before they were moved into [0, 1], if any were.
    """
    at = cube.wavelengths(wavelengths)
    for start in range(0, len(rgb), BLOCK):
        block = slice(start, start + BLOCK)
        yield from _block(cube, rgb[block], (rgb if asked is None else asked)[block], at, mode)


def _block(cube: Cube, rgb: Array, asked: Array, at: Array, mode: str) -> Iterator[QueryResult]:
    sensor, lattice = cube.data.sensor, cube.data.lattice
    count = len(sensor.wavelengths)
    both = cube.reflectance(rgb, np.concatenate([sensor.wavelengths, at]), mode)
    back = sensor.rgb(both[:, :count])
    apart = delta_e_rgb(sensor, rgb, back)
    errors = cube.standard_error(rgb)
    cells, _ = lattice.cell(rgb)
    corners, _ = lattice.corners(rgb)
    possible = _realisable(cube.data, rgb, corners)
    for row, cell in enumerate(cells):
        yield QueryResult(
            rgb=rgb[row],
            asked=asked[row],
            wavelengths=at,
            reflectance=both[row, count:],
            round_trip=back[row],
            delta_e_2000=float(apart[row]),
            cell=(int(cell[0]), int(cell[1]), int(cell[2])),
            statuses=tuple(
                Status(code) for code in sorted(set(cube.data.points.status[corners[row]].tolist()))
            ),
            entry=_entry(cube, rgb[row]),
            standard_error=None if errors is None else float(errors[row]),
            realisable=bool(possible[row]),
        )


def _realisable(data: CubeData, rgb: Array, corners: Indices) -> Mask:
    """Whether some reflectance has linear RGB (n, 3), of cells with ``corners`` (n, 8).

    What such colours have, their mixtures have too, so that only cells with a corner that is not need a look.
    """
    possible = ~(data.points.status[corners] == Status.UNREALISABLE).any(axis=1)
    if not possible.all():
        possible[~possible] = solid(data.sensor.matrix).contains(rgb[~possible])
    return np.asarray(possible)


def _entry(cube: Cube, rgb: Array) -> str | None:
    atlas = cube.data.atlas
    if not atlas.names:
        return None
    apart = np.abs(cube.encode(atlas.rgb) - cube.encode(rgb)).max(axis=1)
    nearest = int(apart.argmin())
    return atlas.names[nearest] if apart[nearest] <= HALF_A_CODE else None
