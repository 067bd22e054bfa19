"""Quality of an emission table as a self-contained HTML page: exact colours, powers,
and expected errors.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from markupsafe import Markup

from uplift.extras.colour.srgb import hex_codes
from uplift.extras.emission.file import summarise
from uplift.extras.emission.lattice import chromaticity
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.pages.chromaticity import draw_colours, draw_errors, draw_lamps
from uplift.extras.pages.figure import styled, to_page_svg
from uplift.extras.pages.html import render
from uplift.extras.pages.scatter import new_panels
from uplift.extras.report.charts import (
    histogram_chart,
    linear_edges,
    log_edges,
    make_histogram,
)
from uplift.extras.report.measures import COLOURS, SEED

# smaller distances in u′v′ are rounding errors and are counted in the lowest bin
MIN_DISTANCE = 1e-12
# exponent of the random powers: large ones leave few wavelengths, so that colours reach
# the spectral locus
PEAKS = 40
PANEL = (4.2, 4.05)  # inches of a diagram; the page scales it to its columns
MARGINS = {"left": 0.11, "right": 0.98, "bottom": 0.11, "top": 0.98}
# How each diagram is drawn, and what it shows, by its title.
DIAGRAMS = {
    "Colours": (
        draw_colours,
        "Chromaticity diagram of the colours of lights, with the exact lamps",
    ),
    "Expected error": (
        draw_errors,
        "Chromaticity diagram of the expected error of surfaces",
    ),
    "Lamps": (draw_lamps, "Chromaticity diagram of the exact lamps and their discs"),
}


def assess_lights(table: EmissionTable) -> dict[str, Any]:
    """Assess an emission table by random lights and by its lamps.

    ``round_trip`` is the distance in u′v′ of random lights from the answers,
    ``smallest_power`` that of these, ``expected_error`` the ΔE00 of the ColorChecker
    lit by them instead of a measured lamp. ``lamp_errors`` (E,) are those expected of
    another lamp of the chromaticity of an exact one, which has ``lamp_rgb`` (E, 3) at
    luminance 1.
    """
    radiometry = table.data.radiometry
    random = np.random.default_rng(SEED).random((COLOURS, len(radiometry)))
    xyz = random**PEAKS @ radiometry
    power = table.spectrum_of_xyz(xyz)
    change = chromaticity(power @ radiometry) - chromaticity(xyz)
    distance = np.linalg.norm(change, axis=1)
    expected = table.expected_error(table.rgb_of_xyz(xyz))
    lamps = table.data.entries.spectra @ radiometry
    lamp_rgb = table.rgb_of_xyz(lamps / lamps[:, 1:2])
    return {
        "round_trip": make_histogram(distance, log_edges(distance, MIN_DISTANCE)),
        "smallest_power": float(power.min()),
        "expected_error": make_histogram(expected, linear_edges(expected)),
        "lamp_errors": table.expected_error(lamp_rgb),
        "lamp_rgb": lamp_rgb,
    }


def render_light_report(table: EmissionTable, name: str, size: int) -> str:
    """Render the page of a table in a file of a name and a size in bytes. The same
    table gives the same text.
    """
    entries = table.data.entries
    assessment = assess_lights(table)
    lamp_rgb = assessment["lamp_rgb"]
    brightest = np.clip(lamp_rgb / lamp_rgb.max(axis=1, keepdims=True), 0, 1)
    codes = hex_codes(brightest, table) if len(entries.names) else []
    return render(
        "extras/report/templates/lights.html.j2",
        title=name,
        size=size,
        report=assessment,
        facts=summarise(table.data),
        provenance=table.data.provenance,
        count=COLOURS,
        diagrams=[
            (title, _diagram(draw, label, table))
            for title, (draw, label) in DIAGRAMS.items()
        ],
        lamps=list(
            zip(
                entries.names,
                codes,
                entries.uv,
                entries.radius,
                assessment["lamp_errors"],
                strict=True,
            )
        ),
        histogram_chart=histogram_chart,
    )


def _diagram(draw: Callable[..., None], label: str, table: EmissionTable) -> Markup:
    with styled():
        figure, ((axes,),) = new_panels(1, 1, PANEL, MARGINS)
        draw(axes, table)
        return to_page_svg(figure, label)
