"""Strips of colour side by side, as a PNG: how one paint turns into another."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uplift.report.charts import INK
from uplift.report.figure import new_figure, write_png
from uplift.sensor import Array

WIDTH, HEIGHT, TITLE = 7.2, 0.62, 0.24
"""Inches of a picture, of a strip, and of its title."""


@dataclass(frozen=True, eq=False)
class Strip:
    """Colours (k, 3) as a screen takes them, in [0, 1], beneath a title; ``notes`` (k) stand in the swatches."""

    title: str
    codes: Array
    notes: tuple[str, ...] = ()


def plot_strips(strips: Sequence[Strip], path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Draw strips below one another. Raises `OutputError`."""
    figure = new_figure(WIDTH, len(strips) * (HEIGHT + TITLE) + 0.1)
    for axes, strip in zip(figure.subplots(len(strips), 1, squeeze=False)[:, 0], strips, strict=True):
        count = len(strip.codes)
        axes.imshow(strip.codes[None], aspect="auto", interpolation="nearest", extent=(0, count, 0, 1))
        axes.set_axis_off()
        axes.set_title(strip.title, loc="left", fontsize=9, color=INK, pad=3)
        for place, note in enumerate(strip.notes):
            color = _legible(strip.codes[place])
            axes.text(place + 0.5, 0.5, note, ha="center", va="center", fontsize=7, color=color)
    write_png(figure, path, force=force)


def _legible(codes: Array) -> str:
    return INK if codes @ np.array([0.3, 0.59, 0.11]) > 0.45 else "white"
