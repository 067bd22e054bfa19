"""Small charts for pages, as ``svg`` elements."""

from __future__ import annotations

from typing import Any

from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.viz.figure import ACCENT, BAND, INK, STYLE, new_figure, style_axes, to_page_svg
from uplift.viz.format import format_power_of_ten
from uplift.viz.histogram import Histogram

SIZE = (3.3, 1.75)
"""Inches at 72 dpi; the page scales charts to its columns."""
WITH_LABEL, WITHOUT_LABEL = (0.13, 0.24, 0.84, 0.72), (0.1, 0.12, 0.87, 0.84)
"""Position of the axes in a chart with and without an axis label."""
REFLECTANCE_LIMITS = (0.1, 0.25, 0.5, 1.0)
"""Upper ends of reflectance axes: few enough to compare charts, and dark colours remain visible."""


def histogram_chart(values: Histogram, label: str, *, top: int | None = None, threshold: float | None = None) -> Markup:
    """Draw counts over ``label``; the axis holds counts up to ``top``, a dashed line marks the threshold."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _new_axes(WITH_LABEL)
        axes.stairs(values.counts, values.edges, fill=True, color=ACCENT)
        highest = max(int(values.counts.max()), top or 0, 1)
        axes.set(xlabel=label, ylim=(0, 1.06 * highest))
        if values.logarithmic:
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter(lambda value, _: format_power_of_ten(value))
        else:
            axes.locator_params(axis="x", nbins=6)
            axes.xaxis.set_major_formatter("{x:g}")
        if threshold is not None:
            axes.axvline(threshold, color=INK, linewidth=0.8, linestyle=(0, (3, 2)))
        else:
            axes.set_xlim(values.edges[0], values.edges[-1])
        axes.locator_params(axis="y", nbins=4, integer=True)
        axes.yaxis.set_major_formatter("{x:,.0f}")
        return to_page_svg(figure, f"Histogram of {label}")


def spectra_chart(wavelengths: Array, measured: Array, answered: Array, lattice: Array | None) -> Markup:
    """Draw reflectances (N,) over wavelengths (N,) in nm: the measured one as a broad band, the others as lines."""
    import matplotlib

    curves = [measured, answered] if lattice is None else [measured, answered, lattice]
    highest = max(float(curve.max()) for curve in curves)
    top = next((limit for limit in REFLECTANCE_LIMITS if highest <= limit), REFLECTANCE_LIMITS[-1])
    with matplotlib.rc_context(STYLE):
        figure, axes = _new_axes(WITHOUT_LABEL)
        axes.plot(wavelengths, measured, color=BAND, linewidth=4, solid_capstyle="round")
        if lattice is not None:
            axes.plot(wavelengths, lattice, color=INK, linewidth=1.1, linestyle=(0, (1.2, 1.6)))
        axes.plot(wavelengths, answered, color=ACCENT, linewidth=1.1)
        axes.set(
            xlim=(wavelengths[0], wavelengths[-1]),
            xticks=range(400, 800, 100),
            ylim=(0, 1.02 * top),
            yticks=(0, top / 2, top),
        )
        axes.yaxis.set_major_formatter("{x:g}")
        style_axes(axes)
        return to_page_svg(figure, "Reflectance over wavelength")


def _new_axes(position: tuple[float, float, float, float]) -> tuple[Any, Any]:
    figure = new_figure(*SIZE, layout=None)
    figure.set_dpi(72)
    figure.patch.set_visible(False)
    axes = figure.add_axes(position)
    axes.patch.set_visible(False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_axisbelow(True)
    return figure, axes
