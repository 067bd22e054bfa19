"""Small charts for pages, as svg elements: histograms with their statistics, and
spectra.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Indices
from uplift.extras.pages.figure import (
    ACCENT,
    BAND,
    INK,
    new_figure,
    style_axes,
    styled,
    to_page_svg,
)
from uplift.extras.pages.format import format_power_of_ten

SIZE = (3.3, 1.75)  # inches at 72 dpi; the page scales charts to its columns
# Position of the axes in a chart with and without an axis label.
WITH_LABEL = (0.13, 0.24, 0.84, 0.72)
WITHOUT_LABEL = (0.1, 0.12, 0.87, 0.84)
# Upper ends of reflectance axes: few enough to compare charts, and dark colours remain
# visible.
REFLECTANCE_LIMITS = (0.1, 0.25, 0.5, 1.0)


def histogram_chart(
    values: "Histogram",
    label: str,
    *,
    top: int | None = None,
    threshold: float | None = None,
) -> Markup:
    """Draw counts over ``label``; the axis holds counts up to ``top``, a dashed line
    marks the threshold.
    """
    with styled():
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


def spectra_chart(
    wavelengths: Array, measured: Array, answered: Array, lattice: Array | None
) -> Markup:
    """Draw reflectances (N,) over wavelengths (N,) in nm: the measured one as a broad
    band, the others as lines.
    """
    curves = [measured, answered] if lattice is None else [measured, answered, lattice]
    highest = max(float(curve.max()) for curve in curves)
    top = next(
        (limit for limit in REFLECTANCE_LIMITS if highest <= limit),
        REFLECTANCE_LIMITS[-1],
    )
    with styled():
        figure, axes = _new_axes(WITHOUT_LABEL)
        axes.plot(
            wavelengths, measured, color=BAND, linewidth=4, solid_capstyle="round"
        )
        if lattice is not None:
            axes.plot(
                wavelengths,
                lattice,
                color=INK,
                linewidth=1.1,
                linestyle=(0, (1.2, 1.6)),
            )
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
    axes = figure.add_axes(position)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_axisbelow(True)
    return figure, axes


BINS_PER_DECADE = 6
LINEAR_BINS = 24
STEPS = (1, 2, 2.5, 5, 10)  # bin widths in units of a power of ten


@dataclass(frozen=True, eq=False)
class Histogram:
    """Distribution of values."""

    mean: float
    median: float
    p95: float  # 95 % quantile
    max: float
    edges: Array  # (B + 1,) Edges of the bins
    # (B,) Values per bin; values outside the edges are counted in the outermost bins
    counts: Indices

    @property
    def logarithmic(self) -> bool:
        """Return whether the edges are a geometric series."""
        return bool(self.edges[0] > 0)


def make_histogram(values: ArrayLike, edges: Array) -> Histogram:
    """Count values (n,) in bins with edges (B + 1,)."""
    array = np.asarray(values, dtype=float)
    counts, _ = np.histogram(np.clip(array, edges[0], edges[-1]), edges)
    median, p95 = np.quantile(array, (0.5, 0.95)).tolist()
    return Histogram(
        float(array.mean()),
        median,
        p95,
        float(array.max()),
        edges,
        counts.astype(np.int64),
    )


def log_edges(values: ArrayLike, floor: float) -> Array:
    """Choose edges (B + 1,) of logarithmic bins; values below ``floor`` count as
    ``floor``.
    """
    array = np.maximum(np.asarray(values, dtype=float), floor)
    low = np.floor(np.log10(array.min()))
    high = max(np.ceil(np.log10(array.max())), low + 2)
    return np.logspace(low, high, int(BINS_PER_DECADE * (high - low)) + 1)


def linear_edges(values: ArrayLike) -> Array:
    """Choose edges (B + 1,) of linear bins with round widths."""
    target = max(float(np.max(values)), 1e-12) / LINEAR_BINS
    decade = 10.0 ** np.floor(np.log10(target))
    width = decade * next(
        step for step in STEPS if step * decade >= target * (1 - 1e-9)
    )
    return (
        width * np.arange(int(np.ceil(np.max(values) / width)) + 2)[: LINEAR_BINS + 1]
    )
