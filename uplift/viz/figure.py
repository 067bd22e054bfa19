"""What all figures share: no frame, a light grid, and a PNG that is whole or not there."""

from __future__ import annotations

import os
from typing import Any, Literal

from uplift.common.files import atomic_write


def new_figure(width: float, height: float, layout: Literal["constrained"] | None = "constrained") -> Any:
    """An empty matplotlib figure, in inches. Without a ``layout`` it is known at once where everything lies."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout=layout)


def style_axes(axes: Any) -> None:
    """Take the frame away and put a grid behind the lines."""
    axes.grid(color="0.9")
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)


def style_spectrum_axes(axes: Any) -> None:
    """Axes of reflectance over wavelength."""
    axes.set(xlabel="wavelength / nm", ylabel="reflectance", ylim=(-0.02, 1.02))
    axes.margins(x=0.01)
    style_axes(axes)


def write_png(figure: Any, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write a figure. Raises `OutputError`."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    # Without a name here matplotlib writes its own and its version.
    with atomic_write(path, force=force) as temporary:
        FigureCanvasAgg(figure).print_png(temporary, metadata={"Software": "uplift"})
