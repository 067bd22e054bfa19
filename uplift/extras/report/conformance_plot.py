"""Picture of a comparison: the chart as it should be, as it is, and ΔE00."""

from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.marks import error_map, picture
from uplift.extras.pages.panels import Panel, draw
from uplift.extras.report.conformance import Conformance
from uplift.extras.report.conformance_chart import COLUMNS, ROWS

MIN_SCALE = 0.1
"""Least ΔE00 at the end of the scale."""


def plot_conformance(conformance: Conformance) -> Any:
    """Draw the reference, the picture or the colours of the spectra, both under the
    light, and ΔE00 of the patches. Returns a figure of matplotlib.
    """
    light = conformance.light
    expected = f"expected, {conformance.mode}, under {light}"
    differences = conformance.differences
    errors = conformance.comparison.delta_e.reshape(ROWS, COLUMNS)
    verdict = "passed" if conformance.passed else "FAILED"
    title = f"ΔE00, mean {differences.mean:.2g}: {verdict}"
    largest = max(differences.largest, MIN_SCALE)
    panels = [
        Panel([picture(_codes(conformance.expected))], expected),
        Panel([picture(_codes(conformance.found))], f"compared, under {light}"),
        Panel([error_map(errors, largest)], title),
    ]
    return draw(panels, len(panels), 3.5)


def _codes(xyz: Array) -> Array:
    """Return 8-bit sRGB codes (25, 40, 3) of XYZ (1000, 3), the largest of white 1."""
    rgb = xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T
    shown = rgb / max(rgb.max(), 1)
    return to_display_codes(shown.reshape(ROWS, COLUMNS, 3), SRGB).astype(np.uint8)
