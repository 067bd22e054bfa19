"""Quality of a cube: errors of its lattice, of random colours and of atlas entries."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic_core import to_jsonable_python

from uplift.atlas.atlas import Atlas
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.cube.file import summarise
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.report import measures
from uplift.extras.report.charts import (
    Histogram,
    linear_edges,
    log_edges,
    make_histogram,
)
from uplift.extras.report.comparison import SpectraComparison
from uplift.extras.report.entries import (
    EntryErrors,
    entry_errors,
    find_alternatives,
    find_crowding,
    other_entries,
    own_entries,
)
from uplift.extras.report.measures import check_calibration
from uplift.lookup.cube import Cube, expected_errors

MIN_ERROR = 1e-9
"""Smaller distances and ΔE00 are rounding errors and are counted in the lowest bin."""
MIN_STEP = 1e-4
"""Smaller rms differences of reflectance are counted in the lowest bin."""


@dataclass(frozen=True, eq=False)
class Assessment:
    """Quality of one cube: values for JSON, where numbers that are not finite are None,
    and the spectra that they summarise.
    """

    data: CubeData
    lights: tuple[Sensor, ...]
    """Display sensors of the lights under which entries are compared."""
    values: dict[str, Any]
    entries: EntryErrors | None
    """Errors of the entries; None without a measured spectrum to compare with."""
    alternatives: dict[str, SpectraComparison]
    """Those of other methods at the colours of ``entries``; empty without entries."""


def assess(
    cube: Cube,
    name: str,
    size: int,
    atlas: Atlas | None,
    lights: Sequence[Illuminant] = REPORT_LIGHTS,
) -> Assessment:
    """Assess a cube by its own lattice and, if given, by measured spectra.

    ``name`` and ``size`` in bytes are those of its file.
    """
    data = cube.data
    atlas = atlas or Atlas()
    sensors = display_sensors(lights, data.sensor.observer, *data.sensor.range)
    under = [sensor.light for sensor in sensors]
    is_own = _built_from(data, atlas)
    entries = None
    within: Sequence[str] = ()
    if atlas.entries:
        queried = (own_entries if is_own else other_entries)(data, atlas)
        within = queried.names.tolist()
        entries = entry_errors(cube, queried, under)
    alternatives = {}
    delta_e = {}
    if entries is not None:
        alternatives = find_alternatives(data, entries, under)
        columns = zip(entries.answers.lights, entries.answers.delta_e.T, strict=True)
        delta_e = _comparable(dict(columns), linear_edges)
    close = entries if is_own else None
    if close is None:
        close = entry_errors(cube, own_entries(data), under)
    facts = summarise(data)
    distances = data.points.distance[data.points.present]
    round_trips = measures.round_trip_errors(cube)
    steps, steepest = measures.compute_smoothness(data)
    smoothness = make_histogram(steps, log_edges(steps, MIN_STEP))
    values = {
        "cube": name,
        "bytes": size,
        "build": facts,
        "failures": {"status": facts["status"], **measures.collect_failures(data)},
        "fitting_distance": make_histogram(distances, log_edges(distances, MIN_ERROR)),
        "round_trip": {
            "colours": len(round_trips["spectra"]),
            "seed": measures.SEED,
            "illuminant": data.sensor.illuminant,
            "delta_e_2000": _comparable(
                round_trips, lambda errors: log_edges(errors, MIN_ERROR)
            ),
        },
        "standard_error": _standard_errors(cube, None if is_own else entries),
        "smoothness": smoothness | {"steepest": steepest},
        "lights": [sensor.illuminant for sensor in sensors],
        "atlas": {
            "files": [source.name for source in atlas.sources],
            "own": is_own,
            "outside": _missing(atlas.names, within),
            "absent": _missing(
                within, () if entries is None else entries.names.tolist()
            ),
        },
        "delta_e_2000": delta_e,
        "entries": _records(entries, sensors),
        "alternatives": [
            {"name": method, "delta_e_2000": _by_light(errors)}
            for method, errors in alternatives.items()
        ],
        "crowding": None if close is None else _crowding(data, close, sensors, is_own),
    }
    json = to_jsonable_python(
        values, inf_nan_mode="null", fallback=lambda array: array.tolist()
    )
    return Assessment(data, sensors, json, entries, alternatives)


def _built_from(data: CubeData, atlas: Atlas) -> bool:
    """Return whether the cube records the digests of all files of the atlas."""
    recorded = data.provenance.get("atlases", ())
    digests = {str(source.get("digest")) for source in recorded}
    given = {source.digest for source in atlas.sources}
    return bool(given) and given <= digests


def _missing(names: Sequence[str], present: Sequence[str]) -> list[str]:
    known = set(present)
    return [name for name in names if name not in known]


def _comparable(
    values: Mapping[str, Array], edges: Callable[[Array], Array]
) -> dict[str, Histogram]:
    """Histograms with common edges."""
    common = edges(np.concatenate(list(values.values())))
    return {name: make_histogram(array, common) for name, array in values.items()}


def _standard_errors(cube: Cube, unseen: EntryErrors | None) -> dict[str, Any]:
    """Standard errors of the nodes that lookups reach, and how they hold for entries
    that the cube does not know.
    """
    data = cube.data
    nodes = data.lattice.points[data.points.present]
    errors = cube.standard_error(nodes[cube.covers(nodes)])
    histogram = None if errors is None else make_histogram(errors, linear_edges(errors))
    values: dict[str, Any] = {
        "light": data.error_illuminant,
        "delta_e_2000": histogram,
        "calibration": None,
        "calibrations": {},
        "unlike_atlas": 0.0,
    }
    if errors is None or unseen is None:
        return values
    rgb = unseen.rgb

    def stated(light: str | None) -> Array:
        return np.asarray(expected_errors(cube, rgb, light))

    values["calibration"] = check_calibration(unseen.actual, stated(None))
    values["unlike_atlas"] = float(cube.unlike_atlas(rgb).mean())
    lights = unseen.answers.lights if data.atlas.left_out is not None else ()
    for light, actual in zip(lights, unseen.answers.delta_e.T, strict=False):
        if light not in (data.error_illuminant, data.sensor.illuminant):
            values["calibrations"][light] = check_calibration(actual, stated(light))
    return values


def _records(
    errors: EntryErrors | None, sensors: tuple[Sensor, ...]
) -> list[dict[str, Any]]:
    """Return a record of each entry."""
    if errors is None:
        return []
    lattice = errors.lattice
    spectra = {"wanted": errors.target, "answered": errors.answers.answers}
    if lattice:
        spectra["lattice"] = lattice.answers
    swatches = {}
    for sensor in sensors:
        codes = {name: hex_codes(sensor.rgb(rows)) for name, rows in spectra.items()}
        swatches[sensor.illuminant] = _as_rows(codes)
    columns: dict[str, Any] = {
        "name": errors.names,
        "rgb": errors.rgb,
        "cell": errors.cells,
        "delta_e_2000": errors.answers.by_light(),
        "delta_e_2000_lattice": lattice and lattice.by_light(),
        "rms": errors.answers.rms,
        "rms_lattice": lattice and lattice.rms,
        "delta_e_2000_reference": errors.actual,
        "standard_error": errors.predicted,
        "reach": errors.half_width,
        "reach_codes": errors.half_width_codes,
        "srgb": _as_rows(swatches),
    }
    absent = [None] * len(errors.names)
    return _as_rows(
        {name: absent if column is None else column for name, column in columns.items()}
    )


def _as_rows(columns: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Return a dictionary for each row of columns."""
    cells = zip(*columns.values(), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in cells]


def _by_light(errors: SpectraComparison) -> dict[str, Any]:
    """Errors of another method, in the order of the entries."""
    answered = errors.answered
    if not len(answered):
        answered = np.full((1, len(errors.lights)), np.nan)
    columns = {
        "mean": answered.mean(axis=0),
        "max": answered.max(axis=0),
        "entries": errors.delta_e.T,
    }
    return dict(zip(errors.lights, _as_rows(columns), strict=True))


def _crowding(
    data: CubeData, errors: EntryErrors, sensors: tuple[Sensor, ...], is_own: bool
) -> dict[str, Any]:
    """Entries close to others, with errors relative to the measured spectra of the
    cube's own atlas, or else to the stored ones.
    """
    found = find_crowding(data, errors)
    records = _records(found.entries, sensors)
    others = zip(found.nearest, found.distances, strict=True)
    for record, (nearest, apart) in zip(records, others, strict=True):
        record |= {"nearest": nearest, "apart": apart}
    against = "measured" if is_own else "stored"
    return {"against": against, "lost": found.lost, "entries": records}
