"""An assessment as a self-contained HTML page."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.report.assessment import Assessment
from uplift.report.charts import histogram_chart, spectra_chart
from uplift.report.json_export import swatches

VISIBLE, LARGE = 1.0, 3.0
"""ΔE00: the difference that is just visible side by side, and one that is obvious."""


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
