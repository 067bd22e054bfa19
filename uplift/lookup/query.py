"""Queries in full detail: spectrum, provenance and round trip of every colour."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.sensor import Light
from uplift.colorimetry.solid import solid
from uplift.common.arrays import Array, Indices, Mask
from uplift.cube import CubeData
from uplift.lattice import Status
from uplift.lookup.blocks import BLOCK
from uplift.lookup.cube import Cube
from uplift.lookup.outside import MAPPING, reflectance_outside, xyz_to_rgb

CODE_TOLERANCE = 0.5
"""A colour is that of an entry if their 8-bit codes differ by at most this."""


@dataclass(frozen=True, eq=False, repr=False)
class QueryResult:
    """The answer to one colour.

    Parameters
    ----------
    rgb : ndarray, shape (3,)
        Linear RGB in [0, 1].
    requested_rgb : ndarray, shape (3,)
        Linear RGB before gamut mapping.
    wavelengths : ndarray, shape (N,)
        Wavelengths in nm.
    reflectance : ndarray, shape (N,)
        Reflectances in [0, 1].
    round_trip : ndarray, shape (3,)
        Linear RGB of the reflectance.
    xyz : ndarray, shape (3,)
        XYZ of the reflectance under the illuminant of the cube, where white has Y = 1.
    delta_e_2000 : float
        ΔE00 between ``rgb`` and ``round_trip``; for raw values of a camera, by an approximate matrix.
    cell : tuple of int
        Position of the lowest corner of the cell along the axes.
    statuses : tuple of Status
        Statuses of the corners of the cell.
    entry : str, optional
        Atlas entry of the same colour.
    standard_error, error_bound : float, optional
        ΔE00 from the answer that 68 % and 95 % of measurements stay within; None if the cube has no estimate.
    standard_errors, error_bounds : mapping of str to float
        The same under other lights, by their names; empty if the cube has no estimate.
    light_xyz : mapping of str to ndarray, shape (3,)
        XYZ of the reflectance under these lights; the perfect reflector has that of `Light.white`.
    unlike_atlas : bool
        Whether no atlas entry has a colour near this one; see `Cube.unlike_atlas`. False without standard errors.
    realisable : bool
        Whether a reflectance with the colour exists. If not, the answer has less chroma.
    """

    rgb: Array
    requested_rgb: Array
    wavelengths: Array
    reflectance: Array
    round_trip: Array
    xyz: Array
    delta_e_2000: float
    cell: tuple[int, int, int]
    statuses: tuple[Status, ...]
    entry: str | None
    standard_error: float | None
    error_bound: float | None
    standard_errors: Mapping[str, float]
    error_bounds: Mapping[str, float]
    light_xyz: Mapping[str, Array]
    unlike_atlas: bool
    realisable: bool

    def __repr__(self) -> str:
        values = ", ".join(f"{value:.4g}" for value in self.rgb)
        return f"QueryResult(rgb ({values}), {len(self.wavelengths)} wavelengths, ΔE00 {self.delta_e_2000:.2g})"


def query(
    cube: Cube,
    rgb: Array,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    requested_rgb: Array | None = None,
    lights: Sequence[Light] = (),
) -> Iterator[QueryResult]:
    """Answer colours in full detail, block by block.

    Parameters
    ----------
    cube : Cube
        The cube.
    rgb : ndarray, shape (n, 3)
        Linear RGB in [0, 1].
    wavelengths : array_like, shape (N,), optional
        Wavelengths in nm, by default those of the sensor.
    mode : str, default "spectra"
        One of `MODES`, see `Cube.reflectance`.
    requested_rgb : ndarray, shape (n, 3), optional
        The colours before gamut mapping, ``rgb`` by default.
    lights : sequence of Light, optional
        Lights of `QueryResult.standard_errors` and `QueryResult.light_xyz`.

    Yields
    ------
    QueryResult
        The answers in order.

    Raises
    ------
    ColourError
        A colour that the cube cannot answer.
    OptionError
        An unknown mode, invalid wavelengths, or lights for a cube without left-out entries.
    """
    at = cube.resolve_wavelengths(wavelengths)
    requested = rgb if requested_rgb is None else requested_rgb
    for start in range(0, len(rgb), BLOCK):
        block = slice(start, start + BLOCK)
        yield from _block(cube, rgb[block], requested[block], at, mode, lights)


def query_xyz(
    cube: Cube,
    xyz: ArrayLike,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    lights: Sequence[Light] = (),
) -> Iterator[QueryResult]:
    """Answer colours by XYZ, also those outside the RGB space of the cube.

    The cube answers colours in its RGB space. The spectra of others are computed from the nearest one that it holds
    (`uplift.lookup.outside`); they have no atlas entry and no standard error.

    Parameters
    ----------
    cube : Cube
        The cube.
    xyz : array_like, shape (n, 3)
        XYZ under the illuminant of the cube, where white has Y = 1.
    wavelengths : array_like, shape (N,), optional
        Wavelengths in nm, by default those of the sensor.
    mode : str, default "spectra"
        One of `MODES`, for colours in the RGB space of the cube.
    lights : sequence of Light
        Illuminants of standard errors.

    Yields
    ------
    QueryResult
        The answers in order; the RGB of some lie outside [0, 1].

    Raises
    ------
    ColourError
        No reflectance has a colour (``colour-unrealisable``), or the model does not reach it
        (``colour-not-reached``).
    """
    sensor = cube.data.sensor
    rgb = xyz_to_rgb(cube.data, xyz)
    at = cube.resolve_wavelengths(wavelengths)
    mapped = map_to_gamut(rgb, sensor, MAPPING)
    for row, result in enumerate(query(cube, mapped.rgb, at, mode, lights=lights)):
        yield _outside(cube, result, rgb[row], at, lights) if mapped.outside[row] else result


def _outside(cube: Cube, nearest: QueryResult, rgb: Array, at: Array, lights: Sequence[Light]) -> QueryResult:
    """Replace the answer to the nearest colour in the RGB space by that to linear RGB (3,) outside [0, 1]."""
    sensor = cube.data.sensor
    spectrum = reflectance_outside(cube.data, rgb[None], np.concatenate([sensor.wavelengths, at]))[0]
    round_trip = sensor.rgb(spectrum[: len(sensor.wavelengths)])
    return replace(
        nearest,
        rgb=rgb,
        requested_rgb=rgb,
        reflectance=spectrum[len(sensor.wavelengths) :],
        round_trip=round_trip,
        xyz=sensor.light.xyz @ spectrum[: len(sensor.wavelengths)],
        delta_e_2000=float(delta_e_rgb(sensor, rgb, round_trip)),
        entry=None,
        standard_error=None,
        error_bound=None,
        standard_errors={},
        error_bounds={},
        light_xyz={light.name: light.xyz @ spectrum[: len(sensor.wavelengths)] for light in lights},
        unlike_atlas=False,
        realisable=True,
    )


def _block(
    cube: Cube, rgb: Array, requested: Array, at: Array, mode: str, lights: Sequence[Light]
) -> Iterator[QueryResult]:
    data, sensor = cube.data, cube.data.sensor
    count = len(sensor.wavelengths)
    spectra = cube.reflectance(rgb, np.concatenate([sensor.wavelengths, at]), mode)
    round_trip = sensor.rgb(spectra[:, :count])
    xyz = spectra[:, :count] @ sensor.light.xyz.T
    delta_e = delta_e_rgb(sensor, rgb, round_trip)
    relit = {light.name: spectra[:, :count] @ light.xyz.T for light in lights}
    errors, bounds = cube.standard_error(rgb), cube.error_bound(rgb)
    named = {} if errors is None else {light.name: light for light in lights}
    errors_by_light = {name: cube.standard_error(rgb, light) for name, light in named.items()}
    bounds_by_light = {name: cube.error_bound(rgb, light) for name, light in named.items()}
    unlike = None if errors is None else cube.unlike_atlas(rgb)
    low, fraction = data.lattice.cell(rgb)
    corners, _ = data.lattice.cell_corners(low, fraction)
    realisable = _realisable(data, rgb, corners)
    for row, cell in enumerate(low):
        yield QueryResult(
            rgb=rgb[row],
            requested_rgb=requested[row],
            wavelengths=at,
            reflectance=spectra[row, count:],
            round_trip=round_trip[row],
            xyz=xyz[row],
            delta_e_2000=float(delta_e[row]),
            cell=(int(cell[0]), int(cell[1]), int(cell[2])),
            statuses=tuple(map(Status, sorted(set(data.points.status[corners[row]].tolist())))),
            entry=_entry(cube, rgb[row]),
            standard_error=None if errors is None else float(errors[row]),
            error_bound=None if bounds is None else float(bounds[row]),
            standard_errors=_of_row(errors_by_light, row),
            error_bounds=_of_row(bounds_by_light, row),
            light_xyz={name: each[row] for name, each in relit.items()},
            unlike_atlas=unlike is not None and bool(unlike[row]),
            realisable=bool(realisable[row]),
        )


def _of_row(by_light: Mapping[str, Array | None], row: int) -> dict[str, float]:
    return {name: float(each[row]) for name, each in by_light.items() if each is not None}


def _realisable(data: CubeData, rgb: Array, corners: Indices) -> Mask:
    """Whether linear RGB (n, 3) in cells with ``corners`` (n, 8) are realisable.

    Mixtures of realisable colours are realisable, so only cells with an unrealisable corner are tested.
    """
    realisable = ~(data.points.status[corners] == Status.UNREALISABLE).any(axis=1)
    if not realisable.all():
        realisable[~realisable] = solid(data.sensor.matrix).contains(rgb[~realisable])
    return np.asarray(realisable)


def _entry(cube: Cube, rgb: Array) -> str | None:
    atlas = cube.data.atlas
    if not atlas.names:
        return None
    difference = np.abs(cube.encode(atlas.rgb) - cube.encode(rgb)).max(axis=1)
    nearest = int(difference.argmin())
    return atlas.names[nearest] if difference[nearest] <= CODE_TOLERANCE else None
