"""Figures of a comparison as files and as parts of a page."""

from __future__ import annotations

import os

from markupsafe import Markup

from uplift.lab.comparison import box_plots, cost
from uplift.lab.comparison.measure import Comparison
from uplift.viz.figure import STYLE, to_svg, write_png

KINDS = {"boxes": box_plots.draw, "cost": cost.draw}
"""Functions that draw a comparison, by kind."""
LABELS = {
    "boxes": "Box plots of the errors of all representations",
    "cost": "Error over cost of all representations",
}
"""Texts for screen readers."""


def write_picture(
    comparison: Comparison, kind: str, path: str | os.PathLike[str], *, force: bool = False
) -> Markup:
    """Write a figure of a comparison as PNG.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    kind : {"boxes", "cost"}
        Box plots of the errors, or error over cost.
    path : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Returns
    -------
    Markup
        The same figure as ``svg`` element, for a page.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = KINDS[kind](comparison)
        write_png(figure, path, force=force)
        return to_svg(figure, LABELS[kind])
