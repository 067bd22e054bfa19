"""An assessment as JSON values for programs, and as a self-contained HTML page of
these.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from pydantic_core import to_jsonable_python

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.report.assessment import Assessment
from uplift.extras.report.charts import histogram_chart, spectra_chart
from uplift.extras.report.comparison import SpectraComparison
from uplift.extras.report.entries import EntryErrors
from uplift.extras.report.measures import SEED


def to_json(assessment: Assessment) -> dict[str, Any]:
    """Convert an assessment to JSON values; numbers that are not finite are null."""
    calibration = assessment.calibration
    calibrations = assessment.light_calibrations.items()
    alternatives = [
        {"name": name, "delta_e_2000": _by_light(errors)}
        for name, errors in assessment.alternatives.items()
    ]
    values: dict[str, Any] = to_jsonable_python(
        {
            "cube": assessment.name,
            "bytes": assessment.size,
            "build": assessment.facts,
            "failures": {"status": assessment.facts["status"], **assessment.failures},
            "fitting_distance": assessment.distance,
            "round_trip": {
                "colours": assessment.round_trips["spectra"].counts.sum(),
                "seed": SEED,
                "illuminant": assessment.data.sensor.illuminant,
                "delta_e_2000": assessment.round_trips,
            },
            "standard_error": {
                "light": assessment.data.error_illuminant,
                "delta_e_2000": assessment.standard_error,
                "calibration": calibration and calibration.to_json(),
                "calibrations": {light: each.to_json() for light, each in calibrations},
                "unlike_atlas": assessment.unlike,
            },
            "smoothness": {
                **vars(assessment.smoothness),
                "steepest": assessment.steepest,
            },
            "lights": [sensor.illuminant for sensor in assessment.lights],
            "atlas": {
                "files": assessment.sources,
                "own": assessment.own,
                "outside": assessment.out_of_gamut,
                "absent": assessment.not_covered,
            },
            "delta_e_2000": assessment.delta_e,
            "entries": _entries(assessment.entries, assessment.lights),
            "alternatives": alternatives,
            "crowding": _crowding(assessment),
        },
        inf_nan_mode="null",
        fallback=lambda array: array.tolist(),
    )
    return values


def _crowding(assessment: Assessment) -> dict[str, Any] | None:
    if (crowding := assessment.crowding) is None:
        return None
    entries = _entries(crowding.entries, assessment.lights)
    others = zip(crowding.nearest, crowding.distances, strict=True)
    for entry, (nearest, apart) in zip(entries, others, strict=True):
        entry |= {"nearest": nearest, "apart": apart}
    return {
        "against": "measured" if assessment.own else "stored",
        "lost": [{"name": name, "same_colour": other} for name, other in crowding.lost],
        "entries": entries,
    }


def _entries(
    errors: EntryErrors | None, lights: tuple[Sensor, ...]
) -> list[dict[str, Any]]:
    """Return a record of each entry."""
    if errors is None:
        return []
    answers = errors.answers
    lattice = errors.lattice
    codes = {sensor.illuminant: _swatches(errors, sensor) for sensor in lights}
    columns: dict[str, Any] = {
        "name": errors.names,
        "rgb": errors.rgb,
        "cell": errors.cells,
        "delta_e_2000": answers.by_light(),
        "delta_e_2000_lattice": lattice and lattice.by_light(),
        "rms": answers.rms,
        "rms_lattice": lattice and lattice.rms,
        "delta_e_2000_reference": errors.actual,
        "standard_error": errors.predicted,
        "reach": errors.half_width,
        "reach_codes": errors.half_width_codes,
        "srgb": [
            {light: swatches[row] for light, swatches in codes.items()}
            for row in range(len(errors.names))
        ],
    }
    return [
        {
            name: None if column is None else column[row]
            for name, column in columns.items()
        }
        for row in range(len(errors.names))
    ]


def _swatches(errors: EntryErrors, sensor: Sensor) -> list[dict[str, str]]:
    """Return ``#rrggbb`` of every entry under a light."""
    spectra = {"wanted": errors.answers.expected, "answered": errors.answers.answers}
    if errors.lattice:
        spectra["lattice"] = errors.lattice.answers
    columns = [hex_codes(sensor.rgb(reflectance)) for reflectance in spectra.values()]
    return [
        dict(zip(spectra, codes, strict=True)) for codes in zip(*columns, strict=True)
    ]


