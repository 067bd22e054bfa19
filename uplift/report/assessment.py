"""How good a cube is, in numbers: everything that `uplift report` shows, before anybody shows it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas
from uplift.colorimetry.lights import REPORT_LIGHTS
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup import Cube
from uplift.report.calibration import Calibration, calibration
from uplift.report.crowding import Crowding, crowding
from uplift.report.failures import Failures, failures
from uplift.report.fidelity import (
    EntryErrors,
    EntryQuery,
    entries,
    from_other_atlas,
    from_own_atlas,
    from_stored_entries,
)
from uplift.report.round_trip import round_trips
from uplift.report.smoothness import smoothness
from uplift.report.summary import summary
from uplift.viz.histogram import Histogram, histogram, linear_edges, log_edges

EXACT = 1e-9
"""Distances and differences below this are rounding, and stand together in the lowest bin."""
SAME = 1e-4
"""rms difference of reflectance that nobody would call a step."""


@dataclass(frozen=True, eq=False)
class Assessment:
    """A cube judged.

    Parameters
    ----------
    name, size : the cube's file, base name and bytes.
    data, facts : the cube, and what ``uplift info`` tells of it.
    distance : of the lattice points, max |linear RGB|.
    round_trips : ΔE00 of random colours under the cube's illuminant, for each mode of lookup.
    standard_error : of the lattice points, ΔE00 under ``data.error_illuminant``; None where the cube has none.
    smoothness, steepest : rms between neighbouring points, and linear RGB (2, 3) of the two farthest apart.
    lights : what the entries are seen under.
    sources : the files that ``entries`` come from; ``own`` if the cube was built from these.
    entries : None where there is no measured spectrum to judge by.
    delta_e : their ΔE00 under each light, by name.
    outside, absent : entries of ``sources`` that the cube's space does not hold, or a sparse cube has no points for.
    calibration : how far the cube's standard errors hold for ``entries``; None if these are ``own``.
    crowding : of the cube's own entries, None if it has none; errors are against the measured spectra if
        ``own``, against the stored ones if not.
    """

    name: str
    size: int
    data: CubeData
    facts: dict[str, Any]
    failures: Failures
    distance: Histogram
    round_trips: dict[str, Histogram]
    standard_error: Histogram | None
    smoothness: Histogram
    steepest: Array
    lights: tuple[Sensor, ...]
    sources: tuple[str, ...]
    own: bool
    entries: EntryErrors | None
    delta_e: dict[str, Histogram]
    outside: tuple[str, ...]
    absent: tuple[str, ...]
    calibration: Calibration | None
    crowding: Crowding | None


def assess(
    cube: Cube, name: str, size: int, spectra: Atlas | None, lights: Sequence[str] = REPORT_LIGHTS
) -> Assessment:
    """Judge a cube by its own lattice, and by measured spectra if there are any.

    ``spectra`` that the cube was built from (by digest) are its own entries; all others are colours that it
    has not seen. Raises `UnknownNameError` for a light that the tables do not hold.
    """
    data = cube.data
    seen = display_sensors(lights, data.sensor.observer)
    own = spectra is not None and _built_from(data, spectra)
    question = _question(cube, spectra, own)
    found = None if question is None or not question.names else entries(cube, question, seen)
    steps, distances = smoothness(data), data.points.distance[data.points.present]
    errors = None if data.points.standard_error is None else data.points.standard_error[data.points.present]
    return Assessment(
        name=name,
        size=size,
        data=data,
        facts=summary(data),
        failures=failures(data),
        distance=histogram(distances, log_edges(distances, EXACT)),
        round_trips=_together(round_trips(cube), lambda values: log_edges(values, EXACT)),
        standard_error=None if errors is None else histogram(errors, linear_edges(errors)),
        smoothness=histogram(steps.differences, log_edges(steps.differences, SAME)),
        steepest=steps.steepest,
        lights=seen,
        sources=() if spectra is None else tuple(source.name for source in spectra.sources),
        own=own,
        entries=found,
        delta_e={} if found is None else _together(_by_light(found, seen), linear_edges),
        outside=() if question is None else question.outside,
        absent=() if question is None else question.absent,
        calibration=None if own or found is None else calibration(found.real, found.stated),
        crowding=_crowding(cube, found if own else None, seen),
    )


def _built_from(data: CubeData, spectra: Atlas) -> bool:
    """Whether the cube says that it was built from these very files."""
    recorded = {str(source.get("digest")) for source in data.provenance.get("atlases", ())}
    given = {source.digest for source in spectra.sources}
    return bool(given) and given <= recorded


def _question(cube: Cube, spectra: Atlas | None, own: bool) -> EntryQuery | None:
    if spectra is None or not spectra.entries:
        return None
    return (from_own_atlas(cube.data, spectra) if own else from_other_atlas(cube.data, spectra)).to(cube)


def _crowding(cube: Cube, measured: EntryErrors | None, lights: tuple[Sensor, ...]) -> Crowding | None:
    stored = from_stored_entries(cube.data).to(cube)
    if not stored.names:
        return None
    return crowding(cube.data, entries(cube, stored, lights) if measured is None else measured)


def _by_light(found: EntryErrors, lights: tuple[Sensor, ...]) -> dict[str, Array]:
    return {seen.illuminant: found.delta_e[:, column] for column, seen in enumerate(lights)}


def _together(values: dict[str, Array], edges: Callable[[Array], Array]) -> dict[str, Histogram]:
    """Distributions over the same edges, so that the eye can compare them."""
    shared = edges(np.concatenate(list(values.values())))
    return {name: histogram(array, shared) for name, array in values.items()}
