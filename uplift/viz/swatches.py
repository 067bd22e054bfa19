"""Strips of colour below one another, as a PNG: how one paint turns into another."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

from uplift.common.arrays import Array
from uplift.viz.figure import INK, PALE, new_figure, write_png

WIDTH, HEIGHT, TITLE = 7.2, 0.62, 0.24
"""Inches of a picture, of a strip, and of its title."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Colours (k, 3) as a screen takes them, in [0, 1], beneath a title."""

    title: str
    codes: Array


def plot_strips(strips: Sequence[Strip], path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Draw strips, each as wide as the picture. Raises `OutputError`."""
    figure = new_figure(WIDTH, len(strips) * (HEIGHT + TITLE) + 0.1)
    for axes, strip in zip(figure.subplots(len(strips), 1, squeeze=False)[:, 0], strips, strict=True):
        axes.imshow(strip.codes[None], aspect="auto", interpolation="nearest")
        axes.set(xticks=(), yticks=())
        axes.spines[:].set(color=PALE, linewidth=0.6)
        axes.set_title(strip.title, loc="left", fontsize=9, color=INK, pad=3)
    write_png(figure, path, force=force)
