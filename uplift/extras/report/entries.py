"""Errors of a cube at the colours of atlas entries, next to those of other methods, and
entries that are close to others.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.observer import light, on_range
from uplift.colorimetry.sensor import Light, in_unit_cube
from uplift.common.arrays import Array, Indices, Values
from uplift.cube.data import CubeData
from uplift.extras.colour.outside import MAPPING, reflectance_anywhere
from uplift.extras.report.comparison import SpectraComparison, compare_spectra
from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import lattice_spectra
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate
from uplift.models.sigmoid import Sigmoid

MAX_DISTANCE = 1 + 1e-9
"""Lattice steps between close entries; two of one cell are never farther apart."""


@dataclass(frozen=True, eq=False)
class Entries:
    """E entries: colours to query, and the spectra that would be the best answers."""

    names: Values
    """(E,) names."""
    rgb: Array
    """(E, 3) linear RGB, outside [0, 1] for the cube's entries outside its space."""
    target: Array
    """(E, N) reflectances as measured or, without measurements, as stored."""
    rows: Indices | None = None
    """(E,) rows in the table of all entries of the cube; None for other entries."""

    def take(self, rows: ArrayLike) -> Self:
        """Select rows (k,)."""
        columns = {
            name: value for name, value in vars(self).items() if value is not None
        }
        return replace(self, **{name: column[rows] for name, column in columns.items()})


@dataclass(frozen=True, eq=False, kw_only=True)
class EntryErrors(Entries):
    """Errors of E entries at their own RGB, worst first: by the largest ΔE00 under any
    of L lights.
    """

    answers: SpectraComparison
    """Answers of the cube."""
    actual: Array
    """(E,) ΔE00 of the answers under the cube's error illuminant."""
    predicted: Array | None
    """(E,) standard error of the cube; None if it has none."""
    cells: Indices
    """(E, 3) position of the lowest corner of the cell along the axes."""
    lattice: SpectraComparison | None = None
    """Interpolated from the lattice without the entries. This and all further fields
    are None for entries that the cube was not built from.
    """
    half_width: Array | None = None
    """(E,) lattice steps from the entry to the faces of its box; 0 if no colour returns
    the entry.
    """
    half_width_codes: Array | None = None
    """(E,) the same in 8-bit codes, to the nearest pair of faces."""


def own_entries(data: CubeData, atlas: Atlas | None = None) -> Entries:
    """Query the entries of a cube: those of the atlas that it was built from, with the
    measured spectra, or all, with the stored ones.
    """
    table = data.atlas.with_outside
    at = data.sensor.wavelengths
    names = np.array(table.names, dtype=object)
    every = np.arange(len(names))
    if atlas is None:
        spectra = table.spectra.reflectance(every, at)
        return Entries(names, table.rgb, spectra, every)
    row_of = dict(zip(table.names, every, strict=True))
    known = [row for row, name in enumerate(atlas.names) if name in row_of]
    rows = np.array([row_of[atlas.names[row]] for row in known], dtype=np.int64)
    measured = resample(atlas, at).values[known]
    return Entries(names[rows], table.rgb[rows], measured, rows)


