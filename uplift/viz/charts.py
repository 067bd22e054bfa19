"""Small charts of a report as SVG text, to stand in a page; the same numbers give the same text."""

from __future__ import annotations

import hashlib
import io
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from uplift.common.arrays import Array
from uplift.viz.format import format_power_of_ten
from uplift.viz.histogram import Histogram
from uplift.viz.markup import Markup

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

INK, GREY, PALE, ACCENT = "#262626", "#6e6e6e", "#d6d6d6", "#20509a"
BAND = "#c2c2c2"
SIZE = (3.3, 1.75)
"""Inches at 72 dots; the page scales them to its columns."""
LABELLED, BARE = (0.13, 0.24, 0.84, 0.72), (0.1, 0.12, 0.87, 0.84)
"""Where the axes lie in a chart with and without a label below."""
TOPS = (0.1, 0.25, 0.5, 1.0)
"""Reflectance axes end at one of these, so that dark colours show and charts still compare."""
STYLE = {
    "svg.fonttype": "none",
    "svg.hashsalt": "uplift",
    "font.size": 8,
    "axes.linewidth": 0.6,
    "axes.edgecolor": GREY,
    "axes.labelcolor": GREY,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
}
NOTHING_ELSE = dict.fromkeys(("Creator", "Date", "Format", "Type"))
"""No metadata: neither the hour nor addresses."""

UNUSED = re.compile(r' id="[\w.]+_\d+"|<!--.*?-->|<defs>\s*<style.*?</style>\s*</defs>', re.DOTALL)
"""Names of groups, comments, and a style sheet that would hold for the whole page."""
IDENTIFIER = re.compile(r'(id="|#)([mp][0-9a-f]{10})(?=["\)])')


def histogram_chart(
    part: Histogram, label: str, *, top: int | None = None, limit: float | None = None
) -> Markup:
    """Counts over ``label``; ``top`` is the largest count that the axis must hold, ``limit`` a line to stay under."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _axes(LABELLED)
        axes.stairs(part.counts, part.edges, fill=True, color=ACCENT)
        high = max(int(part.counts.max()), top or 0, 1)
        axes.set(xlabel=label, ylim=(0, 1.06 * high))
        if part.logarithmic:
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter(lambda value, _: format_power_of_ten(value))
        if limit is not None:
            axes.axvline(limit, color=INK, linewidth=0.8, linestyle=(0, (3, 2)))
        else:
            axes.set_xlim(part.edges[0], part.edges[-1])
        axes.locator_params(axis="y", nbins=4, integer=True)
        axes.yaxis.set_major_formatter("{x:,.0f}")
        return svg(figure)


def spectra_chart(wavelengths: Array, measured: Array, answered: Array, lattice: Array | None) -> Markup:
    """Reflectances (N,) over wavelengths (N,) nm: measured as a broad band, the others as lines upon it."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure, axes = _axes(BARE)
        axes.plot(wavelengths, measured, color=BAND, linewidth=4, solid_capstyle="round")
        if lattice is not None:
            axes.plot(wavelengths, lattice, color=INK, linewidth=1.1, linestyle=(0, (1.2, 1.6)))
        axes.plot(wavelengths, answered, color=ACCENT, linewidth=1.1)
        drawn = [measured, answered] if lattice is None else [measured, answered, lattice]
        top = _top(drawn)
        axes.set(
            xlim=(wavelengths[0], wavelengths[-1]),
            xticks=range(400, 800, 100),
            ylim=(0, 1.02 * top),
            yticks=(0, top / 2, top),
        )
        axes.yaxis.set_major_formatter("{x:g}")
        axes.grid(color=PALE, linewidth=0.5)
        return svg(figure)


def _top(curves: Sequence[Array]) -> float:
    highest = max(float(curve.max()) for curve in curves)
    return next((top for top in TOPS if highest <= top), TOPS[-1])


def _axes(place: tuple[float, float, float, float]) -> tuple[Figure, Axes]:
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, dpi=72)
    figure.patch.set_visible(False)
    axes = figure.add_axes(place)
    axes.patch.set_visible(False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_axisbelow(True)
    return figure, axes


def svg(figure: Figure) -> Markup:
    """The ``svg`` element alone: sized by the page, with identifiers that no other chart of the page has."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    out = io.StringIO()
    FigureCanvasSVG(figure).print_svg(out, metadata=NOTHING_ELSE)
    text = out.getvalue()
    text = text[text.index("<svg") :].replace("xlink:href", "href")
    text = UNUSED.sub("", text)
    mark = hashlib.sha256(text.encode()).hexdigest()[:8]
    text = IDENTIFIER.sub(rf"\1\2-{mark}", text)
    head, body = text.split(">", 1)
    head = re.sub(r' (?:width|height|version|xmlns:xlink)="[^"]*"', "", head)
    body = re.sub(r">\s+<", "><", body).strip()
    return Markup(f"{head}>{body}")
