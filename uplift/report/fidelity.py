"""What a cube answers, beside what was measured: the error of every atlas entry."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Atlas, resample
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.observer import light
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices
from uplift.cube import CubeData
from uplift.lookup import Cube
from uplift.lookup.interpolate import lattice_spectra
from uplift.models import reflectance


@dataclass(frozen=True, eq=False)
class EntryQuery:
    """Colours to ask a cube for, and the spectra that would be the best answers.

    Parameters
    ----------
    names : (E) of the entries.
    rgb : (E, 3) linear, within [0, 1].
    wanted : (E, N) reflectances on the sensor's wavelengths.
    rows : (E,) of the cube's own atlas table; None for entries that it was not built from.
    outside : names of the entries that the cube's space does not hold.
    absent : names of those that a sparse cube has no points for.
    """

    names: tuple[str, ...]
    rgb: Array
    wanted: Array
    rows: Indices | None
    outside: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()

    def to(self, cube: Cube) -> EntryQuery:
        """The part of it that a cube can answer: all, but for sparse cubes."""
        held = cube.holds(self.rgb)
        names = [
            tuple(name for name, kept in zip(self.names, held, strict=True) if kept == w) for w in (1, 0)
        ]
        rows = None if self.rows is None else self.rows[held]
        return EntryQuery(names[0], self.rgb[held], self.wanted[held], rows, self.outside, names[1])


@dataclass(frozen=True, eq=False)
class EntryErrors:
    """E entries asked at their own RGB, worst first: by the largest ΔE00 under any of L lights.

    Parameters
    ----------
    wanted, answered : (E, N) reflectances: as measured, and as the cube answers.
    delta_e : (E, L) ΔE00 of ``answered`` against ``wanted``.
    rms : (E,) rms over wavelength of ``answered`` against ``wanted``.
    real, stated : (E,) ΔE00 of ``answered`` against ``wanted`` under the cube's reference light, and the cube's
        standard error at ``rgb``; None where it has none.
    cells : (E, 3) lowest corner of the voxel, as a position along the axes.

    Of the cube's own entries alone, None for all others:

    lattice : (E, N) what the lattice by itself, entries aside, makes of ``rgb``: answers beside the entry lead
        over to it.
    delta_e_lattice, rms_lattice : (E, L) and (E,) of ``lattice`` against ``wanted``.
    reach : (E,) lattice steps to the faces of the box around the entry; 0 where it is never answered.
    codes : (E,) 8-bit codes to the nearest pair of these faces, those at the lattice's edge aside.
    """

    names: tuple[str, ...]
    rgb: Array
    wanted: Array
    answered: Array
    delta_e: Array
    rms: Array
    real: Array
    stated: Array | None
    cells: Indices
    lattice: Array | None = None
    delta_e_lattice: Array | None = None
    rms_lattice: Array | None = None
    reach: Array | None = None
    codes: Array | None = None

    @property
    def worst(self) -> Array:
        """(E,) largest ΔE00 under any light."""
        return self.delta_e.max(axis=1)

    @property
    def worst_lattice(self) -> Array | None:
        """(E,) the same of the lattice by itself."""
        return None if self.delta_e_lattice is None else self.delta_e_lattice.max(axis=1)

    def take(self, rows: ArrayLike) -> EntryErrors:
        """The entries of rows (k,), in that order."""
        order = np.asarray(rows, dtype=np.int64)
        changed: dict[str, Any] = {
            field.name: value[order]
            for field in fields(self)
            if isinstance(value := getattr(self, field.name), np.ndarray)
        }
        return replace(self, names=tuple(self.names[row] for row in order), **changed)


def from_own_atlas(data: CubeData, spectra: Atlas) -> EntryQuery:
    """The entries that the cube is constrained by, with their measured spectra."""
    measured = resample(spectra, data.sensor.wavelengths).values
    place = {name: row for row, name in enumerate(data.atlas.names)}
    kept = [row for row, name in enumerate(spectra.names) if name in place]
    rows = np.array([place[spectra.names[row]] for row in kept], dtype=np.int64)
    outside = tuple(name for name in spectra.names if name not in place)
    return EntryQuery(
        tuple(spectra.names[row] for row in kept), data.atlas.rgb[rows], measured[kept], rows, outside
    )


def from_other_atlas(data: CubeData, spectra: Atlas) -> EntryQuery:
    """Entries that the cube was not built from, those that its space holds."""
    measured = resample(spectra, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    inside = data.sensor.contains(rgb)
    names = [
        tuple(name for name, held in zip(spectra.names, inside, strict=True) if held == wanted)
        for wanted in (True, False)
    ]
    return EntryQuery(names[0], np.clip(rgb[inside], 0, 1), measured[inside], None, names[1])


def from_stored_entries(data: CubeData) -> EntryQuery:
    """The cube's own entries where nobody has the measurements: their stored spectra stand in."""
    atlas = data.atlas
    spectra = reflectance(data.model, atlas.coefficients, data.sensor.wavelengths)
    return EntryQuery(atlas.names, atlas.rgb, spectra, np.arange(len(atlas.names)))


def entries(cube: Cube, question: EntryQuery, lights: tuple[Sensor, ...]) -> EntryErrors:
    """The errors of a cube, asked in its default mode. ``question`` has one entry at least."""
    data, wanted = cube.data, question.wanted
    answered = cube.reflectance(question.rgb)
    found = EntryErrors(
        names=question.names,
        rgb=question.rgb,
        wanted=wanted,
        answered=answered,
        delta_e=_under(lights, answered, wanted),
        rms=_rms(answered, wanted),
        real=delta_e_spectra(light(data.error_illuminant, data.sensor.observer), answered, wanted),
        stated=cube.standard_error(question.rgb),
        cells=data.lattice.cell(question.rgb)[0],
    )
    if question.rows is not None:
        found = _own(cube, found, question.rows, lights)
    return found.take(np.lexsort((-found.rms, -found.worst)))


def _own(cube: Cube, found: EntryErrors, rows: Indices, lights: tuple[Sensor, ...]) -> EntryErrors:
    """What can be said of those entries alone that lie in rows (E,) of the cube's atlas table."""
    data = cube.data
    lattice = lattice_spectra(data, found.rgb, data.sensor.wavelengths)
    low, middle, high = (
        cube.encode(rgb[rows])
        for rgb in (data.entry_boxes.faces[0], data.atlas.rgb, data.entry_boxes.faces[1])
    )
    return replace(
        found,
        lattice=lattice,
        delta_e_lattice=_under(lights, lattice, found.wanted),
        rms_lattice=_rms(lattice, found.wanted),
        reach=data.atlas.half_width[rows],
        codes=np.maximum(high - middle, middle - low).min(axis=1),
    )


def _under(lights: tuple[Sensor, ...], first: Array, second: Array) -> Array:
    return np.stack([delta_e_spectra(seen.light, first, second) for seen in lights], axis=1)


def _rms(first: Array, second: Array) -> Array:
    return np.sqrt(((first - second) ** 2).mean(axis=1))
