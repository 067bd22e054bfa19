"""Picture of a comparison: the chart as it should be, as it is, and ΔE00."""

from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import colour_map, new_figure, show_image
from uplift.extras.report.conformance import Conformance
from uplift.extras.report.conformance_chart import COLUMNS, ROWS

MIN_SCALE = 0.1
"""Least ΔE00 at the end of the scale."""


def plot_conformance(conformance: Conformance) -> Any:
    """Draw the reference, the picture or the colours of the spectra, both under the
    light, and ΔE00 of the patches. Returns a figure of matplotlib.
    """
    figure = new_figure(10.5, 2.7)
    axes = figure.subplots(1, 3)
    names = (f"expected, {conformance.mode}", "compared")
    for place, name, xyz in zip(
        axes, names, (conformance.expected, conformance.found), strict=False
    ):
        show_image(place, _codes(xyz), interpolation="nearest")
        place.set_title(f"{name}, under {conformance.light}", fontsize=10)
    differences = conformance.differences
    errors = conformance.delta_e.reshape(ROWS, COLUMNS)
    shown = show_image(
        axes[2],
        errors,
        cmap=colour_map(),
        vmin=0,
        vmax=max(differences.largest, MIN_SCALE),
        interpolation="nearest",
    )
    verdict = "passed" if conformance.passed else "FAILED"
    axes[2].set_title(f"ΔE00, mean {differences.mean:.2g}: {verdict}", fontsize=10)
    figure.colorbar(shown, ax=axes[2], shrink=0.7)
    return figure


def _codes(xyz: Array) -> Array:
    """Return 8-bit sRGB codes (25, 40, 3) of XYZ (1000, 3), the largest of white 1."""
    rgb = xyz @ np.linalg.inv(SRGB.rgb_to_xyz).T
    shown = rgb / max(rgb.max(), 1)
    return to_display_codes(shown.reshape(ROWS, COLUMNS, 3), SRGB).astype(np.uint8)
