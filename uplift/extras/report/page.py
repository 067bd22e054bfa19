"""An assessment as a self-contained HTML page."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.report.assessment import Assessment
from uplift.extras.report.charts import histogram_chart, spectra_chart

Swatch = tuple[str, float | None]
"""``#rrggbb`` of an answer under a light, and its ΔE00."""

JUST_VISIBLE = 1.0
"""ΔE00 that is just visible side by side."""
LARGE = 3.0
"""ΔE00 that is obvious."""
AGREEMENT = 1.25
"""Largest factor, in both directions, between actual and predicted errors that counts
as agreement.
"""


def render_report(assessment: Assessment, worst: int) -> str:
    """Render the report of a cube, with the spectra of the worst entries."""
    from uplift.extras.pages.html import render

    values = assessment.values
    sensor = assessment.data.sensor
    failed = [
        point
        | {"codes": hex_codes(np.array([point["rgb"], point["lattice_rgb"]]), sensor)}
        for point in values["failures"]["worst"]
    ]
    return render(
        "extras/report/templates/page.html.j2",
        title=values["cube"],
        report=assessment,
        values=values,
        looks=list(_looks(assessment)),
        worst=worst,
        failed_points=failed,
        steepest_codes=hex_codes(np.array(values["smoothness"]["steepest"]), sensor),
        describe=_describe,
        histogram_chart=histogram_chart,
        spectra_chart=spectra_chart,
        compared=list(_compared(assessment, worst)),
        severity=_severity,
        visible=JUST_VISIBLE,
        large=LARGE,
        agreement=AGREEMENT,
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


def _compared(assessment: Assessment, count: int) -> Iterator[dict[str, list[Swatch]]]:
    """Swatches and ΔE00 of the first entries: rows of measured, answered and
    alternatives, by light.
    """
    values = assessment.values
    codes = {
        name: _codes(assessment, errors.answers[:count])
        for name, errors in assessment.alternatives.items()
    }
    for row, entry in enumerate(values["entries"][:count]):
        srgb = entry["srgb"]
        compared = {
            "measured": [(colours["wanted"], None) for colours in srgb.values()],
            "this cube": [
                (srgb[light]["answered"], delta_e)
                for light, delta_e in entry["delta_e_2000"].items()
            ],
        }
        for other in values["alternatives"]:
            columns = zip(
                codes[other["name"]], other["delta_e_2000"].values(), strict=True
            )
            compared[other["name"]] = [
                (colours[row], errors["entries"][row]) for colours, errors in columns
            ]
        yield compared


def _codes(assessment: Assessment, spectra: Array) -> list[list[str]]:
    """Return ``#rrggbb`` of spectra (n, N) for each light; unknown ones are black."""
    known = np.nan_to_num(spectra)
    return [hex_codes(sensor.rgb(known)) for sensor in assessment.lights]


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
