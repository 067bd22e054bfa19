"""A comparison as a self-contained HTML page with tooltips."""

from __future__ import annotations

from collections.abc import Sequence

from uplift.lab.comparison.box_plots import page_figures
from uplift.lab.comparison.cost import numbered, page_panels
from uplift.lab.comparison.families import family_colours
from uplift.lab.comparison.filters import TunedFilter
from uplift.lab.comparison.measure import Comparison
from uplift.lab.comparison.statistics import HEADINGS
from uplift.viz.format import format_error, format_time
from uplift.viz.html import Tooltip

TITLE = "Representations of spectra"
SOURCES = (
    "Kment 2011, Spectral data representation techniques for realistic image synthesis: point sampling, Riemann sums "
    "and their enhancement, the lights and the statistics.",
    "Sun, Drew & Fracchia 1999: the composite model. Peercy 1993: linear models. Wilkie et al. 2014: hero wavelengths. "
    "Peters et al. 2019: trigonometric moments. Jakob & Hanika 2019: the sigmoid.",
)


def render_comparison(comparison: Comparison, tuned: Sequence[TunedFilter] = ()) -> str:
    """Render the page of a comparison.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    tuned : sequence of Tuned, optional
        Low-pass filters to list.

    Returns
    -------
    str
        The HTML text. Equal comparisons give equal text.
    """
    from uplift.viz.html import render

    numbers = numbered(comparison)
    return render(
        "lab/comparison/templates/page.html.j2",
        title=TITLE,
        comparison=comparison,
        pictures=page_panels(comparison),
        boxes=page_figures(comparison),
        families=family_colours(result.family for result in comparison.results),
        tooltips=[_tooltip(name, comparison) for name in numbers],
        facts=comparison.facts,
        sources=SOURCES,
        count=len(numbers),
        statistics=HEADINGS,
        tuned=tuned,
    )


def _tooltip(name: str, comparison: Comparison) -> Tooltip:
    results = [result for result in comparison.results if result.name == name]
    lines = [("floats of a surface", f"{results[0].floats:.1f}")]
    for result in results:
        errors = f"{format_error(result.statistics.mean)} / {format_error(result.statistics.q97_5)}"
        lines += [
            (f"{result.lights}: ΔE00, mean / 97.5 %", errors),
            (f"{result.lights}: floats of a light", f"{result.light_floats:.1f}"),
            (f"{result.lights}: product", format_time(result.ns.median)),
        ]
    return {"title": name, "family": results[0].family, "lines": lines}
