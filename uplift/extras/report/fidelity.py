"""Errors of a cube at the colours of atlas entries, next to those of other methods."""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.observer import light, on_range
from uplift.colorimetry.sensor import Light, Sensor, in_unit_cube
from uplift.common.arrays import Array, Indices
from uplift.cube.data import CubeData
from uplift.extras.colour.outside import MAPPING, reflectance_anywhere
from uplift.extras.report.measures import delta_e_under, rms_difference
from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import lattice_spectra
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate
from uplift.models.sigmoid import Sigmoid


@dataclass(frozen=True, eq=False)
class EntryQuery:
    """Colours to query, and the spectra that would be the best answers."""

    names: tuple[str, ...]  # Names of E entries
    # (E, 3) Linear RGB, outside [0, 1] for the cube's entries outside its space
    rgb: Array
    target: Array  # (E, N) Reflectances at the sensor's wavelengths
    # (E,) Rows of the table of all entries of the cube; None for other entries
    rows: Indices | None

    def answerable_by(self, cube: Cube) -> "EntryQuery":
        """Keep the entries that a cube has nodes for: a sparse one lacks some."""
        return take(self, np.flatnonzero(cube.covers(_inside(cube.data, self.rgb))))


@dataclass(frozen=True, eq=False)
class Answers:
    """Answers of a method at the colours of E entries; NaN for colours that it does not
    answer.
    """

    spectra: Array  # (E, N) Reflectances
    delta_e: Array  # (E, L) ΔE00 from the targets under L lights
    rms: Array  # (E,) rms difference over wavelength from the targets

    @property
    def worst(self) -> Array:
        """Return the largest ΔE00 under any light, (E,)."""
        return self.delta_e.max(axis=1)

    def means(self) -> Array:
        """Return the mean rms and the mean ΔE00 under each light, (1 + L,)."""
        return np.concatenate([[self.rms.mean()], self.delta_e.mean(axis=0)])

    @property
    def answered(self) -> Array:
        """Return the ΔE00 (k, L) of the colours that are answered; a row of NaN without
        any.
        """
        known = self.delta_e[~np.isnan(self.delta_e).any(axis=1)]
        return known if len(known) else np.full((1, self.delta_e.shape[1]), np.nan)


@dataclass(frozen=True, eq=False)
class EntryErrors:
    """Errors of E entries at their own RGB, worst first: by the largest ΔE00 under any
    of L lights.
    """

    names: tuple[str, ...]  # Names of the entries
    rgb: Array  # (E, 3) Linear RGB
    target: Array  # (E, N) Reflectances as measured or, without measurements, as stored
    answers: Answers  # Those of the cube
    # (E,) ΔE00 between answer and ``target`` under the cube's error illuminant
    actual: Array
    # (E,) Standard error of the cube at ``rgb``; None if it has none
    predicted: Array | None
    cells: Indices  # (E, 3) Position of the lowest corner of the cell along the axes
    # Interpolated from the lattice without the entries. This and all further fields are
    # None for entries that the cube was not built from
    lattice: Answers | None = None
    # (E,) Lattice steps from the entry to the faces of its box; 0 if no colour returns
    # the entry
    half_width: Array | None = None
    # (E,) The same in 8-bit codes, to the nearest pair of faces
    half_width_codes: Array | None = None


Rows = TypeVar("Rows", EntryQuery, Answers, EntryErrors)


def take(table: Rows, rows: ArrayLike) -> Rows:
    """Select rows (k,) of all arrays and tuples of a table, and of those in it."""
    order = np.asarray(rows, dtype=np.int64)

    def part(value: Any) -> Any:
        if isinstance(value, tuple):
            return tuple(value[row] for row in order)
        if isinstance(value, np.ndarray):
            return value[order]
        return None if value is None else take(value, order)

    return replace(
        table,
        **{field.name: part(getattr(table, field.name)) for field in fields(table)},
    )


def from_own_atlas(data: CubeData, atlas: Atlas) -> EntryQuery:
    """Query the entries that the cube was built from; targets are the
    measured spectra.
    """
    table = data.atlas.with_outside
    row_of = {name: row for row, name in enumerate(table.names)}
    known = [row for row, name in enumerate(atlas.names) if name in row_of]
    names = tuple(atlas.names[row] for row in known)
    rows = np.array([row_of[name] for name in names], dtype=np.int64)
    return EntryQuery(
        names,
        table.rgb[rows],
        resample(atlas, data.sensor.wavelengths).values[known],
        rows,
    )