def other_entries(data: CubeData, atlas: Atlas) -> Entries:
    """Query entries that the cube was not built from, as far as they lie in its RGB
    space.
    """
    measured = resample(atlas, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    names = np.array(atlas.names, dtype=object)
    return Entries(names, np.clip(rgb, 0, 1), measured).take(in_unit_cube(rgb))


def entry_errors(
    cube: Cube, entries: Entries, lights: Sequence[Light]
) -> EntryErrors | None:
    """Compare the answers of a cube in its default mode with the best ones; None if a
    sparse cube has no nodes for any of the entries.
    """
    data = cube.data
    # Colours of the lattice from which those outside the RGB space are answered
    inside = map_to_gamut(entries.rgb, data.sensor, MAPPING).rgb
    covered = cube.covers(inside)
    if not covered.any():
        return None
    entries = entries.take(covered)
    inside = inside[covered]
    at = data.sensor.wavelengths
    spectra = reflectance_anywhere(
        data, entries.rgb, at, "spectra", ~in_unit_cube(entries.rgb)
    )
    reference = light(data.error_illuminant, data.sensor.observer, *data.sensor.range)
    answers = compare_spectra(entries.target, spectra, lights)
    errors = EntryErrors(
        **vars(entries),
        answers=answers,
        actual=delta_e_spectra(reference, spectra, entries.target),
        predicted=cube.standard_error(inside),
        cells=data.lattice.cell(inside)[0],
    )
    if (rows := entries.rows) is not None:
        table = data.atlas.with_outside
        lattice = lattice_spectra(data.model, data.lattice, data.points, inside, at)
        is_outside = rows >= len(data.atlas.names)
        predicted = errors.predicted
        if predicted is not None:
            predicted = np.where(is_outside, table.error[rows], predicted)
        errors = replace(
            errors,
            lattice=compare_spectra(entries.target, lattice, lights),
            predicted=predicted,
            half_width=table.half_width[rows],
            half_width_codes=_half_width_codes(cube)[rows],
        )
    return errors.take(np.lexsort((-answers.rms, -answers.worst)))


def _half_width_codes(cube: Cube) -> Array:
    """Return the 8-bit codes (E,) from each entry to the nearest pair of faces of its
    box.
    """
    boxes = cube.data.outside_boxes
    reach = boxes.half_width[:, None]
    lower, upper = cube.data.entry_boxes.faces

    def codes(rgb: Array) -> Array:
        return np.sign(rgb) * cube.encode(np.abs(rgb))

    low = codes(np.concatenate([lower, boxes.rgb - reach]))
    centre = codes(cube.data.atlas.with_outside.rgb)
    high = codes(np.concatenate([upper, boxes.rgb + reach]))
    return np.asarray(np.maximum(high - centre, centre - low).min(axis=1))


@dataclass(frozen=True, eq=False)
class Crowding:
    """Entries of a cube that have another one within a lattice step, largest error of
    the lattice first.
    """

    entries: EntryErrors
    """Errors of the k close entries."""
    nearest: Values
    """(k,) name of the nearest other entry."""
    distances: Array
    """(k,) lattice steps to it, along the axis on which they differ most."""
    lost: list[dict[str, str]]
    """Entries that no colour returns because another one has the same colour."""


def find_crowding(data: CubeData, errors: EntryErrors) -> Crowding:
    """Find the entries that have another one within a lattice step."""
    names = np.array(data.atlas.names, dtype=object)
    nearest, distances = _nearest(data.lattice.to_steps(data.atlas.rgb))
    row_of = {name: row for row, name in enumerate(names)}
    assert errors.lattice is not None
    order = [
        row
        for row in errors.lattice.worst_rows(len(errors.names))
        if distances[row_of.get(errors.names[row], -1)] <= MAX_DISTANCE
    ]
    rows = [row_of[name] for name in errors.names[order]]
    lost = np.flatnonzero(data.atlas.half_width == 0)
    hits = data.entry_boxes.find(data.atlas.rgb[lost])
    return Crowding(
        errors.take(order),
        names[nearest[rows]],
        distances[rows],
        [
            {"name": names[lost[row]], "same_colour": names[other]}
            for row, other in zip(hits.rows, hits.entry, strict=True)
        ],
    )


def _nearest(steps: Array) -> tuple[Indices, Array]:
    """Index of the nearest other row of ``steps`` (n, 3), and its maximum-norm
    distance, infinite for n < 2. A last row stands for entries outside the lattice.
    """
    from scipy.spatial import KDTree

    if len(steps) < 2:
        return np.zeros(len(steps), dtype=np.int64), np.full(len(steps) + 1, np.inf)
    distances, rows = KDTree(steps).query(steps, k=2, p=np.inf)
    # The first of the two is the row itself, unless another has the same colour.
    is_itself = rows[:, 0] == np.arange(len(steps))
    nearest = np.where(is_itself, rows[:, 1], rows[:, 0])
    return nearest, np.append(distances[:, 1], np.inf)


WITHOUT_ATLAS = "without atlas"
JAKOB_HANIKA = "Jakob & Hanika"


def find_alternatives(
    data: CubeData, errors: EntryErrors, lights: Sequence[Light]
) -> dict[str, SpectraComparison]:
    """Compare the answers of other methods at the colours of entries, by the name of
    the method; NaN for colours that it does not answer.
    """
    spectra = {
        WITHOUT_ATLAS: _without_atlas(errors.target, data),
        JAKOB_HANIKA: _sigmoid(data, errors.rgb),
    }
    return {
        name: compare_spectra(errors.target, answers, lights)
        for name, answers in spectra.items()
    }


def _without_atlas(target: Array, data: CubeData) -> Array:
    """Reflectance (E, N) of the packaged cube at the colours of spectra (E, N)."""
    cube = load()
    rgb = on_range(cube.data.sensor, *data.sensor.range).rgb(target)
    inside = in_unit_cube(rgb)
    answers = np.full_like(target, np.nan)
    known = np.clip(rgb[inside], 0, 1)
    answers[inside] = cube.reflectance(known, data.sensor.wavelengths)
    return answers


def _sigmoid(data: CubeData, rgb: Array) -> Array:
    """Reflectance (E, N) of the sigmoid with exactly the colours (E, 3)."""
    model = Sigmoid()
    grey = np.zeros((len(rgb), model.count))
    multipliers = refine_to_rgb(data, model, grey, rgb)
    answers = evaluate(model, multipliers, data.sensor.wavelengths)
    distance = np.abs(data.sensor.rgb(answers) - rgb).max(axis=1)
    return np.where((distance <= data.threshold)[:, None], answers, np.nan)
