"""Small charts for pages, as svg elements: histograms with their statistics, and
spectra.
"""

from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.extras.pages.figure import ACCENT, BAND, INK, to_page_svg
from uplift.extras.pages.format import format_power_of_ten
from uplift.extras.pages.marks import histogram, line
from uplift.extras.pages.marks import threshold as mark_threshold
from uplift.extras.pages.panels import Axis, Panel, draw

SIZE = (3.3, 1.75)  # inches; the page scales charts to its columns
# Upper ends of reflectance axes: few enough to compare charts, and dark colours remain
# visible.
REFLECTANCE_LIMITS = (0.1, 0.25, 0.5, 1.0)
BINS_PER_DECADE = 6
LINEAR_BINS = 24
STEPS = (1, 2, 2.5, 5, 10)  # bin widths in units of a power of ten
Histogram = dict[str, Any]
"""Distribution of values for JSON: mean, median, 95 % quantile ``p95`` and max, edges
(B + 1,) of bins, and counts (B,). Values outside are counted in the outermost bins.
"""


def make_histogram(values: ArrayLike, edges: Array) -> Histogram:
    """Count values (n,) in bins with edges (B + 1,)."""
    array = np.asarray(values, dtype=float)
    counts, _ = np.histogram(np.clip(array, edges[0], edges[-1]), edges)
    median, p95 = np.quantile(array, (0.5, 0.95)).tolist()
    return {
        "mean": float(array.mean()),
        "median": median,
        "p95": p95,
        "max": float(array.max()),
        "edges": edges.tolist(),
        "counts": counts.tolist(),
    }


def log_edges(values: ArrayLike, floor: float) -> Array:
    """Choose edges (B + 1,) of logarithmic bins; values below ``floor`` count as
    ``floor``.
    """
    decades = np.log10(np.maximum(np.asarray(values, dtype=float), floor))
    low = np.floor(decades.min())
    high = max(np.ceil(decades.max()), low + 2)
    return np.logspace(low, high, int(BINS_PER_DECADE * (high - low)) + 1)


def linear_edges(values: ArrayLike) -> Array:
    """Choose edges (B + 1,) of linear bins with round widths."""
    most = float(np.max(values))
    target = max(most, 1e-12) / LINEAR_BINS
    decade = 10.0 ** np.floor(np.log10(target))
    width = decade * next(
        step for step in STEPS if step * decade >= target * (1 - 1e-9)
    )
    count = min(int(np.ceil(most / width)) + 2, LINEAR_BINS + 1)
    return width * np.arange(count)


def histogram_chart(
    values: Histogram,
    label: str,
    *,
    top: int = 1,
    threshold: float | None = None,
) -> Markup:
    """Draw counts over ``label``; the axis holds counts up to ``top``, a dashed line
    marks the threshold.
    """
    counts = np.array(values["counts"])
    edges = np.array(values["edges"])
    is_log = bool(edges[0] > 0)
    marks = [histogram(counts, edges)]
    if threshold is not None:
        marks.append(mark_threshold(threshold, axis="x", colour=INK))
    x = Axis(label, log=is_log, text=format_power_of_ten if is_log else "{:g}".format)
    y = Axis(limits=(0, 1.06 * max(counts.max(), top)), text="{:,.0f}".format)
    figure = draw([Panel(marks, x=x, y=y)], size=SIZE)
    return to_page_svg(figure, f"Histogram of {label}")


def spectra_chart(
    wavelengths: Array, measured: Array, answered: Array, lattice: Array | None = None
) -> Markup:
    """Draw reflectances (N,) over wavelengths (N,) in nm: the measured one as a broad
    band, the others as lines.
    """
    marks = [line(wavelengths, measured, "", BAND, linewidth=4)]
    highest = max(measured.max(), answered.max())
    if lattice is not None:
        marks.append(line(wavelengths, lattice, linestyle=(0, (1.2, 1.6))))
        highest = max(highest, lattice.max())
    marks.append(line(wavelengths, answered, "", ACCENT, linewidth=1.1))
    top = min((limit for limit in REFLECTANCE_LIMITS if highest <= limit), default=1.0)
    x = Axis(limits=(wavelengths[0], wavelengths[-1]), ticks=range(400, 800, 100))
    y = Axis(limits=(0, 1.02 * top), ticks=(0, top / 2, top), text="{:g}".format)
    figure = draw([Panel(marks, x=x, y=y)], size=SIZE)
    return to_page_svg(figure, "Reflectance over wavelength")
