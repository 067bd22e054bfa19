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
    """The answers to n colours, by columns."""

    rgb: Array
    """(n, 3) linear RGB, in [0, 1] unless the query was by XYZ."""
    requested_rgb: Array
    """(n, 3) linear RGB before gamut mapping."""
    wavelengths: Array
    """(N,) nm."""
    reflectance: Array
    """(n, N) in [0, 1]."""
    round_trip: Array
    """(n, 3) linear RGB of the reflectance."""
    xyz: Array
    """(n, 3) XYZ of the reflectance under the illuminant of the cube, where white has Y
    = 1.
    """
    delta_e_2000: Array
    """(n,) ΔE00 between ``rgb`` and ``round_trip``; for raw values of a camera, by an
    approximate matrix.
    """
    cell: Indices
    """(n, 3) position of the lowest corner of the cell along the axes."""
    corner_statuses: NDArray[np.uint8]
    """(n, 4) statuses of the nodes around the colour."""
    entry: list[str | None]
    """(n,) atlas entry whose 8-bit codes are those of the colour, within
    `CODE_TOLERANCE`.
    """
    errors: Array
    """(n, 2) ΔE00 from the answer that 68 % and 95 % of measurements stay within; NaN
    where they are unknown.
    """
    light_errors: Mapping[str, Array]
    """The same by light."""
    light_xyz: Mapping[str, Array]
    """XYZ (n, 3) of the reflectance by light; the perfect reflector has that of
    `Light.white`.
    """
    unlike_atlas: Mask
    """(n,) whether no atlas entry has a colour near this one, not whether the material
    is of another kind; see `Cube.unlike_atlas`. False without standard errors.
    """
    solid: Solid
    """Solid of the realisable colours."""

    @cached_property
    def realisable(self) -> Mask:
        """(n,) whether a reflectance with the colour exists. If not, the answer has
        less chroma.
        """
        # The solid is convex: with the corners of RGB it contains everything between.
        if (
            in_unit_cube(self.rgb).all()
            and self.solid.contains(CORNERS.astype(float)).all()
        ):
            return np.ones(len(self), dtype=bool)
        return self.solid.contains(self.rgb)

    @cached_property
    def statuses(self) -> list[tuple[Status, ...]]:
        """(n,) different statuses of the nodes around the colours."""
        keys = self.corner_statuses.view("u4")[:, 0].tolist()
        # np.unique without counts imports numpy.ma, which takes time.
        distinct = {
            key: tuple(map(Status, sorted(set(key.to_bytes(4, sys.byteorder)))))
            for key in set(keys)
        }
        return [distinct[key] for key in keys]

    def __len__(self) -> int:
        return len(self.rgb)


class Answering(Protocol):
    """What answers colours in place of a cube alone."""

    def spectra(self, rgb: Array, wavelengths: Array) -> Array:
        """Reflectance (n, N) at linear RGB (n, 3)."""
        ...

    def errors(self, rgb: Array, light: Light) -> Array:
        """Standard errors and error bounds (n, 2) under a light."""
        ...


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
    `QueryBlock.light_errors`. Colours that are ``outside`` (n,) by `locate_xyz`
    are answered as requested, not as mapped: the spectra are computed from the nearest
    colour that the cube holds, and from an atlas entry outside the space close to it;
    only those of such entries have a standard error. ``answering`` takes the place of
    the cube for the others. Raises `UnknownNameError` for an unknown mode, and
    `ColourError` (``colour-unrealisable``) if no reflectance has a colour, or the model
    does not reach it.
    """
    if mode not in MODES:
        raise unknown_name(mode, MODES, "mode")
    at = as_wavelengths(wavelengths, cube.data.sensor.wavelengths)
    lookup = _Lookup(cube, at, mode, lights, answering)
    requested = rgb if requested_rgb is None else requested_rgb
    rgb = as_colours(rgb, cube.data.sensor)
    beyond = np.zeros(len(rgb), dtype=bool) if outside is None else outside
    for block in blocks(len(rgb), BLOCK):
        yield lookup.answer(rgb[block], requested[block], beyond[block])


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


@dataclass(frozen=True, eq=False)
class _Lookup:
    """A cube, and how colours are looked up in it."""

    cube: Cube
    wavelengths: Array
    mode: str
    lights: Sequence[Light]
    answering: Answering | None

    def spectra(self, rgb: Array, grid: Array, outside: Mask) -> Array:
        """Compute reflectances (n, N) at linear RGB (n, 3)."""
        data = self.cube.data
        if outside.any():
            from uplift.extras.colour.outside import reflectance_anywhere

            return reflectance_anywhere(data, rgb, grid, self.mode, outside)
        if self.answering is not None:
            return self.answering.spectra(rgb, grid)
        return MODES[self.mode](data, rgb, grid)

    def answer(self, rgb: Array, requested: Array, outside: Mask) -> QueryBlock:
        """Answer colours (n, 3), of which those outside the RGB space are answered as
        requested.
        """
        cube = self.cube
        data = cube.data
        sensor = data.sensor
        count = len(sensor.wavelengths)
        grid = np.concatenate([sensor.wavelengths, self.wavelengths])
        answered = np.where(outside[:, None], requested, rgb)
        spectra = self.spectra(answered, grid, outside)
        at_sensor = spectra[:, :count]
        round_trip = sensor.rgb(at_sensor)
        outside_entries = _outside_entries(data, answered)
        unlike = np.zeros(len(rgb), dtype=bool)
        if data.points.standard_error is not None:
            unlike = cube.unlike_atlas(rgb) & ~outside

        def errors(light: Light | None) -> Array:
            if self.answering is not None:
                return self.answering.errors(rgb, light or _error_light(data))
            return _errors(cube, rgb, outside, outside_entries, light)

        is_stated = self.answering or data.points.standard_error is not None
        low, fraction = data.lattice.cell(rgb)
        corners, _ = data.lattice.tetrahedra(low, fraction)
        return QueryBlock(
            rgb=answered,
            requested_rgb=requested,
            wavelengths=self.wavelengths,
            reflectance=spectra[:, count:],
            round_trip=round_trip,
            xyz=at_sensor @ sensor.light.xyz.T,
            delta_e_2000=delta_e_rgb(sensor, answered, round_trip),
            cell=low,
            corner_statuses=data.points.status[corners],
            entry=_entry_names(cube, rgb, outside, outside_entries),
            errors=errors(None) if is_stated else np.full((len(rgb), 2), np.nan),
            light_errors={light.name: errors(light) for light in self.lights}
            if is_stated
            else {},
            light_xyz={light.name: at_sensor @ light.xyz.T for light in self.lights},
            unlike_atlas=unlike,
            solid=data.solid,
        )


def _error_light(data: CubeData) -> Light:
    """Return the light of the standard errors of a cube."""
    from uplift.colorimetry.observer import light

    return light(data.error_illuminant, data.sensor.observer, *data.sensor.range)


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
