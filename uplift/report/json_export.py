"""An assessment as JSON values: the numbers of the page, for programs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import hex_codes
from uplift.report.alternatives import Alternative
from uplift.report.assessment import Assessment
from uplift.report.charts import Histogram
from uplift.report.fidelity import EntryErrors
from uplift.report.round_trip import SEED


def to_json(assessment: Assessment) -> dict[str, Any]:
    """Convert an assessment to JSON values."""
    data = assessment.data
    return _plain(
        {
            "cube": assessment.name,
            "bytes": assessment.size,
            "build": assessment.facts,
            "failures": _failures(assessment),
            "fitting_distance": _histogram(assessment.distance),
            "round_trip": {
                "colours": assessment.round_trips["spectra"].counts.sum(),
                "seed": SEED,
                "illuminant": data.sensor.illuminant,
                "delta_e_2000": {mode: _histogram(each) for mode, each in assessment.round_trips.items()},
            },
            "standard_error": _standard_error(assessment),
            "smoothness": {**_histogram(assessment.smoothness), "steepest": assessment.steepest},
            "lights": [sensor.illuminant for sensor in assessment.lights],
            "atlas": {
                "files": assessment.sources,
                "own": assessment.own,
                "outside": assessment.out_of_gamut,
                "absent": assessment.not_covered,
            },
            "delta_e_2000": {light: _histogram(each) for light, each in assessment.delta_e.items()},
            "entries": [] if assessment.entries is None else _entries(assessment.entries, assessment.lights),
            "alternatives": [_alternative(each, assessment.lights) for each in assessment.alternatives],
            "crowding": _crowding(assessment),
        }
    )


def swatches(errors: EntryErrors, sensor: Sensor) -> list[tuple[str, ...]]:
    """``#rrggbb`` of every entry under a light: target, answer and, for the cube's own entries, the lattice."""
    spectra = [each for each in (errors.target, errors.answer, errors.lattice) if each is not None]
    return list(zip(*(hex_codes(sensor.rgb(each)) for each in spectra), strict=True))


def _failures(assessment: Assessment) -> dict[str, Any]:
    failures, data = assessment.failures, assessment.data
    return {
        "status": failures.counts,
        "over_threshold": failures.over_threshold,
        "worst": [
            {
                "rgb": data.lattice.points[point],
                "lattice_rgb": data.points.rgb[point],
                "distance": data.points.distance[point],
            }
            for point in failures.worst_points
        ],
        "improvements": failures.improvements,
        "left_out": failures.left_out,
        "skipped": failures.skipped,
    }


def _standard_error(assessment: Assessment) -> dict[str, Any]:
    errors, calibration = assessment.standard_error, assessment.calibration
    return {
        "light": assessment.data.error_illuminant,
        "delta_e_2000": None if errors is None else _histogram(errors),
        "calibration": None if calibration is None else calibration.to_json(),
        "calibrations": {light: each.to_json() for light, each in assessment.light_calibrations.items()},
        "unlike_atlas": assessment.unlike,
    }


def _crowding(assessment: Assessment) -> dict[str, Any] | None:
    if (crowding := assessment.crowding) is None:
        return None
    entries = _entries(crowding.entries, assessment.lights)
    return {
        "against": "measured" if assessment.own else "stored",
        "lost": [{"name": name, "same_colour": other} for name, other in crowding.lost],
        "entries": [
            entry | {"nearest": other, "apart": distance}
            for entry, other, distance in zip(entries, crowding.nearest, crowding.distances, strict=True)
        ],
    }


def _histogram(values: Histogram) -> dict[str, Any]:
    return {
        "mean": values.mean,
        "median": values.median,
        "p95": values.p95,
        "max": values.largest,
        "edges": values.edges,
        "counts": values.counts,
    }


def _entries(errors: EntryErrors, lights: tuple[Sensor, ...]) -> list[dict[str, Any]]:
    names = [sensor.illuminant for sensor in lights]
    codes = {sensor.illuminant: swatches(errors, sensor) for sensor in lights}

    def at(values: Any, row: int) -> Any:
        return None if values is None else values[row]

    def by_light(values: Any, row: int) -> dict[str, Any] | None:
        return None if values is None else dict(zip(names, values[row], strict=True))

    return [
        {
            "name": name,
            "rgb": errors.rgb[row],
            "cell": errors.cells[row],
            "delta_e_2000": by_light(errors.delta_e, row),
            "delta_e_2000_lattice": by_light(errors.delta_e_lattice, row),
            "rms": errors.rms[row],
            "rms_lattice": at(errors.rms_lattice, row),
            "delta_e_2000_reference": errors.actual[row],
            "standard_error": at(errors.predicted, row),
            "reach": at(errors.half_width, row),
            "reach_codes": at(errors.half_width_codes, row),
            "srgb": {
                light: dict(zip(("wanted", "answered", "lattice"), each[row], strict=False))
                for light, each in codes.items()
            },
        }
        for row, name in enumerate(errors.names)
    ]


def _alternative(other: Alternative, lights: tuple[Sensor, ...]) -> dict[str, Any]:
    """Errors of another method, by light and in the order of the entries."""
    return {
        "name": other.name,
        "delta_e_2000": {
            sensor.illuminant: {
                "mean": other.mean[column],
                "max": other.largest[column],
                "entries": other.delta_e[:, column],
            }
            for column, sensor in enumerate(lights)
        },
    }


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
