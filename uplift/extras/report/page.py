"""An assessment as JSON values for programs, and as a self-contained HTML page."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from pydantic_core import to_jsonable_python

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.report.assessment import Assessment
from uplift.extras.report.charts import histogram_chart, spectra_chart
from uplift.extras.report.fidelity import Answers, EntryErrors
from uplift.extras.report.measures import SEED


def to_json(assessment: Assessment) -> dict[str, Any]:
    """Convert an assessment to JSON values; numbers that are not finite are null."""
    lights = assessment.lights
    errors = assessment.entries
    entries = [] if errors is None else _entries(errors, lights)
    alternatives = [
        {"name": name, "delta_e_2000": _by_light(answers, lights)}
        for name, answers in assessment.alternatives.items()
    ]
    smoothness = {**vars(assessment.smoothness), "steepest": assessment.steepest}
    values: dict[str, Any] = to_jsonable_python(
        {
            "cube": assessment.name,
            "bytes": assessment.size,
            "build": assessment.facts,
            "failures": {"status": assessment.facts["status"], **assessment.failures},
            "fitting_distance": assessment.distance,
            "round_trip": _round_trip(assessment),
            "standard_error": _standard_error(assessment),
            "smoothness": smoothness,
            "lights": [sensor.illuminant for sensor in lights],
            "atlas": {
                "files": assessment.sources,
                "own": assessment.own,
                "outside": assessment.out_of_gamut,
                "absent": assessment.not_covered,
            },
            "delta_e_2000": assessment.delta_e,
            "entries": entries,
            "alternatives": alternatives,
            "crowding": _crowding(assessment),
        },
        inf_nan_mode="null",
        fallback=lambda array: array.tolist(),
    )
    return values


def _round_trip(assessment: Assessment) -> dict[str, Any]:
    return {
        "colours": assessment.round_trips["spectra"].counts.sum(),
        "seed": SEED,
        "illuminant": assessment.data.sensor.illuminant,
        "delta_e_2000": assessment.round_trips,
    }


def _standard_error(assessment: Assessment) -> dict[str, Any]:
    calibration = assessment.calibration
    calibrations = assessment.light_calibrations.items()
    return {
        "light": assessment.data.error_illuminant,
        "delta_e_2000": assessment.standard_error,
        "calibration": None if calibration is None else calibration.to_json(),
        "calibrations": {light: checked.to_json() for light, checked in calibrations},
        "unlike_atlas": assessment.unlike,
    }


def swatches(errors: EntryErrors, sensor: Sensor) -> list[tuple[str, ...]]:
    """``#rrggbb`` of every entry under a light: target, answer and, for the cube's own
    entries, the lattice.
    """
    spectra = [errors.target, errors.answers.spectra]
    if errors.lattice:
        spectra.append(errors.lattice.spectra)
    columns = [hex_codes(sensor.rgb(reflectance)) for reflectance in spectra]
    return list(zip(*columns, strict=True))


def _crowding(assessment: Assessment) -> dict[str, Any] | None:
    if (crowding := assessment.crowding) is None:
        return None
    entries = _entries(crowding.entries, assessment.lights)
    return {
        "against": "measured" if assessment.own else "stored",
        "lost": [{"name": name, "same_colour": other} for name, other in crowding.lost],
        "entries": [
            entry | {"nearest": other, "apart": distance}
            for entry, other, distance in zip(
                entries, crowding.nearest, crowding.distances, strict=True
            )
        ],
    }


def _entries(errors: EntryErrors, lights: tuple[Sensor, ...]) -> list[dict[str, Any]]:
    names = [sensor.illuminant for sensor in lights]
    codes = {sensor.illuminant: swatches(errors, sensor) for sensor in lights}
    answers = errors.answers
    lattice = errors.lattice

    def at(values: Any, row: int) -> Any:
        return None if values is None else values[row]

    def by_light(spectra: Answers | None, row: int) -> dict[str, Any] | None:
        if spectra is None:
            return None
        return dict(zip(names, spectra.delta_e[row], strict=True))

    entries = []
    for row, name in enumerate(errors.names):
        srgb = {}
        for light, swatch in codes.items():
            colours = zip(("wanted", "answered", "lattice"), swatch[row], strict=False)
            srgb[light] = dict(colours)
        entry = {
            "name": name,
            "rgb": errors.rgb[row],
            "cell": errors.cells[row],
            "delta_e_2000": by_light(answers, row),
            "delta_e_2000_lattice": by_light(lattice, row),
            "rms": answers.rms[row],
            "rms_lattice": lattice and lattice.rms[row],
            "delta_e_2000_reference": errors.actual[row],
            "standard_error": at(errors.predicted, row),
            "reach": at(errors.half_width, row),
            "reach_codes": at(errors.half_width_codes, row),
            "srgb": srgb,
        }
        entries.append(entry)
    return entries


def _by_light(other: Answers, lights: tuple[Sensor, ...]) -> dict[str, Any]:
    """Errors of another method, in the order of the entries."""
    columns = zip(
        lights,
        other.answered.mean(axis=0),
        other.answered.max(axis=0),
        other.delta_e.T,
        strict=True,
    )
    return {
        sensor.illuminant: {"mean": mean, "max": most, "entries": delta_e}
        for sensor, mean, most, delta_e in columns
    }


Swatch = tuple[str, float | None]
"""``#rrggbb`` of an answer under a light, or nothing, and its ΔE00."""

