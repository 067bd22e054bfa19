"""Figures of a comparison as files."""

from __future__ import annotations

import os

from uplift.lab.comparison import box_plots, cost
from uplift.lab.comparison.measure import Comparison
from uplift.viz.figure import STYLE, write_png

KINDS = {"boxes": box_plots.draw, "cost": cost.draw}
"""Functions that draw a comparison, by kind."""


def write_picture(comparison: Comparison, kind: str, path: str | os.PathLike[str], *, force: bool = False) -> None:
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

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    import matplotlib

    with matplotlib.rc_context(STYLE):
        write_png(KINDS[kind](comparison), path, force=force)
