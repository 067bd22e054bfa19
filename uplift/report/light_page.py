"""The assessment of an emission table as a self-contained HTML page."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from markupsafe import Markup

from uplift.colorimetry.srgb import hex_codes
from uplift.report.charts import histogram_chart
from uplift.report.lights import LightAssessment
from uplift.report.round_trip import COLOURS
from uplift.viz.chromaticity import draw_colours, draw_errors, draw_lamps
from uplift.viz.figure import STYLE, to_page_svg
from uplift.viz.html import render
from uplift.viz.scatter import new_panels

PANEL = (4.2, 4.05)
"""Inches of a diagram; the page scales it to its columns."""
MARGINS = {"left": 0.11, "right": 0.98, "bottom": 0.11, "top": 0.98}
DIAGRAMS = {
    "Colours": (draw_colours, "Chromaticity diagram of the colours of lights, with the exact lamps"),
    "Expected error": (draw_errors, "Chromaticity diagram of the expected error of surfaces"),
    "Lamps": (draw_lamps, "Chromaticity diagram of the exact lamps and their discs"),
}
"""How each diagram is drawn, and what it shows, by its title."""


def render_light_report(assessment: LightAssessment) -> str:
    """Render the report of an emission table.

    Parameters
    ----------
    assessment : LightAssessment
        The assessment.

    Returns
    -------
    str
        The HTML text. The same table gives the same text.
    """
    entries = assessment.table.data.entries
    brightest = np.clip(assessment.lamp_rgb / assessment.lamp_rgb.max(axis=1, keepdims=True), 0, 1)
    codes = hex_codes(brightest, assessment.table) if len(entries.names) else []
    return render(
        "report/templates/lights.html.j2",
        title=assessment.name,
        report=assessment,
        facts=assessment.facts,
        provenance=assessment.table.data.provenance,
        count=COLOURS,
        diagrams=[(title, _diagram(draw, label, assessment)) for title, (draw, label) in DIAGRAMS.items()],
        lamps=list(zip(entries.names, codes, entries.uv, entries.radius, assessment.lamp_errors, strict=True)),
        histogram_chart=histogram_chart,
    )


def _diagram(draw: Callable[..., None], label: str, assessment: LightAssessment) -> Markup:
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, ((axes,),) = new_panels(1, 1, PANEL, MARGINS)
        figure.patch.set_visible(False)
        axes.patch.set_visible(False)
        draw(axes, assessment.table)
        return to_page_svg(figure, label)