JUST_VISIBLE = 1.0
"""ΔE00 that is just visible side by side."""
LARGE = 3.0
"""ΔE00 that is obvious."""


def render_report(assessment: Assessment, worst: int) -> str:
    """Render the report of a cube."""
    from uplift.extras.pages.html import render

    return render(
        "extras/report/templates/page.html.j2",
        title=assessment.name,
        report=assessment,
        looks=list(_looks(assessment)),
        worst=worst,
        target="measured" if assessment.own else "stored",
        failed_points=list(_failed_points(assessment)),
        steepest_codes=hex_codes(assessment.steepest, assessment.data.sensor),
        describe=_describe,
        histogram_chart=histogram_chart,
        spectra_chart=spectra_chart,
        codes_by_light=lambda errors: [
            swatches(errors, sensor) for sensor in assessment.lights
        ],
        compared=list(_compared(assessment, worst)),
        largest_count=max(
            (int(errors.counts.max()) for errors in assessment.delta_e.values()),
            default=0,
        ),
        severity=_severity,
        visible=JUST_VISIBLE,
        large=LARGE,
    )


def _severity(delta_e: float) -> str | None:
    """CSS class of a ΔE00."""
    return "bad" if delta_e > LARGE else "visible" if delta_e > JUST_VISIBLE else None


def _looks(assessment: Assessment) -> Iterator[dict[str, Any]]:
    """Name, colour and weight of each look, and a row for each of its lights."""
    for look in assessment.data.provenance.get("looks", ()):
        rows = [
            {**light, "codes": hex_codes(np.array([light["wish"], light["answer"]]))}
            for light in look["lights"]
        ]
        (code,) = hex_codes(np.array([look["rgb"]]), assessment.data.sensor)
        yield {
            "name": look["name"],
            "code": code,
            "weight": look["weight"],
            "rows": rows,
        }


def _failed_points(assessment: Assessment) -> Iterator[dict[str, Any]]:
    for point in assessment.failures["worst"]:
        target = point["rgb"]
        actual = point["lattice_rgb"].astype(float)
        codes = hex_codes(np.array([target, actual]), assessment.data.sensor)
        yield {
            "codes": codes,
            "target": target,
            "actual": actual,
            "distance": float(point["distance"]),
        }


def _compared(assessment: Assessment, count: int) -> Iterator[dict[str, list[Swatch]]]:
    """Swatches and ΔE00 of the first entries: rows of measured, answered and
    alternatives, by light.
    """
    if (entries := assessment.entries) is None:
        return
    answers = {"this cube": entries.answers, **assessment.alternatives}
    for row in range(min(count, len(entries.names))):
        measured = _cells(assessment.lights, entries.target[row], None)
        cells = {
            name: _cells(assessment.lights, method.spectra[row], method.delta_e[row])
            for name, method in answers.items()
        }
        yield {"measured": measured} | cells


def _cells(
    lights: tuple[Sensor, ...], answer: Array, errors: Array | None
) -> list[Swatch]:
    """Colour and ΔE00 of a spectrum (N,) under each light; an empty colour for an
    unknown spectrum.
    """
    if np.isnan(answer).any():
        return [("", None)] * len(lights)
    codes = [hex_codes(sensor.rgb(answer[None]))[0] for sensor in lights]
    values = [None] * len(lights) if errors is None else errors.tolist()
    return list(zip(codes, values, strict=True))


def _describe(value: Any) -> str:
    """Text of nested JSON values: names and values, separated by commas; the key
    ``name`` is omitted.
    """
    if isinstance(value, Mapping):
        return ", ".join(
            _describe(inner)
            if key == "name" or isinstance(inner, Mapping)
            else f"{key} {_describe(inner)}"
            for key, inner in value.items()
        )
    if isinstance(value, list | tuple):
        return " ".join(map(_describe, value)) or "none"
    return f"{value:g}" if isinstance(value, float) else str(value)
