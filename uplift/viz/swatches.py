"""Strips of colour, such as the colours between two paints."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

from uplift.common.arrays import Array
from uplift.viz.figure import INK, PALE, figure_text, new_figure, write_figure

WIDTH, HEIGHT, TITLE_HEIGHT = 7.2, 0.62, 0.24
"""Inches of a picture's width, and of the heights of a strip and its title."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Encoded colours (k, 3) in [0, 1] under a title."""

    title: str
    codes: Array


def plot_strips(strips: Sequence[Strip], path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Plot strips of colour below one another as PNG, SVG or PDF.

    Parameters
    ----------
    strips : sequence of Strip
        The strips.
    path : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    figure = new_figure(WIDTH, len(strips) * (HEIGHT + TITLE_HEIGHT) + 0.1)
    for axes, strip in zip(figure.subplots(len(strips), 1, squeeze=False)[:, 0], strips, strict=True):
        axes.imshow(strip.codes[None], aspect="auto", interpolation="nearest")
        axes.set(xticks=(), yticks=())
        axes.spines[:].set(color=PALE, linewidth=0.6)
        axes.set_title(figure_text(strip.title), loc="left", fontsize=9, color=INK, pad=3)
    write_figure(figure, path, force=force)