def from_other_atlas(data: CubeData, atlas: Atlas) -> EntryQuery:
    """Query entries that the cube was not built from, as far as they lie in its RGB
    space.
    """
    measured = resample(atlas, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    query = EntryQuery(atlas.names, np.clip(rgb, 0, 1), measured, None)
    return take(query, np.flatnonzero(in_unit_cube(rgb)))


def from_stored_entries(data: CubeData) -> EntryQuery:
    """Query the cube's own entries; without measurements, targets are the stored
    spectra.
    """
    table = data.atlas.with_outside
    rows = np.arange(len(table.names))
    spectra = table.spectra
    return EntryQuery(
        table.names, table.rgb, spectra.reflectance(rows, data.sensor.wavelengths), rows
    )


def entry_errors(
    cube: Cube, query: EntryQuery, lights: tuple[Sensor, ...]
) -> EntryErrors:
    """Compare the answers of a cube in its default mode with the targets of a query."""
    data = cube.data
    target = query.target
    inside = _inside(data, query.rgb)
    spectra = reflectance_anywhere(
        data, query.rgb, data.sensor.wavelengths, "spectra", ~in_unit_cube(query.rgb)
    )
    answers = compare_spectra(spectra, target, [sensor.light for sensor in lights])
    errors = EntryErrors(
        names=query.names,
        rgb=query.rgb,
        target=target,
        answers=answers,
        actual=delta_e_spectra(
            light(data.error_illuminant, data.sensor.observer, *data.sensor.range),
            spectra,
            target,
        ),
        predicted=cube.standard_error(inside),
        cells=data.lattice.cell(inside)[0],
    )
    if query.rows is not None:
        errors = _with_lattice_errors(cube, errors, query.rows, lights)
    return take(errors, np.lexsort((-answers.rms, -answers.worst)))


def _with_lattice_errors(
    cube: Cube, errors: EntryErrors, rows: Indices, lights: tuple[Sensor, ...]
) -> EntryErrors:
    """Add the fields that only the cube's own entries have; ``rows`` (E,) are those of
    all its entries.
    """
    data = cube.data
    table = data.atlas.with_outside
    boxes = data.outside_boxes
    reach = boxes.half_width[:, None]
    lower, upper = data.entry_boxes.faces
    faces = (
        np.concatenate([lower, boxes.rgb - reach]),
        table.rgb,
        np.concatenate([upper, boxes.rgb + reach]),
    )

    def codes(linear: Array) -> Array:
        rgb = linear[rows]
        return np.sign(rgb) * cube.encode(np.abs(rgb))

    low, centre, high = map(codes, faces)
    is_outside = rows >= len(data.atlas.names)
    return replace(
        errors,
        lattice=compare_spectra(
            lattice_spectra(
                data.model,
                data.lattice,
                data.points,
                _inside(data, errors.rgb),
                data.sensor.wavelengths,
            ),
            errors.target,
            [sensor.light for sensor in lights],
        ),
        predicted=None
        if errors.predicted is None
        else np.where(is_outside, table.error[rows], errors.predicted),
        half_width=table.half_width[rows],
        half_width_codes=np.maximum(high - centre, centre - low).min(axis=1),
    )


def _inside(data: CubeData, rgb: Array) -> Array:
    """Colours (n, 3) of the lattice from which those outside the RGB space are
    answered; others are unchanged.
    """
    return map_to_gamut(rgb, data.sensor, MAPPING).rgb


def compare_spectra(spectra: Array, target: Array, lights: Iterable[Light]) -> Answers:
    """Compare answers with targets, both reflectances (E, N)."""
    delta_e = delta_e_under(lights, spectra, target)
    return Answers(spectra, delta_e, rms_difference(spectra, target))


WITHOUT_ATLAS = "without atlas"
JAKOB_HANIKA = "Jakob & Hanika"


def find_alternatives(
    data: CubeData, errors: EntryErrors, lights: tuple[Sensor, ...]
) -> dict[str, Answers]:
    """Compute the answers of other methods at the colours of entries, by the name of
    the method.
    """
    spectra = {
        WITHOUT_ATLAS: _without_atlas(errors.target, data.sensor),
        JAKOB_HANIKA: _sigmoid(data, errors.rgb),
    }
    under = [sensor.light for sensor in lights]
    return {
        name: compare_spectra(reflectances, errors.target, under)
        for name, reflectances in spectra.items()
    }


def _without_atlas(target: Array, assessed: Sensor) -> Array:
    """Reflectance (E, N) of the packaged cube at the colours of measured spectra (E,
    N).
    """
    cube = load()
    rgb = on_range(cube.data.sensor, *assessed.range).rgb(target)
    inside = in_unit_cube(rgb)
    answer = np.full_like(target, np.nan)
    answer[inside] = cube.reflectance(np.clip(rgb[inside], 0, 1), assessed.wavelengths)
    return answer


def _sigmoid(data: CubeData, rgb: Array) -> Array:
    """Reflectance (E, N) of the sigmoid with exactly the colours (E, 3),
    from grey on.
    """
    model = Sigmoid()
    multipliers = refine_to_rgb(data, model, np.zeros((len(rgb), model.count)), rgb)
    answer = evaluate(model, multipliers, data.sensor.wavelengths)
    distance = np.abs(data.sensor.rgb(answer) - rgb).max(axis=1)
    return np.where((distance <= data.threshold)[:, None], answer, np.nan)
