"""Quality of a cube: errors of its lattice, of random colours and of atlas entries."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas
from uplift.colorimetry import Sensor
from uplift.colorimetry.lights import REPORT_LIGHTS, Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.common.arrays import Array
from uplift.cube import CubeData, summarise
from uplift.extras.report import fidelity, measures
from uplift.extras.report.charts import (
    Histogram,
    linear_edges,
    log_edges,
    make_histogram,
)
from uplift.extras.report.fidelity import Answers, Crowding, EntryErrors
from uplift.extras.report.measures import Calibration, check_calibration
from uplift.lookup import Cube

# smaller distances and ΔE00 are rounding errors and are counted in the lowest bin
MIN_ERROR = 1e-9
MIN_STEP = 1e-4  # smaller rms differences of reflectance are counted in the lowest bin


@dataclass(frozen=True, eq=False)
class Assessment:
    """Quality of one cube."""

    name: str  # Base name of the cube's file
    size: int  # Bytes of the file
    data: CubeData  # The cube
    facts: dict[str, Any]  # The result of `summarise`
    failures: dict[
        str, Any
    ]  # Nodes over the threshold and missing entries: `collect_failures`
    distance: Histogram  # Fitting distance of the nodes, max |linear RGB|
    round_trips: dict[
        str, Histogram
    ]  # ΔE00 of random colours under the cube's illuminant, by mode of lookup
    # Standard errors of the nodes, ΔE00 under ``data.error_illuminant``; None if the
    # cube has none
    standard_error: Histogram | None
    smoothness: Histogram  # rms difference of reflectance between neighbouring nodes
    steepest: Array  # (2, 3) Linear RGB of the two neighbours that differ most
    lights: tuple[
        Sensor, ...
    ]  # Display sensors of the lights under which entries are compared
    sources: tuple[str, ...]  # Names of the files that the measured spectra come from
    own: bool  # Whether the cube was built from these files
    entries: (
        EntryErrors | None
    )  # Errors of the entries; None without a measured spectrum to compare with
    alternatives: dict[
        str, Answers
    ]  # Those of other methods at the colours of ``entries``; empty without entries
    delta_e: dict[str, Histogram]  # ΔE00 of the entries by name of the light
    out_of_gamut: tuple[str, ...]  # Entries of ``sources`` outside the cube's RGB space
    not_covered: tuple[
        str, ...
    ]  # Entries of ``sources`` for which a sparse cube has no nodes
    # Actual against predicted errors; None if the cube was built from the entries or
    # has no standard errors
    calibration: Calibration | None
    # The same under the other of ``lights``, by their names; empty without
    # ``calibration``, and for cubes of earlier versions
    light_calibrations: dict[str, Calibration]
    # Share of the entries whose colours are unlike those of the cube's atlas; 0 without
    # ``calibration``
    unlike: float
    # Close entries of the cube, None if it has no entries. Errors are relative to the
    # measured spectra if ``own``, otherwise relative to the stored ones
    crowding: Crowding | None


def assess(
    cube: Cube,
    name: str,
    size: int,
    atlas: Atlas | None,
    lights: Sequence[Illuminant] = REPORT_LIGHTS,
) -> Assessment:
    """Assess a cube by its own lattice and, if given, by measured spectra."""
    data = cube.data
    sensors = display_sensors(lights, data.sensor.observer, *data.sensor.range)
    own = atlas is not None and _built_from(data, atlas)
    in_gamut: tuple[str, ...] = ()
    errors = None
    if atlas is not None and atlas.entries:
        query = (
            fidelity.from_own_atlas(data, atlas)
            if own
            else fidelity.from_other_atlas(data, atlas)
        )
        in_gamut = query.names
        query = query.answerable_by(cube)
        errors = fidelity.entry_errors(cube, query, sensors) if query.names else None
    unseen = None if own else errors
    calibration = None
    if unseen is not None:
        calibration = check_calibration(
            unseen.actual, unseen.predicted, cube.error_bound(unseen.rgb)
        )
    points, (differences, steepest) = data.points, measures.compute_smoothness(data)
    distances = points.distance[points.present]
    standard_errors = (
        None if points.standard_error is None else points.standard_error[points.present]
    )
    return Assessment(
        name=name,
        size=size,
        data=data,
        facts=summarise(data),
        failures=measures.collect_failures(data),
        distance=make_histogram(distances, log_edges(distances, MIN_ERROR)),
        round_trips=_comparable(
            measures.round_trip_errors(cube),
            lambda values: log_edges(values, MIN_ERROR),
        ),
        standard_error=None
        if standard_errors is None
        else make_histogram(standard_errors, linear_edges(standard_errors)),
        smoothness=make_histogram(differences, log_edges(differences, MIN_STEP)),
        steepest=steepest,
        lights=sensors,
        sources=() if atlas is None else tuple(source.name for source in atlas.sources),
        own=own,
        entries=errors,
        alternatives={}
        if errors is None
        else fidelity.find_alternatives(data, errors, sensors),
        delta_e={}
        if errors is None
        else _comparable(_by_light(errors, sensors), linear_edges),
        out_of_gamut=() if atlas is None else _missing(atlas.names, in_gamut),
        not_covered=_missing(in_gamut, () if errors is None else errors.names),
        calibration=calibration,
        light_calibrations=_light_calibrations(cube, unseen, sensors)
        if unseen and calibration
        else {},
        unlike=float(cube.unlike_atlas(unseen.rgb).mean())
        if unseen and calibration
        else 0.0,
        crowding=_crowding(cube, errors if own else None, sensors),
    )


def _missing(names: Sequence[str], present: Sequence[str]) -> tuple[str, ...]:
    found = set(present)
    return tuple(name for name in names if name not in found)


def _light_calibrations(
    cube: Cube, errors: EntryErrors, lights: tuple[Sensor, ...]
) -> dict[str, Calibration]:
    """Calibrations under lights other than that of `Assessment.calibration`, and that
    of the build.
    """
    data = cube.data
    if data.atlas.left_out is None:
        return {}
    found = {}
    for light, actual in _by_light(errors, lights).items():
        if light not in (data.error_illuminant, data.sensor.illuminant):
            predicted = cube.standard_error(errors.rgb, light)
            bound = cube.error_bound(errors.rgb, light)
            found[light] = check_calibration(actual, predicted, bound)
    return {light: each for light, each in found.items() if each is not None}


def _built_from(data: CubeData, atlas: Atlas) -> bool:
    """Return whether the cube records the digests of all files of the atlas."""
    recorded = {
        str(source.get("digest")) for source in data.provenance.get("atlases", ())
    }
    given = {source.digest for source in atlas.sources}
    return bool(given) and given <= recorded


def _crowding(
    cube: Cube, measured: EntryErrors | None, lights: tuple[Sensor, ...]
) -> Crowding | None:
    stored = fidelity.from_stored_entries(cube.data).answerable_by(cube)
    if not stored.names:
        return None
    return fidelity.find_crowding(
        cube.data, measured or fidelity.entry_errors(cube, stored, lights)
    )


def _by_light(errors: EntryErrors, lights: tuple[Sensor, ...]) -> dict[str, Array]:
    return {
        sensor.illuminant: errors.answers.delta_e[:, column]
        for column, sensor in enumerate(lights)
    }


def _comparable(
    values: dict[str, Array], edges: Callable[[Array], Array]
) -> dict[str, Histogram]:
    """Histograms with common edges."""
    common = edges(np.concatenate(list(values.values())))
    return {name: make_histogram(array, common) for name, array in values.items()}
