"""Meyer's figures 6 and 7, and the errors of the methods over the number of wavelengths."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.wavelengths.experiments import Trials, bin_shares
from benchmarks.wavelengths.methods import COUNTS, Comparison
from uplift.scene.wavelengths import METHODS
from uplift.viz.figure import GREY, INK, STYLE, new_figure, style_axes, write_png

COLOURS = ("#20509a", "#d1495b", "#2e8b57", "#c98a1b", "#7fa3d9")
CORNERS = np.array([[0.5, np.sqrt(0.75)], [0.0, 0.0], [1.0, 0.0]])
"""Corners where the first, second and third channel have all wavelengths."""


def figure_6(spaces: Sequence[Trials], path: Path) -> None:
    """Plot the mean over all allocations, and the best of them, over the number of wavelengths."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = new_figure(7.2, 3.6)
        axes = figure.subplots()
        for trials, colour in zip(spaces, COLOURS, strict=False):
            totals, means = trials.by_total
            axes.plot(totals, means, "o-", color=colour, markersize=3, label=trials.space.name)
            best = [trials.errors[trials.counts.sum(axis=1) == total].min() for total in totals]
            axes.plot(totals, best, ":", color=colour)
        axes.plot([], [], "o-", color=GREY, markersize=3, label="mean of all allocations")
        axes.plot([], [], ":", color=GREY, label="best allocation")
        axes.set(xlabel="wavelengths", ylabel="mean ΔE76", yscale="log")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.legend(frameon=False, ncols=2)
        style_axes(axes)
        write_png(figure, path, force=True)


def figure_7(trials: Trials, path: Path) -> None:
    """Plot the mean error as small triangles, darker for larger errors."""
    import matplotlib
    from matplotlib.collections import PolyCollection

    parts = bin_shares(trials)
    with matplotlib.rc_context(STYLE):
        figure = new_figure(6.0, 4.6)
        axes = figure.subplots()
        cells = PolyCollection(
            parts.corners @ CORNERS, array=parts.errors, cmap="viridis_r", edgecolors="white", linewidths=0.6
        )
        axes.add_collection(cells)
        axes.plot(*CORNERS[[0, 1, 2, 0]].T, color=GREY, linewidth=0.8)
        for name, (x, y), side in zip(trials.space.channels, CORNERS, ("bottom", "top", "top"), strict=True):
            axes.annotate(
                f"all for {name}",
                (x, y),
                xytext=(0, 5 if side == "bottom" else -5),
                textcoords="offset points",
                ha="center",
                va=side,
                color=INK,
                fontsize=9,
            )
        axes.set_aspect("equal")
        axes.set(xlim=(-0.12, 1.12), ylim=(-0.1, 0.97))
        axes.set_axis_off()
        figure.colorbar(cells, ax=axes, shrink=0.8, label="mean ΔE76")
        write_png(figure, path, force=True)


def methods(comparisons: Sequence[Comparison], path: Path) -> None:
    """Plot mean ΔE00 on held-out materials over the number of wavelengths."""
    import matplotlib

    with matplotlib.rc_context(STYLE):
        figure = new_figure(7.2, 3.4)
        panels = figure.subplots(1, len(comparisons), sharey=True)
        for axes, comparison in zip(panels, comparisons, strict=True):
            for method, colour in zip(METHODS, COLOURS, strict=True):
                means = [comparison.unseen[method, count].mean for count in COUNTS]
                axes.plot(COUNTS, means, "o-", color=colour, markersize=3, label=method)
            axes.set(xlabel="wavelengths", yscale="log")
            axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
            axes.set_title(", ".join(comparison.lights), loc="left", fontsize=9, color=INK)
            style_axes(axes)
        panels[0].set_ylabel("mean ΔE00, unseen materials")
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=5, frameon=False)
        write_png(figure, path, force=True)
