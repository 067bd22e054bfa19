"""Methods × materials × lights: errors of methods of spectral upsampling at measured
materials, as rows.

A method is prepared for a task: materials that it may know, and materials whose colours
it is queried for. Its answers are compared with the measurements under lights. Errors
at several tasks are pooled; `Errors.rows` summarises them.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any, Protocol

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import resample
from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Light, Sensor, in_unit_cube
from uplift.common.arrays import Array, Indices
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.comparison import compare_spectra, mean_p95_max
from uplift.extras.report.measures import check_calibration
from uplift.fit.families import shipped_library

ALL_LIGHTS = "all"
"""Light of a row that pools all lights."""
DELTA_E = "ΔE00"
RMS = "rms"
Row = dict[str, Any]


@dataclass(frozen=True, eq=False)
class Task:
    """Materials that a method may know, and materials that it is queried for.

    ``known``: measured entries. ``queried`` (n, N): reflectances whose colours are
    within the space of the sensor. ``left_out``: families of the shipped library that
    no method may know. ``builds``: builds of each cube, of which the last is timed.
    """

    sensor: Sensor
    known: Atlas
    queried: Array
    left_out: tuple[str, ...] = ()
    builds: int = 1

    @property
    def rgb(self) -> Array:
        """Return the linear RGB (n, 3) of the queries."""
        return np.clip(self.sensor.rgb(self.queried), 0, 1)

    @cached_property
    def known_spectra(self) -> Array:
        """Return the known reflectances (k, N) within the space."""
        return spectra_of(within(self.known, self.sensor), self.sensor)

    @cached_property
    def library(self) -> Array:
        """Return the reflectances (E, 81) of the families that are not left out."""
        families = shipped_library(self.left_out)
        return np.concatenate(
            [np.zeros((0, 81)), *(each.measured for each in families)]
        )


Known = Callable[[Task], Array]
KNOWN: Known = attrgetter("known_spectra")
LIBRARY: Known = attrgetter("library")
"""What a method may know of a task."""


class Prepared(Protocol):
    """A method that is ready to be queried."""

    def errors(self, task: Task, lights: Sequence[Light]) -> "Errors":
        """Compare the answers for the materials of a task with the measurements."""


Prepare = Callable[[Task], Prepared]


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors at n materials.

    ``delta_e`` (n, L): ΔE00 under each light. ``rms`` (n,): rms difference of the
    spectra, None of methods without spectra. ``stated`` (n, L, 2): standard errors and
    error bounds that the method states, if it does.
    """

    delta_e: Array
    rms: Array | None = None
    stated: Array | None = None

    def calibration(self, number: int) -> dict[str, float]:
        """Compare the errors under a light, by its number, with the stated ones."""
        if self.stated is None:
            return {}
        return check_calibration(self.delta_e[:, number], self.stated[:, number])

    def rows(self, lights: Iterable[str], **labels: Any) -> Iterator[Row]:
        """Yield a row of the ΔE00 under each light, of all lights, and of the rms."""
        for number, light in enumerate(lights):
            row = _row(self.delta_e[:, number], light, DELTA_E, labels)
            yield row | self.calibration(number)
        yield _row(self.delta_e, ALL_LIGHTS, DELTA_E, labels)
        if self.rms is not None:
            yield _row(self.rms, ALL_LIGHTS, RMS, labels)


def _row(values: Array, light: str, measure: str, labels: Row) -> Row:
    size = {"light": light, "measure": measure, "n": len(values)}
    return {**labels, **size, **mean_p95_max(values)}


def spectrum_errors(
    predicted: Array, measured: Array, lights: Sequence[Light]
) -> Errors:
    """Compare predicted with measured reflectances (n, N)."""
    found = compare_spectra(measured, predicted, lights)
    return Errors(found.delta_e, found.rms)


def join(parts: Sequence[Errors]) -> Errors:
    """Pool errors; what one part lacks is left out."""

    def joined(name: str) -> Any:
        arrays = [getattr(part, name) for part in parts]
        is_known = all(array is not None for array in arrays)
        return np.concatenate(arrays) if is_known else None

    return Errors(joined("delta_e"), joined("rms"), joined("stated"))


def pooled_errors(
    prepare: Prepare, tasks: Iterable[Task], lights: Sequence[Light]
) -> Errors:
    """Return the errors of a method at the materials of all tasks."""
    return join([prepare(task).errors(task, lights) for task in tasks])


def named_lights(names: Sequence[str] = HELD_OUT_LIGHTS) -> dict[str, Light]:
    """Return lights of the default observer by their names."""
    return {name: observer.light(name) for name in names}


def measure(
    methods: Mapping[str, Prepare],
    tasks: Sequence[Task],
    lights: Mapping[str, Light],
    **labels: Any,
) -> Iterator[Row]:
    """Yield the rows of methods at tasks, with ``labels`` such as the set."""
    for name, prepare in methods.items():
        errors = pooled_errors(prepare, tasks, list(lights.values()))
        yield from errors.rows(lights, method=name, **labels)


def spectra_of(atlas: Atlas, sensor: Sensor) -> Array:
    """Return the reflectances (n, N) of entries at the wavelengths of a sensor."""
    return resample(atlas, sensor.wavelengths).values


def within(atlas: Atlas, sensor: Sensor) -> Atlas:
    """Keep the entries whose RGB are in [0, 1]."""
    inside = in_unit_cube(sensor.rgb(spectra_of(atlas, sensor)))
    return select(atlas, np.flatnonzero(inside))


def select(atlas: Atlas, rows: Indices) -> Atlas:
    """Select entries by their numbers."""
    return Atlas(tuple(atlas.entries[row] for row in rows), (), atlas.sources)


def divided(
    entries: Atlas,
    left_out: tuple[str, ...],
    sensor: Sensor,
    parts: int = 2,
    seeds: int = 3,
) -> Iterator[Task]:
    """Query each part of entries, divided at random, where the others are known."""
    spectra = spectra_of(entries, sensor)
    for known, queried in folds(len(entries), parts, seeds):
        yield Task(sensor, select(entries, known), spectra[queried], left_out)


def folds(
    count: int, parts: int = 2, seeds: int = 3
) -> Iterator[tuple[Indices, Indices]]:
    """Yield known and queried numbers up to ``count``: each is queried once a seed."""
    for seed in range(seeds):
        shuffled = np.random.default_rng(seed).permutation(count)
        blocks = np.array_split(shuffled, parts)
        for queried in reversed(range(parts)):
            known = [block for number, block in enumerate(blocks) if number != queried]
            yield np.concatenate(known), blocks[queried]