def _by_light(errors: SpectraComparison) -> dict[str, Any]:
    """Errors of another method, in the order of the entries."""
    answered = errors.answered
    if not len(answered):
        answered = np.full((1, len(errors.lights)), np.nan)
    columns = zip(
        answered.mean(axis=0), answered.max(axis=0), errors.delta_e.T, strict=True
    )
    return {
        light: {"mean": mean, "max": most, "entries": delta_e}
        for light, (mean, most, delta_e) in zip(errors.lights, columns, strict=True)
    }


Swatch = tuple[str, float | None]
"""``#rrggbb`` of an answer under a light, and its ΔE00."""

JUST_VISIBLE = 1.0
"""ΔE00 that is just visible side by side."""
LARGE = 3.0
"""ΔE00 that is obvious."""


def render_report(assessment: Assessment, worst: int) -> str:
    """Render the report of a cube, with the spectra of the worst entries."""
    from uplift.extras.pages.html import render

    values = to_json(assessment)
    sensor = assessment.data.sensor
    failed = [
        point
        | {"codes": hex_codes(np.array([point["rgb"], point["lattice_rgb"]]), sensor)}
        for point in values["failures"]["worst"]
    ]
    return render(
        "extras/report/templates/page.html.j2",
        title=assessment.name,
        report=assessment,
        values=values,
        looks=list(_looks(assessment)),
        worst=worst,
        failed_points=failed,
        steepest_codes=hex_codes(assessment.steepest, sensor),
        describe=_describe,
        histogram_chart=histogram_chart,
        spectra_chart=spectra_chart,
        compared=list(_compared(assessment, values, worst)),
        severity=_severity,
        visible=JUST_VISIBLE,
        large=LARGE,
    )


def _severity(delta_e: float) -> str | None:
    """CSS class of a ΔE00."""
    return "bad" if delta_e > LARGE else "visible" if delta_e > JUST_VISIBLE else None


def _looks(assessment: Assessment) -> Iterator[dict[str, Any]]:
    """A row for each light of each look, with its colours."""
    for look in assessment.data.provenance.get("looks", ()):
        (code,) = hex_codes(np.array([look["rgb"]]), assessment.data.sensor)
        for light in look["lights"]:
            codes = hex_codes(np.array([light["wish"], light["answer"]]))
            yield look | light | {"code": code, "codes": codes}


def _compared(
    assessment: Assessment, values: Mapping[str, Any], count: int
) -> Iterator[dict[str, list[Swatch]]]:
    """Swatches and ΔE00 of the first entries: rows of measured, answered and
    alternatives, by light.
    """
    spectra = {
        name: np.nan_to_num(errors.answers[:count])
        for name, errors in assessment.alternatives.items()
    }
    for row, entry in enumerate(values["entries"][:count]):
        compared: dict[str, list[Swatch]] = {"measured": [], "this cube": []}
        for light, codes in entry["srgb"].items():
            compared["measured"].append((codes["wanted"], None))
            compared["this cube"].append(
                (codes["answered"], entry["delta_e_2000"][light])
            )
        for other in values["alternatives"]:
            compared[other["name"]] = [
                (code, errors["entries"][row])
                for code, errors in zip(
                    _codes(assessment.lights, spectra[other["name"]][row]),
                    other["delta_e_2000"].values(),
                    strict=True,
                )
            ]
        yield compared


def _codes(lights: tuple[Sensor, ...], spectrum: Array) -> list[str]:
    """Return ``#rrggbb`` of a spectrum (N,) under each light."""
    return [hex_codes(sensor.rgb(spectrum[None]))[0] for sensor in lights]


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
