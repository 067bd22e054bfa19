"""Small charts for pages, as svg elements: histograms with their statistics, and
spectra.
"""

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from uplift.common.arrays import Array, Indices
from uplift.extras.pages.figure import ACCENT, BAND, INK, to_page_svg
from uplift.extras.pages.format import format_power_of_ten
from uplift.extras.pages.marks import histogram, line
from uplift.extras.pages.marks import threshold as mark_threshold
from uplift.extras.pages.panels import Axis, Panel, draw

SIZE = (3.3, 1.75)  # inches; the page scales charts to its columns
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
    highest = max(int(values.counts.max()), top or 0, 1)
    text = format_power_of_ten if values.logarithmic else "{:g}".format
    marks = [histogram(values.counts, values.edges)]
    if threshold is not None:
        marks.append(mark_threshold(threshold, axis="x", colour=INK))
    x = Axis(label, log=values.logarithmic, text=text)
    y = Axis(limits=(0, 1.06 * highest), text="{:,.0f}".format)
    figure = draw([Panel(marks, x=x, y=y)], size=SIZE)
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
    marks = [line(wavelengths, measured, "", BAND, linewidth=4)]
    if lattice is not None:
        marks.append(line(wavelengths, lattice, linestyle=(0, (1.2, 1.6))))
    marks.append(line(wavelengths, answered, "", ACCENT, linewidth=1.1))
    x = Axis(limits=(wavelengths[0], wavelengths[-1]), ticks=range(400, 800, 100))
    y = Axis(limits=(0, 1.02 * top), ticks=(0, top / 2, top), text="{:g}".format)
    figure = draw([Panel(marks, x=x, y=y)], size=SIZE)
    return to_page_svg(figure, "Reflectance over wavelength")


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
