"""An assessment as JSON values for programs, and as a self-contained HTML page."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.report.assessment import Assessment
from uplift.report.charts import Histogram, histogram_chart, spectra_chart
from uplift.report.fidelity import Alternative, EntryErrors
from uplift.report.measures import SEED


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


VISIBLE, LARGE = 1.0, 3.0  # ΔE00: the difference that is just visible side by side, and one that is obvious


def render_report(assessment: Assessment, worst: int) -> str:
    """Render the report of a cube."""
    from uplift.viz.html import render

    return render(
        "report/templates/page.html.j2",
        title=assessment.name,
        report=assessment,
        data=assessment.data,
        facts=assessment.facts,
        provenance=assessment.data.provenance,
        looks=list(_looks(assessment)),
        entries=assessment.entries,
        crowding=assessment.crowding,
        worst=worst,
        target="measured" if assessment.own else "stored",
        failed_points=list(_failed_points(assessment)),
        steepest_codes=hex_codes(assessment.steepest, assessment.data.sensor),
        describe=_describe,
        histogram_chart=histogram_chart,
        spectra_chart=spectra_chart,
        errors_by_light=list(_errors_by_light(assessment)),
        codes_by_light=lambda errors: [swatches(errors, sensor) for sensor in assessment.lights],
        compared=list(_compared(assessment, worst)),
        largest_count=max((int(each.counts.max()) for each in assessment.delta_e.values()), default=0),
        severity=_severity,
        visible=VISIBLE,
        large=LARGE,
    )


def _severity(delta_e: float) -> str | None:
    """CSS class of a ΔE00."""
    return "bad" if delta_e > LARGE else "visible" if delta_e > VISIBLE else None


def _looks(assessment: Assessment) -> Iterator[dict[str, Any]]:
    """Name, colour and weight of each look, and a row for each of its lights."""
    for look in assessment.data.provenance.get("looks", ()):
        rows = [{**each, "codes": hex_codes(np.array([each["wish"], each["answer"]]))} for each in look["lights"]]
        (code,) = hex_codes(np.array([look["rgb"]]), assessment.data.sensor)
        yield {"name": look["name"], "code": code, "weight": look["weight"], "rows": rows}


def _failed_points(assessment: Assessment) -> Iterator[dict[str, Any]]:
    data, points = assessment.data, assessment.failures.worst_points
    target, actual = data.lattice.points[points], data.points.rgb[points].astype(float)
    codes = zip(hex_codes(target, data.sensor), hex_codes(actual, data.sensor), strict=True)
    for row, pair in enumerate(codes):
        distance = float(data.points.distance[points[row]])
        yield {"codes": pair, "target": target[row], "actual": actual[row], "distance": distance}


def _errors_by_light(assessment: Assessment) -> Iterator[dict[str, Any]]:
    if (entries := assessment.entries) is None:
        return
    for column, (light, values) in enumerate(assessment.delta_e.items()):
        yield {
            "light": light,
            "distribution": values,
            "worst": entries.names[int(entries.delta_e[:, column].argmax())],
            "alternatives": [(other.mean[column], other.largest[column]) for other in assessment.alternatives],
            "lattice": None if entries.delta_e_lattice is None else entries.delta_e_lattice[:, column],
        }


def _compared(assessment: Assessment, count: int) -> Iterator[list[dict[str, Any]]]:
    """Swatches and ΔE00 of the first entries: rows of measured, answered and alternatives, by light."""
    if (entries := assessment.entries) is None:
        return
    answers = {"measured": (entries.target, None), "this cube": (entries.answer, entries.delta_e)}
    answers |= {other.name: (other.answer, other.delta_e) for other in assessment.alternatives}
    for row in range(min(count, len(entries.names))):
        yield [
            {
                "name": name,
                "cells": _cells(assessment.lights, answer[row], None if errors is None else errors[row]),
            }
            for name, (answer, errors) in answers.items()
        ]


def _cells(lights: tuple[Sensor, ...], answer: Array, errors: Array | None) -> list[tuple[str, float | None]]:
    """Colour and ΔE00 of a spectrum (N,) under each light; an empty colour for an unknown spectrum."""
    if np.isnan(answer).any():
        return [("", None)] * len(lights)
    codes = [hex_codes(sensor.rgb(answer[None]))[0] for sensor in lights]
    values = [None] * len(lights) if errors is None else errors.tolist()
    return list(zip(codes, values, strict=True))


def _describe(value: Any) -> str:
    """Text of nested JSON values: names and values, separated by commas; the key ``name`` is omitted."""
    if isinstance(value, Mapping):
        return ", ".join(
            _describe(inner) if key == "name" or isinstance(inner, Mapping) else f"{key} {_describe(inner)}"
            for key, inner in value.items()
        )
    if isinstance(value, list | tuple):
        return " ".join(map(_describe, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
