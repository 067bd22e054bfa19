"""Errors of a cube at the colours of atlas entries, next to the answers of other methods; entries close to others."""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Atlas, resample
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.observer import light, on_range
from uplift.colorimetry.sensor import Sensor, in_unit_cube
from uplift.common.arrays import Array, Indices, Mask
from uplift.cube import AtlasTable, CubeData
from uplift.lookup import Cube, load
from uplift.lookup.interpolate import lattice_spectra
from uplift.lookup.query import MAPPING, reflectance_anywhere
from uplift.lookup.refine import refine_to_rgb
from uplift.models import Sigmoid, evaluate


@dataclass(frozen=True, eq=False)
class EntryQuery:
    """Colours to query, and the spectra that would be the best answers."""

    names: tuple[str, ...]  # Names of E entries
    rgb: Array  # (E, 3) Linear RGB, outside [0, 1] for the cube's entries outside its space
    target: Array  # (E, N) Reflectances at the sensor's wavelengths
    # (E,) Rows of the cube's atlas table, counted on in that of entries outside its space; None for other entries
    rows: Indices | None
    out_of_gamut: tuple[str, ...] = ()  # Names of the entries outside the cube's RGB space
    not_covered: tuple[str, ...] = ()  # Names of the entries for which a sparse cube has no points

    def answerable_by(self, cube: Cube) -> "EntryQuery":
        """Keep the entries that a cube has points for."""
        covered = cube.covers(_inside(cube.data, self.rgb))
        names, not_covered = _partition(self.names, covered)
        rows = None if self.rows is None else self.rows[covered]
        return EntryQuery(names, self.rgb[covered], self.target[covered], rows, self.out_of_gamut, not_covered)


@dataclass(frozen=True, eq=False)
class EntryErrors:
    """Errors of E entries at their own RGB, worst first: by the largest ΔE00 under any of L lights."""

    names: tuple[str, ...]  # Names of the entries
    rgb: Array  # (E, 3) Linear RGB
    target: Array  # (E, N) Reflectances as measured or, without measurements, as stored
    answer: Array  # (E, N) Reflectances that the cube returns
    delta_e: Array  # (E, L) ΔE00 between ``answer`` and ``target``
    rms: Array  # (E,) rms difference over wavelength between ``answer`` and ``target``
    actual: Array  # (E,) ΔE00 between ``answer`` and ``target`` under the cube's error illuminant
    predicted: Array | None  # (E,) Standard error of the cube at ``rgb``; None if it has none
    cells: Indices  # (E, 3) Position of the lowest corner of the cell along the axes
    # (E, N) Reflectances interpolated from the lattice without the entries. This and all further fields are None
    # for entries that the cube was not built from
    lattice: Array | None = None
    delta_e_lattice: Array | None = None  # (E, L) ΔE00 between ``lattice`` and ``target``
    rms_lattice: Array | None = None  # (E,) rms difference between ``lattice`` and ``target``
    # (E,) Lattice steps from the entry to the faces of its box; 0 if no colour returns the entry
    half_width: Array | None = None
    half_width_codes: Array | None = None  # (E,) The same in 8-bit codes, to the nearest pair of faces

    @property
    def worst(self) -> Array:
        """Return the largest ΔE00 under any light, (E,)."""
        return self.delta_e.max(axis=1)

    @property
    def worst_lattice(self) -> Array | None:
        """Return the largest ΔE00 of the lattice under any light, (E,), or None."""
        return None if self.delta_e_lattice is None else self.delta_e_lattice.max(axis=1)

    def take(self, rows: ArrayLike) -> "EntryErrors":
        """Select entries by their rows (k,)."""
        order = np.asarray(rows, dtype=np.int64)
        selected: dict[str, Any] = {
            field.name: value[order]
            for field in fields(self)
            if isinstance(value := getattr(self, field.name), np.ndarray)
        }
        return replace(self, names=tuple(self.names[row] for row in order), **selected)


def from_own_atlas(data: CubeData, atlas: Atlas) -> EntryQuery:
    """Query the entries that the cube was built from; targets are the measured spectra."""
    measured = resample(atlas, data.sensor.wavelengths).values
    tables = _tables(data)
    row_of = {name: row for row, name in enumerate(name for table in tables for name in table.names)}
    in_cube = np.array([name in row_of for name in atlas.names], dtype=bool)
    names, out_of_gamut = _partition(atlas.names, in_cube)
    rows = np.array([row_of[name] for name in names], dtype=np.int64)
    rgb = np.concatenate([table.rgb for table in tables])[rows]
    return EntryQuery(names, rgb, measured[in_cube], rows, out_of_gamut)


