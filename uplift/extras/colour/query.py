"""Queries in full detail: spectrum, provenance and round trip of every colour."""

import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.object_colours import Solid
from uplift.colorimetry.sensor import Light, as_rgb, in_unit_cube
from uplift.common.arrays import Array, Indices, Mask, blocks
from uplift.common.errors import ColourError, unknown_name
from uplift.cube.data import CubeData
from uplift.lattice.lattice import CORNERS
from uplift.lattice.point_table import Status
from uplift.lookup.blocks import BLOCK, as_colours, as_wavelengths
from uplift.lookup.cube import Cube, expected_errors
from uplift.lookup.interpolate import MODES

CODE_TOLERANCE = 0.5
"""A colour is that of an entry if their 8-bit codes differ by at most this."""

NAMED_ROWS = 256
"""Colours that are compared with the entries at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class QueryBlock:
    """The answers to n colours by columns, which `QueryResult` describes."""

    rgb: Array
    requested_rgb: Array
    wavelengths: Array
    reflectance: Array
    round_trip: Array
    xyz: Array
    delta_e_2000: Array
    cell: Indices
    corner_statuses: NDArray[np.uint8]
    """(n, 8)."""
    entry: list[str | None]
    errors: Array
    """(n, 2) standard errors and error bounds, NaN where they are unknown."""
    light_errors: Mapping[str, Array]
    """The same by light."""
    light_xyz: Mapping[str, Array]
    unlike_atlas: Mask
    solid: Solid
    """Solid of the realisable colours."""

    @cached_property
    def realisable(self) -> Mask:
        # The solid is convex: with the corners of RGB it contains everything between.
        if (
            in_unit_cube(self.rgb).all()
            and self.solid.contains(CORNERS.astype(float)).all()
        ):
            return np.ones(len(self), dtype=bool)
        return self.solid.contains(self.rgb)

    @cached_property
    def statuses(self) -> list[tuple[Status, ...]]:
        keys = self.corner_statuses.view("u8")[:, 0].tolist()
        # np.unique without counts imports numpy.ma, which takes time.
        distinct = {
            key: tuple(map(Status, sorted(set(key.to_bytes(8, sys.byteorder)))))
            for key in set(keys)
        }
        return [distinct[key] for key in keys]

    def __len__(self) -> int:
        return len(self.rgb)

    def __iter__(self) -> Iterator["QueryResult"]:
        cells = self.cell.tolist()
        for row, entry in enumerate(self.entry):
            yield QueryResult(
                rgb=self.rgb[row],
                requested_rgb=self.requested_rgb[row],
                wavelengths=self.wavelengths,
                reflectance=self.reflectance[row],
                round_trip=self.round_trip[row],
                xyz=self.xyz[row],
                delta_e_2000=float(self.delta_e_2000[row]),
                cell=tuple(cells[row]),
                statuses=self.statuses[row],
                entry=entry,
                standard_error=_known(self.errors[row, 0]),
                error_bound=_known(self.errors[row, 1]),
                standard_errors=_known_at(self.light_errors, row, 0),
                error_bounds=_known_at(self.light_errors, row, 1),
                light_xyz={name: xyz[row] for name, xyz in self.light_xyz.items()},
                unlike_atlas=bool(self.unlike_atlas[row]),
                realisable=bool(self.realisable[row]),
            )


@dataclass(frozen=True, eq=False, repr=False)
class QueryResult:
    """The answer to one colour."""

    rgb: Array
    """(3,) linear RGB, in [0, 1] unless the query was by XYZ."""
    requested_rgb: Array
    """(3,) linear RGB before gamut mapping."""
    wavelengths: Array
    """(N,) nm."""
    reflectance: Array
    """(N,) in [0, 1]."""
    round_trip: Array
    """(3,) linear RGB of the reflectance."""
    xyz: Array
    """(3,) XYZ of the reflectance under the illuminant of the cube, where white has Y =
    1.
    """
    delta_e_2000: float
    """ΔE00 between ``rgb`` and ``round_trip``; for raw values of a camera, by an
    approximate matrix.
    """
    cell: tuple[int, int, int]
    """Position of the lowest corner of the cell along the axes."""
    statuses: tuple[Status, ...]
    """Statuses of the corners of the cell."""
    entry: str | None
    """Atlas entry whose 8-bit codes are those of the colour, within `CODE_TOLERANCE`.
    """
    standard_error: float | None
    """ΔE00 from the answer that 68 % of measurements stay within; None if the cube has
    no estimate.
    """
    error_bound: float | None
    """The same for 95 %."""
    standard_errors: Mapping[str, float]
    """Standard errors under other lights, by their names; empty if the cube has no
    estimate.
    """
    error_bounds: Mapping[str, float]
    light_xyz: Mapping[str, Array]
    """XYZ (3,) of the reflectance under these lights; the perfect reflector has that of
    `Light.white`.
    """
    unlike_atlas: bool
    """Whether no atlas entry has a colour near this one, not whether the material is of
    another kind; see `Cube.unlike_atlas`. False
    without standard errors.
    """
    realisable: bool
    """Whether a reflectance with the colour exists. If not, the answer has less chroma.
    """


class Answering(Protocol):
    """What answers colours in place of a cube alone."""

    def spectra(self, rgb: Array, wavelengths: Array) -> Array:
        """Reflectance (n, N) at linear RGB (n, 3)."""
        ...

    def errors(self, rgb: Array, light: Light) -> Array:
        """Standard errors and error bounds (n, 2) under a light."""
        ...


def query(
    cube: Cube,
    rgb: Array,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    requested_rgb: Array | None = None,
    lights: Sequence[Light] = (),
    outside: Mask | None = None,
) -> Iterator[QueryResult]:
    """Answer linear RGB (n, 3) in [0, 1] in full detail, as `query_blocks`."""
    for block in query_blocks(
        cube, rgb, wavelengths, mode, requested_rgb, lights, outside
    ):
        yield from block


def query_blocks(
    cube: Cube,
    rgb: Array,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    requested_rgb: Array | None = None,
    lights: Sequence[Light] = (),
    outside: Mask | None = None,
    answering: Answering | None = None,
) -> Iterator[QueryBlock]:
    """Answer linear RGB (n, 3) in [0, 1] in full detail, block by block.

    ``requested_rgb`` are the colours before gamut mapping, ``lights`` those of
    `QueryResult.standard_errors`. Colours that are ``outside`` (n,) are answered as
    requested, not as mapped. ``answering`` takes the place of the cube for the others.
    Raises `UnknownNameError` for an unknown mode.
    """
    if mode not in MODES:
        raise unknown_name(mode, MODES, "mode")
    at = as_wavelengths(wavelengths, cube.data.sensor.wavelengths)
    requested = rgb if requested_rgb is None else requested_rgb
    rgb = as_colours(rgb, cube.data.sensor)
    beyond = np.zeros(len(rgb), dtype=bool) if outside is None else outside
    for start in range(0, len(rgb), BLOCK):
        block = slice(start, start + BLOCK)
        yield _block(
            cube,
            rgb[block],
            requested[block],
            beyond[block],
            at,
            mode,
            lights,
            answering,
        )


def query_xyz(
    cube: Cube,
    xyz: ArrayLike,
    wavelengths: ArrayLike | None = None,
    mode: str = "spectra",
    lights: Sequence[Light] = (),
) -> Iterator[QueryResult]:
    """Answer colours by XYZ (n, 3) under the illuminant of the cube, also those outside
    its RGB space.

    The cube answers colours in its RGB space. The spectra of others are computed from
    the nearest one that it holds, and from an atlas entry outside the space close to
    it; only those of such entries have a standard error. Raises `ColourError`
    (``colour-unrealisable``) if no reflectance has a colour, or the model does not
    reach it.
    """
    rgb, requested, outside = locate_xyz(cube, xyz)
    yield from query(cube, rgb, wavelengths, mode, requested, lights, outside)


def locate_xyz(cube: Cube, xyz: ArrayLike) -> tuple[Array, Array, Mask]:
    """Return linear RGB (n, 3) in [0, 1] of XYZ (n, 3), that before gamut mapping, and
    which colours are outside (n,).
    """
    from uplift.colorimetry.gamut import map_to_gamut
    from uplift.extras.colour.outside import MAPPING

    sensor = cube.data.sensor
    sensor.require_xyz()
    values = as_rgb(xyz).astype(float)
    if not np.isfinite(values).all():
        raise ColourError("XYZ must be finite", hint="fix its source")
    rgb = np.asarray(values @ sensor.xyz_to_rgb.T)
    mapped = map_to_gamut(rgb, sensor, MAPPING)
    requested = np.where(mapped.outside[:, None], rgb, mapped.rgb)
    return mapped.rgb, requested, mapped.outside


def _block(
    cube: Cube,
    rgb: Array,
    requested: Array,
    outside: Mask,
    at: Array,
    mode: str,
    lights: Sequence[Light],
    answering: Answering | None,
) -> QueryBlock:
    data = cube.data
    sensor = data.sensor
    count = len(sensor.wavelengths)
    grid = np.concatenate([sensor.wavelengths, at])
    answered = np.where(outside[:, None], requested, rgb)
    if outside.any():
        from uplift.extras.colour.outside import reflectance_anywhere

        spectra = reflectance_anywhere(data, answered, grid, mode, outside)
    elif answering is not None:
        spectra = answering.spectra(rgb, grid)
    else:
        spectra = MODES[mode](data, rgb, grid)
    at_sensor = spectra[:, :count]
    round_trip = sensor.rgb(at_sensor)
    xyz = at_sensor @ sensor.light.xyz.T
    light_xyz = {light.name: at_sensor @ light.xyz.T for light in lights}
    delta_e = delta_e_rgb(sensor, answered, round_trip)
    outside_entries = _outside_entries(data, answered)
    names = _entry_names(cube, rgb, outside, outside_entries)
    unlike = np.zeros(len(rgb), dtype=bool)
    errors = np.full((len(rgb), 2), np.nan)
    light_errors = {}
    if data.points.standard_error is not None:
        unlike = cube.unlike_atlas(rgb) & ~outside
        errors = _errors(cube, rgb, outside, outside_entries)
        light_errors = {
            light.name: _errors(cube, rgb, outside, outside_entries, light)
            for light in lights
        }
    if answering is not None:
        from uplift.colorimetry.observer import light as find_light

        reference = find_light(data.error_illuminant, sensor.observer, *sensor.range)
        errors = answering.errors(rgb, reference)
        light_errors = {light.name: answering.errors(rgb, light) for light in lights}
    low, fraction = data.lattice.cell(rgb)
    return QueryBlock(
        rgb=answered,
        requested_rgb=requested,
        wavelengths=at,
        reflectance=spectra[:, count:],
        round_trip=round_trip,
        xyz=xyz,
        delta_e_2000=delta_e,
        cell=low,
        corner_statuses=data.points.status[data.lattice.cell_corners(low, fraction)[0]],
        entry=names,
        errors=errors,
        light_errors=light_errors,
        light_xyz=light_xyz,
        unlike_atlas=unlike,
        solid=data.solid,
    )


def _outside_entries(data: CubeData, rgb: Array) -> dict[int, int]:
    """Return the entry outside the RGB space of each row whose spectrum it alone
    answers.
    """
    if data.atlas.outside is None:
        return {}
    hits = data.outside_boxes.find(rgb)
    alone = hits.lattice_weight == 0
    return dict(zip(hits.rows[alone].tolist(), hits.entry[alone].tolist(), strict=True))


def _entry_names(
    cube: Cube, rgb: Array, outside: Mask, outside_entries: Mapping[int, int]
) -> list[str | None]:
    """Return the name of the entry that each colour is of, by their 8-bit codes."""
    atlas = cube.data.atlas
    names: list[str | None] = [None] * len(rgb)
    entry_codes = cube.encode(atlas.rgb)
    codes = cube.encode(rgb)
    for rows in blocks(len(rgb) if len(entry_codes) else 0, NAMED_ROWS):
        difference = np.abs(codes[rows, None] - entry_codes).max(axis=2)
        near = (difference.min(axis=1) <= CODE_TOLERANCE) & ~outside[rows]
        for row in np.flatnonzero(near).tolist():
            names[rows.start + row] = atlas.names[difference[row].argmin()]
    if atlas.outside is not None:
        for row, entry in outside_entries.items():
            names[row] = atlas.outside.names[entry]
    return names


def _known(error: float) -> float | None:
    return None if np.isnan(error) else float(error)


def _known_at(errors: Mapping[str, Array], row: int, column: int) -> dict[str, float]:
    """Return the errors of a row by light, without those that are unknown."""
    return {
        name: float(values[row, column])
        for name, values in errors.items()
        if not np.isnan(values[row, 0])
    }


def _errors(
    cube: Cube,
    rgb: Array,
    outside: Mask,
    entries: Mapping[int, int],
    light: Light | None = None,
) -> Array:
    """Standard errors and error bounds (n, 2) of a cube that has them, NaN ``outside``
    (n,) where no entry answers.
    """
    errors = np.full((len(rgb), 2), np.nan)
    errors[~outside] = expected_errors(cube, rgb[~outside], light)
    if entries:
        from uplift.extras.colour.outside import outside_errors

        known = outside_errors(cube.data, light)[list(entries.values())]
        errors[list(entries)] = known[:, None]
    return errors
