"""The pictures of a comparison as files, and as parts of a page."""

from __future__ import annotations

import os
from typing import Any

from uplift.lab.comparison import box_plots, cost
from uplift.lab.comparison.measure import Comparison
from uplift.viz.figure import STYLE, to_svg, write_png
from uplift.viz.markup import Markup

DRAWN = {"boxes": box_plots.draw, "cost": cost.draw}


def write_picture(
    found: Comparison, kind: str, path: str | os.PathLike[str], *, force: bool = False
) -> Markup:
    """One of `DRAWN` as PNG; the same as an ``svg`` element is returned. Raises `OutputError`."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure: Any = DRAWN[kind](found)
        write_png(figure, path, force=force)
        return to_svg(figure)
