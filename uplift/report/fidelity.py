"""What a cube answers, beside what was measured: the error of every atlas entry, and of colours at random."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Spectra, resample
from uplift.cube import CubeData
from uplift.difference import colours_apart, spectra_apart
from uplift.lattice import Indices, Status
from uplift.lookup import MODES, Cube
from uplift.models import reflectance
from uplift.sensor import Array, Sensor

COLOURS = 4096
SEED = 20200617
"""Of the random colours: the same for every report, so that reports compare."""


@dataclass(frozen=True, eq=False)
class Question:
    """Colours to ask a cube for, and the spectra that would be the best answers.

    Parameters
    ----------
    names : (E) of the entries.
    rgb : (E, 3) linear, within [0, 1].
    wanted : (E, N) reflectances on the sensor's wavelengths.
    rows : (E,) of the cube's own atlas table; None for entries that it was not built from.
    outside : names of the entries that the cube's space does not hold.
    """

    names: tuple[str, ...]
    rgb: Array
    wanted: Array
    rows: Indices | None
    outside: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Entries:
    """E entries asked at their own RGB, worst first: by the largest ΔE00 under any of L lights.

    Parameters
    ----------
    wanted, answered, stored : (E, N) reflectances: as measured, as the cube answers, and as its atlas table
        has the entry; None where it has none.
    delta_e : (E, L) ΔE00 of ``answered`` against ``wanted``.
    delta_e_stored : (E, L) ΔE00 of ``stored`` against ``wanted``: what no lookup could better.
    rms, rms_stored : (E,) rms over wavelength of ``answered`` against ``wanted``, and against ``stored``.
    own : (E,) trilinear weight, 0 to 1, of the voxel's corners that are based on the entry itself.
    cells : (E, 3) lowest corner of the voxel, as a position along the axes.
    corners : (E, S) how many of the voxel's corners have each `Status`.
    """

    names: tuple[str, ...]
    rgb: Array
    wanted: Array
    answered: Array
    stored: Array | None
    delta_e: Array
    delta_e_stored: Array | None
    rms: Array
    rms_stored: Array | None
    own: Array | None
    cells: Indices
    corners: Indices

    @property
    def worst(self) -> Array:
        """(E,) largest ΔE00 under any light."""
        return self.delta_e.max(axis=1)

    def take(self, rows: ArrayLike) -> Entries:
        """The entries of rows (k,), in that order."""
        order = np.asarray(rows, dtype=np.int64)
        changed: dict[str, Any] = {
            field.name: value[order]
            for field in fields(self)
            if isinstance(value := getattr(self, field.name), np.ndarray)
        }
        return replace(self, names=tuple(self.names[row] for row in order), **changed)


def about_own(data: CubeData, spectra: Spectra) -> Question:
    """The entries that the cube is constrained by, with their measured spectra."""
    measured = resample(spectra, data.sensor.wavelengths).values
    place = {name: row for row, name in enumerate(data.atlas.names)}
    kept = [row for row, name in enumerate(spectra.names) if name in place]
    rows = np.array([place[spectra.names[row]] for row in kept], dtype=np.int64)
    outside = tuple(name for name in spectra.names if name not in place)
    return Question(
        tuple(spectra.names[row] for row in kept), data.atlas.rgb[rows], measured[kept], rows, outside
    )


def about_other(data: CubeData, spectra: Spectra) -> Question:
    """Entries that the cube was not built from, those that its space holds."""
    measured = resample(spectra, data.sensor.wavelengths).values
    rgb = data.sensor.rgb(measured)
    inside = data.sensor.holds(rgb)
    names = [
        tuple(name for name, held in zip(spectra.names, inside, strict=True) if held == wanted)
        for wanted in (True, False)
    ]
    return Question(names[0], np.clip(rgb[inside], 0, 1), measured[inside], None, names[1])


def about_stored(data: CubeData) -> Question:
    """The cube's own entries where nobody has the measurements: their stored spectra stand in."""
    atlas = data.atlas
    spectra = reflectance(data.model, atlas.coefficients, data.sensor.wavelengths)
    return Question(atlas.names, atlas.rgb, spectra, np.arange(len(atlas.names)))


def entries(cube: Cube, question: Question, lights: tuple[Sensor, ...]) -> Entries:
    """The errors of a cube, asked in its default mode. ``question`` has one entry at least."""
    data, wanted, rows = cube.data, question.wanted, question.rows
    points, weights = data.lattice.corners(question.rgb)
    cells, _ = data.lattice.cell(question.rgb)
    answered = cube.reflectance(question.rgb)
    stored = own = None
    if rows is not None:
        stored = reflectance(data.model, data.atlas.coefficients[rows], data.sensor.wavelengths)
        own = (weights * (data.entry[points] == rows[:, None])).sum(axis=1)
    found = Entries(
        names=question.names,
        rgb=question.rgb,
        wanted=wanted,
        answered=answered,
        stored=stored,
        delta_e=_under(lights, answered, wanted),
        delta_e_stored=None if stored is None else _under(lights, stored, wanted),
        rms=_rms(answered, wanted),
        rms_stored=None if stored is None else _rms(answered, stored),
        own=own,
        cells=cells,
        corners=np.stack([(data.status[points] == status).sum(axis=1) for status in Status], axis=1),
    )
    return found.take(np.lexsort((-found.rms, -found.worst)))


def round_trips(cube: Cube) -> dict[str, Array]:
    """ΔE00 (n,) under the cube's illuminant between random linear RGB and what comes back, for each mode."""
    asked = np.random.default_rng(SEED).random((COLOURS, 3))
    sensor = cube.data.sensor
    return {
        mode: colours_apart(sensor, asked, sensor.rgb(cube.reflectance(asked, mode=mode))) for mode in MODES
    }


def _under(lights: tuple[Sensor, ...], first: Array, second: Array) -> Array:
    return np.stack([spectra_apart(seen.light, first, second) for seen in lights], axis=1)


def _rms(first: Array, second: Array) -> Array:
    return np.sqrt(((first - second) ** 2).mean(axis=1))
