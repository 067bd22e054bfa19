"""Quality of a cube: errors of its lattice, of random colours and of atlas entries."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.cube.file import summarise
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.report import fidelity, measures
from uplift.extras.report.charts import (
    Histogram,
    linear_edges,
    log_edges,
    make_histogram,
)
from uplift.extras.report.crowding import Crowding, find_crowding
from uplift.extras.report.fidelity import Answers, EntryErrors
from uplift.extras.report.measures import Calibration, check_calibration
from uplift.lookup.cube import Cube

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
    # Nodes over the threshold and missing entries: `collect_failures`
    failures: dict[str, Any]
    distance: Histogram  # Fitting distance of the nodes, max |linear RGB|
    # ΔE00 of random colours under the cube's illuminant, by mode of lookup
    round_trips: dict[str, Histogram]
    # Standard errors of the nodes, ΔE00 under ``data.error_illuminant``; None if the
    # cube has none
    standard_error: Histogram | None
    smoothness: Histogram  # rms difference of reflectance between neighbouring nodes
    steepest: Array  # (2, 3) Linear RGB of the two neighbours that differ most
    # Display sensors of the lights under which entries are compared
    lights: tuple[Sensor, ...]
    sources: tuple[str, ...]  # Names of the files that the measured spectra come from
    own: bool  # Whether the cube was built from these files
    # Errors of the entries; None without a measured spectrum to compare with
    entries: EntryErrors | None
    # Those of other methods at the colours of ``entries``; empty without entries
    alternatives: dict[str, Answers]
    delta_e: dict[str, Histogram]  # ΔE00 of the entries by name of the light
    out_of_gamut: tuple[str, ...]  # Entries of ``sources`` outside the cube's RGB space
    # Entries of ``sources`` for which a sparse cube has no nodes
    not_covered: tuple[str, ...]
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
    atlas = Atlas() if atlas is None else atlas
    is_own = _built_from(data, atlas)
    in_gamut, errors = _measured_errors(cube, atlas, sensors, is_own=is_own)
    unseen = None if is_own else errors
    calibration = _calibration(cube, unseen)
    calibrated = None if calibration is None else unseen
    differences, steepest = measures.compute_smoothness(data)
    distances = data.points.distance[data.points.present]
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
        standard_error=_standard_errors(cube),
        smoothness=make_histogram(differences, log_edges(differences, MIN_STEP)),
        steepest=steepest,
        lights=sensors,
        sources=tuple(source.name for source in atlas.sources),
        own=is_own,
        entries=errors,
        alternatives={}
        if errors is None
        else fidelity.find_alternatives(data, errors, sensors),
        delta_e={}
        if errors is None
        else _comparable(_by_light(errors, sensors), linear_edges),
        out_of_gamut=_missing(atlas.names, in_gamut),
        not_covered=_missing(in_gamut, () if errors is None else errors.names),
        calibration=calibration,
        light_calibrations=_light_calibrations(cube, calibrated, sensors),
        unlike=0.0
        if calibrated is None
        else float(cube.unlike_atlas(calibrated.rgb).mean()),
        crowding=_crowding(cube, errors if is_own else None, sensors),
    )


def _measured_errors(
    cube: Cube, atlas: Atlas, lights: tuple[Sensor, ...], *, is_own: bool
) -> tuple[tuple[str, ...], EntryErrors | None]:
    """Names of the entries inside the RGB space, and errors of those with an answer."""
    if not atlas.entries:
        return (), None
    read = fidelity.from_own_atlas if is_own else fidelity.from_other_atlas
    query = read(cube.data, atlas)
    answerable = query.answerable_by(cube)
    if not answerable.names:
        return query.names, None
    return query.names, fidelity.entry_errors(cube, answerable, lights)


def _calibration(cube: Cube, unseen: EntryErrors | None) -> Calibration | None:
    if unseen is None:
        return None
    bound = cube.error_bound(unseen.rgb)
    return check_calibration(unseen.actual, unseen.predicted, bound)


def _standard_errors(cube: Cube) -> Histogram | None:
    data = cube.data
    errors = cube.standard_error(data.lattice.points[data.points.present])
    return None if errors is None else make_histogram(errors, linear_edges(errors))


def _missing(names: Sequence[str], present: Sequence[str]) -> tuple[str, ...]:
    known = set(present)
    return tuple(name for name in names if name not in known)


def _light_calibrations(
    cube: Cube, errors: EntryErrors | None, lights: tuple[Sensor, ...]
) -> dict[str, Calibration]:
    """Calibrations under lights other than that of `Assessment.calibration`, and that
    of the build.
    """
    data = cube.data
    if errors is None or data.atlas.left_out is None:
        return {}
    calibrations = {}
    for light, actual in _by_light(errors, lights).items():
        if light not in (data.error_illuminant, data.sensor.illuminant):
            predicted = cube.standard_error(errors.rgb, light)
            bound = cube.error_bound(errors.rgb, light)
            calibration = check_calibration(actual, predicted, bound)
            if calibration is not None:
                calibrations[light] = calibration
    return calibrations


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
    return find_crowding(
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