def _tables(data: CubeData) -> tuple[AtlasTable, ...]:
    """Return the entries in the RGB space, and those outside it if there are any."""
    return (data.atlas,) if data.atlas.outside is None else (data.atlas, data.atlas.outside)


def _inside(data: CubeData, rgb: Array) -> Array:
    """Colours (n, 3) of the lattice from which those outside the RGB space are answered; others are unchanged."""
    return map_to_gamut(rgb, data.sensor, MAPPING).rgb


def from_other_atlas(data: CubeData, atlas: Atlas) -> EntryQuery:
    """Query entries that the cube was not built from."""
    measured = resample(atlas, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    inside = data.sensor.contains(rgb)
    names, out_of_gamut = _partition(atlas.names, inside)
    return EntryQuery(names, np.clip(rgb[inside], 0, 1), measured[inside], None, out_of_gamut)


def from_stored_entries(data: CubeData) -> EntryQuery:
    """Query the cube's own entries; without measurements, targets are the stored spectra."""
    table = data.atlas
    stored = data.entry_spectra.reflectance(np.arange(len(table.names)), data.sensor.wavelengths)
    return EntryQuery(table.names, table.rgb, stored, np.arange(len(table.names)))


def entry_errors(cube: Cube, query: EntryQuery, lights: tuple[Sensor, ...]) -> EntryErrors:
    """Compare the answers of a cube in its default mode with the targets of a query."""
    data, target = cube.data, query.target
    inside = _inside(data, query.rgb)
    answer = reflectance_anywhere(cube, query.rgb, data.sensor.wavelengths, "spectra", ~in_unit_cube(query.rgb))
    errors = EntryErrors(
        names=query.names,
        rgb=query.rgb,
        target=target,
        answer=answer,
        delta_e=_delta_e(lights, answer, target),
        rms=_rms(answer, target),
        actual=delta_e_spectra(light(data.error_illuminant, data.sensor.observer, *data.sensor.range), answer, target),
        predicted=cube.standard_error(inside),
        cells=data.lattice.cell(inside)[0],
    )
    if query.rows is not None:
        errors = _with_lattice_errors(cube, errors, query.rows, lights)
    return errors.take(np.lexsort((-errors.rms, -errors.worst)))


def _with_lattice_errors(cube: Cube, errors: EntryErrors, rows: Indices, lights: tuple[Sensor, ...]) -> EntryErrors:
    """Add the fields that only the cube's own entries have; ``rows`` (E,) are those of its atlas table."""
    data = cube.data
    lattice = lattice_spectra(data, _inside(data, errors.rgb), data.sensor.wavelengths)
    boxes, reach = data.outside_boxes, data.outside_boxes.half_width[:, None]
    low_faces, high_faces = data.entry_boxes.faces
    faces = (low_faces, boxes.rgb - reach), (data.atlas.rgb, boxes.rgb), (high_faces, boxes.rgb + reach)
    low, centre, high = (np.concatenate(each)[rows] for each in faces)
    low, centre, high = (np.sign(rgb) * cube.encode(np.abs(rgb)) for rgb in (low, centre, high))
    predicted = errors.predicted
    if predicted is not None:
        is_outside = rows >= len(data.atlas.names)
        own = np.concatenate([table.error for table in _tables(data)])[rows]
        predicted = np.where(is_outside, own, predicted)
    return replace(
        errors,
        lattice=lattice,
        delta_e_lattice=_delta_e(lights, lattice, errors.target),
        rms_lattice=_rms(lattice, errors.target),
        predicted=predicted,
        half_width=np.concatenate([table.half_width for table in _tables(data)])[rows],
        half_width_codes=np.maximum(high - centre, centre - low).min(axis=1),
    )


def _partition(names: tuple[str, ...], mask: Mask) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names where the mask (E,) is true, and names where it is false."""
    pairs = list(zip(names, mask.tolist(), strict=True))
    return tuple(name for name, true in pairs if true), tuple(name for name, true in pairs if not true)


def _delta_e(lights: tuple[Sensor, ...], first: Array, second: Array) -> Array:
    return np.stack([delta_e_spectra(sensor.light, first, second) for sensor in lights], axis=1)


def _rms(first: Array, second: Array) -> Array:
    return np.sqrt(((first - second) ** 2).mean(axis=1))


WITHOUT_ATLAS, JAKOB_HANIKA = "without atlas", "Jakob & Hanika"


@dataclass(frozen=True, eq=False)
class Alternative:
    """Answers of another method at the colours of E entries."""

    name: str  # Name of the method
    answer: Array  # (E, N) Reflectances; NaN for colours that the method does not answer
    delta_e: Array  # (E, L) ΔE00 to the measured spectra under L lights; NaN likewise

    @property
    def mean(self) -> Array:
        """Return the mean ΔE00 of the answers under each light, shape (L,); NaN without any."""
        return self._statistic(np.mean)

    @property
    def largest(self) -> Array:
        """Return the largest ΔE00 of the answers under each light, shape (L,); NaN without any."""
        return self._statistic(np.max)

    def _statistic(self, function: Callable[..., Array]) -> Array:
        known = self.delta_e[~np.isnan(self.delta_e).any(axis=1)]
        return function(known, axis=0) if len(known) else np.full(self.delta_e.shape[1], np.nan)


def find_alternatives(data: CubeData, errors: EntryErrors, lights: tuple[Sensor, ...]) -> tuple[Alternative, ...]:
    """Compute the answers of other methods at the colours of entries."""
    answers = {
        WITHOUT_ATLAS: _without_atlas(errors.target, data.sensor),
        JAKOB_HANIKA: _sigmoid(data, errors.rgb),
    }
    alternatives = []
    for name, answer in answers.items():
        known = ~np.isnan(answer).any(axis=1)
        delta_e = np.full((len(answer), len(lights)), np.nan)
        delta_e[known] = _delta_e(lights, answer[known], errors.target[known])
        alternatives.append(Alternative(name, answer, delta_e))
    return tuple(alternatives)


def _without_atlas(target: Array, assessed: Sensor) -> Array:
    """Reflectance (E, N) of the packaged cube at the colours of measured spectra (E, N)."""
    cube = load()
    rgb = on_range(cube.data.sensor, *assessed.range).rgb(target)
    inside = cube.data.sensor.contains(rgb)
    answer = np.full_like(target, np.nan)
    answer[inside] = cube.reflectance(np.clip(rgb[inside], 0, 1), assessed.wavelengths)
    return answer


def _sigmoid(data: CubeData, rgb: Array) -> Array:
    """Reflectance (E, N) of the sigmoid with exactly the colours (E, 3), from grey on."""
    model = Sigmoid()
    multipliers = refine_to_rgb(data, model, np.zeros((len(rgb), model.count)), rgb)
    answer = evaluate(model, multipliers, data.sensor.wavelengths)
    distance = np.abs(data.sensor.rgb(answer) - rgb).max(axis=1)
    return np.where((distance <= data.threshold)[:, None], answer, np.nan)


MAX_DISTANCE = 1 + 1e-9  # lattice steps; two entries of one cell are never farther apart


@dataclass(frozen=True, eq=False)
class Crowding:
    """Entries of a cube that have another one within a lattice step, largest error of the lattice first."""

    entries: EntryErrors  # Errors of the k close entries
    nearest: tuple[str, ...]  # Name of the nearest other entry, for each of the k
    distances: Array  # (k,) Lattice steps to the nearest other entry, along the axis on which they differ most
    # Entries that no colour returns because another one has the same colour, and the name of the other
    lost: tuple[tuple[str, str], ...]


def find_crowding(data: CubeData, entries: EntryErrors) -> Crowding:
    """Find the entries that have another one within a lattice step."""
    names = data.atlas.names
    nearest, distances = _nearest(data.lattice.to_steps(data.atlas.rgb))
    row_of = {name: row for row, name in enumerate(names)}
    entries = entries.take([row for row, name in enumerate(entries.names) if name in row_of])
    assert entries.worst_lattice is not None
    rows = np.array([row_of[name] for name in entries.names])
    order = np.argsort(-entries.worst_lattice, kind="stable")
    kept = order[distances[rows[order]] <= MAX_DISTANCE]
    return Crowding(
        entries.take(kept),
        tuple(names[other] for other in nearest[rows[kept]]),
        distances[rows[kept]],
        _lost(data),
    )


def _nearest(steps: Array) -> tuple[Indices, Array]:
    """Index of the nearest other row of ``steps`` (n, 3), and its maximum-norm distance, infinite for n < 2."""
    from scipy.spatial import KDTree

    if len(steps) < 2:
        return np.zeros(len(steps), dtype=np.int64), np.full(len(steps), np.inf)
    distances, rows = KDTree(steps).query(steps, k=2, p=np.inf)
    # The first of the two is the row itself, unless another has the same colour.
    return np.where(rows[:, 0] == np.arange(len(steps)), rows[:, 1], rows[:, 0]), distances[:, 1]


def _lost(data: CubeData) -> tuple[tuple[str, str], ...]:
    names, rows = data.atlas.names, np.flatnonzero(data.atlas.half_width == 0)
    hits = data.entry_boxes.find(data.atlas.rgb[rows])
    return tuple((names[rows[row]], names[other]) for row, other in zip(hits.rows, hits.entry, strict=True))
