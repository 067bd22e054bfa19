"""What all figures share: no frame, a light grid, and a PNG that is whole or not there."""

from __future__ import annotations

import os
from typing import Any, Literal

from uplift.common.files import replacing


def new_figure(width: float, height: float, layout: Literal["constrained"] | None = "constrained") -> Any:
    """An empty matplotlib figure, in inches. Without a ``layout`` it is known at once where everything lies."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout=layout)


def plain(axes: Any) -> None:
    """Take the frame away and put a grid behind the lines."""
    axes.grid(color="0.9")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def spectral(axes: Any) -> None:
    """Axes of reflectance over wavelength."""
    axes.set(xlabel="wavelength / nm", ylabel="reflectance", ylim=(-0.02, 1.02))
    axes.margins(x=0.01)
    plain(axes)


def write_png(figure: Any, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a figure. Raises `OutputError`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    # Without a name here matplotlib writes its own and its version.
    with replacing(path, force=force) as temporary:
        FigureCanvasAgg(figure).print_png(temporary, metadata={"Software": "uplift"})
