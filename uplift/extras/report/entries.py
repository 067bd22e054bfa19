"""Errors of a cube at the colours of atlas entries, next to those of other methods."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.gamut import map_to_gamut
from uplift.colorimetry.observer import light, on_range
from uplift.colorimetry.sensor import Light, in_unit_cube
from uplift.common.arrays import Array, Indices
from uplift.cube.data import CubeData
from uplift.extras.colour.outside import MAPPING, reflectance_anywhere
from uplift.extras.report.comparison import SpectraComparison, compare_spectra
from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import lattice_spectra
from uplift.lookup.refine import refine_to_rgb
from uplift.models.model import evaluate
from uplift.models.sigmoid import Sigmoid


@dataclass(frozen=True, eq=False)
class Rows:
    """A table of entries, whose fields have a row for each of them, or are None."""

    names: tuple[str, ...]
    """Names of E entries."""
    rgb: Array
    """(E, 3) linear RGB, outside [0, 1] for the cube's entries outside its space."""

    def take(self, rows: ArrayLike) -> Self:
        """Select rows (k,)."""
        order = np.asarray(rows, dtype=np.int64)
        taken: dict[str, Any] = {"names": tuple(self.names[row] for row in order)}
        for field in fields(self)[1:]:
            value = getattr(self, field.name)
            if isinstance(value, SpectraComparison):
                taken[field.name] = value.take(order)
            elif value is not None:
                taken[field.name] = value[order]
        return replace(self, **taken)


@dataclass(frozen=True, eq=False)
class Entries(Rows):
    """Colours to query, and the spectra that would be the best answers."""

    target: Array
    """(E, N) reflectances at the wavelengths of the cube."""
    rows: Indices | None = None
    """(E,) rows in the table of all entries of the cube; None for other entries."""


@dataclass(frozen=True, eq=False)
class EntryErrors(Rows):
    """Errors of E entries at their own RGB, worst first: by the largest ΔE00 under any
    of L lights.
    """

    answers: SpectraComparison
    """Answers of the cube, with the spectra as measured or, without measurements, as
    stored.
    """
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
    wavelengths = data.sensor.wavelengths
    if atlas is None:
        rows = np.arange(len(table.names))
        return Entries(
            table.names, table.rgb, table.spectra.reflectance(rows, wavelengths), rows
        )
    row_of = {name: row for row, name in enumerate(table.names)}
    known = [row for row, name in enumerate(atlas.names) if name in row_of]
    names = tuple(atlas.names[row] for row in known)
    rows = np.array([row_of[name] for name in names], dtype=np.int64)
    return Entries(
        names, table.rgb[rows], resample(atlas, wavelengths).values[known], rows
    )


def other_entries(data: CubeData, atlas: Atlas) -> Entries:
    """Query entries that the cube was not built from, as far as they lie in its RGB
    space.
    """
    measured = resample(atlas, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    entries = Entries(atlas.names, np.clip(rgb, 0, 1), measured)
    return entries.take(np.flatnonzero(in_unit_cube(rgb)))


def entry_errors(
    cube: Cube, entries: Entries, lights: Sequence[Light]
) -> EntryErrors | None:
    """Compare the answers of a cube in its default mode with the best ones; None if a
    sparse cube has no nodes for any of the entries.
    """
    data = cube.data
    entries = entries.take(np.flatnonzero(cube.covers(_inside(data, entries.rgb))))
    if not entries.names:
        return None
    inside = _inside(data, entries.rgb)
    spectra = reflectance_anywhere(
        data,
        entries.rgb,
        data.sensor.wavelengths,
        "spectra",
        ~in_unit_cube(entries.rgb),
    )
    reference = light(data.error_illuminant, data.sensor.observer, *data.sensor.range)
    answers = compare_spectra(entries.target, spectra, lights)
    errors = EntryErrors(
        entries.names,
        entries.rgb,
        answers,
        delta_e_spectra(reference, spectra, entries.target),
        cube.standard_error(inside),
        data.lattice.cell(inside)[0],
    )
    if entries.rows is not None:
        errors = _with_lattice_errors(cube, errors, entries.rows, lights)
    return errors.take(np.lexsort((-answers.rms, -answers.worst)))


def _with_lattice_errors(
    cube: Cube, errors: EntryErrors, rows: Indices, lights: Sequence[Light]
) -> EntryErrors:
    """Add the fields that only the cube's own entries have; ``rows`` (E,) are those of
    all its entries.
    """
    data = cube.data
    table = data.atlas.with_outside
    inside = _inside(data, errors.rgb)
    lattice = lattice_spectra(
        data.model, data.lattice, data.points, inside, data.sensor.wavelengths
    )
    predicted = errors.predicted
    if predicted is not None:
        is_outside = rows >= len(data.atlas.names)
        predicted = np.where(is_outside, table.error[rows], predicted)
    return replace(
        errors,
        lattice=compare_spectra(errors.answers.expected, lattice, lights),
        predicted=predicted,
        half_width=table.half_width[rows],
        half_width_codes=_half_width_codes(cube)[rows],
    )


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


def _inside(data: CubeData, rgb: Array) -> Array:
    """Colours (n, 3) of the lattice from which those outside the RGB space are
    answered; others are unchanged.
    """
    return map_to_gamut(rgb, data.sensor, MAPPING).rgb


WITHOUT_ATLAS = "without atlas"
JAKOB_HANIKA = "Jakob & Hanika"


def find_alternatives(
    data: CubeData, errors: EntryErrors, lights: Sequence[Light]
) -> dict[str, SpectraComparison]:
    """Compare the answers of other methods at the colours of entries, by the name of
    the method; NaN for colours that it does not answer.
    """
    target = errors.answers.expected
    spectra = {
        WITHOUT_ATLAS: _without_atlas(target, data),
        JAKOB_HANIKA: _sigmoid(data, errors.rgb),
    }
    return {
        name: compare_spectra(target, answers, lights)
        for name, answers in spectra.items()
    }


def _without_atlas(target: Array, data: CubeData) -> Array:
    """Reflectance (E, N) of the packaged cube at the colours of spectra (E, N)."""
    cube = load()
    rgb = on_range(cube.data.sensor, *data.sensor.range).rgb(target)
    inside = in_unit_cube(rgb)
    answers = np.full_like(target, np.nan)
    answers[inside] = cube.reflectance(
        np.clip(rgb[inside], 0, 1), data.sensor.wavelengths
    )
    return answers


def _sigmoid(data: CubeData, rgb: Array) -> Array:
    """Reflectance (E, N) of the sigmoid with exactly the colours (E, 3)."""
    model = Sigmoid()
    multipliers = refine_to_rgb(data, model, np.zeros((len(rgb), model.count)), rgb)
    answers = evaluate(model, multipliers, data.sensor.wavelengths)
    distance = np.abs(data.sensor.rgb(answers) - rgb).max(axis=1)
    return np.where((distance <= data.threshold)[:, None], answers, np.nan)
