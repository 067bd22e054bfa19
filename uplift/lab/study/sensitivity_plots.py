"""Pictures of sensitivity: where a cube is steep, and how far a change of its atlas reaches."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.cube import CubeData
from uplift.lab.study.lipschitz import LipschitzConstants
from uplift.lab.study.locality import MOVED_DELTA_E, Change
from uplift.viz.figure import new_figure, style_axes, write_png

Path = str | os.PathLike[str]
CHANNELS = ("red", "green", "blue")
RAMP = ("#eef5f8", "#a9cfe3", "#5a9fcb", "#20609a", "#0b1d51")
LINE, LOUD, INK = "#1f6fb4", "#ff5a00", "#111111"
SHOWN = 1e-4
"""Least ΔE00 that is drawn."""


def plot_steepness(data: CubeData, found: LipschitzConstants, path: Path, *, force: bool = False) -> None:
    """Draw the steepest cell along each channel, and the steepest wavelengths. Raises `OutputError`."""
    from matplotlib.colors import LinearSegmentedColormap, LogNorm

    figure = new_figure(12.0, 3.6)
    panels = figure.subplots(1, 4, width_ratios=(1, 1, 1, 1.25))
    ramp = LinearSegmentedColormap.from_list("steep", RAMP)
    norm = LogNorm(found.cells.min(), found.cells.max())
    edges = np.interp(data.lattice.nodes, data.sensor.decoding, np.arange(256))
    for axis, axes in enumerate(panels[:3]):
        across, up = (other for other in range(3) if other != axis)
        shown = axes.pcolormesh(edges, edges, found.cells.max(axis=axis).T, cmap=ramp, norm=norm)
        axes.set(xlabel=CHANNELS[across], ylabel=CHANNELS[up], aspect="equal")
        axes.set_title(f"steepest along {CHANNELS[axis]}", loc="left", fontsize=10)
        axes.set_xticks((0, 128, 255))
        axes.set_yticks((0, 128, 255))
        axes.spines[:].set_visible(False)
    bar = figure.colorbar(shown, ax=panels[2], shrink=0.85)
    bar.outline.set_visible(False)
    bar.ax.yaxis.set_major_formatter("{x:g}")
    bar.ax.yaxis.set_minor_formatter("")
    panels[3].plot(data.sensor.wavelengths, found.waves, color=LINE, linewidth=1.8)
    panels[3].set(xlabel="wavelength / nm", ylim=(0, None))
    panels[3].set_title("steepest at each wavelength", loc="left", fontsize=10)
    panels[3].margins(x=0.01)
    style_axes(panels[3])
    figure.suptitle(
        "change of reflectance per unit of linear RGB: rms over wavelength on the left; axes in 8-bit codes",
        fontsize=9,
        color="0.35",
    )
    write_png(figure, path, force=force)


def plot_locality(changes: Sequence[Change], path: Path, *, force: bool = False) -> None:
    """Draw how lattice points move over their distance from the entry that changed. Raises `OutputError`."""
    figure = new_figure(10.0, 4.0)
    left, right = figure.subplots(1, 2, sharey=True)
    _scatter(left, [change.rgb_apart for change in changes], changes)
    _scatter(right, [change.lab_apart for change in changes], changes)
    left.set(xlabel="distance from the entry, linear RGB", ylabel="ΔE00 that a lattice point moves by, FL11")
    right.set(xlabel="distance from the entry, ΔE*ab")
    right.legend(frameon=False, fontsize=9, loc="upper right")
    figure.suptitle(f"{len(changes)} entries, each left out by itself", fontsize=9, color="0.35")
    write_png(figure, path, force=force)


def _scatter(axes: Any, apart: Sequence[Any], changes: Sequence[Change]) -> None:
    """Points, and the most and the middle of them over the distance."""
    distance = np.concatenate(apart)
    moved = np.maximum(np.concatenate([change.delta_e for change in changes]), SHOWN)
    shown = moved > SHOWN
    far, high = float(distance[shown].max(initial=0.1)), max(float(moved.max()), 2 * MOVED_DELTA_E)
    axes.hexbin(
        distance[shown],
        moved[shown],
        yscale="log",
        bins="log",
        gridsize=(60, 34),
        cmap="Blues",
        linewidths=0,
        mincnt=1,
        extent=(0, far, np.log10(SHOWN), np.log10(high)),
    )
    edges = np.linspace(0, far, 41)
    place = np.digitize(distance, edges[1:-1])
    held = [bin for bin in range(40) if (place == bin).any()]
    middle = (edges[1:] + edges[:-1])[held] / 2
    axes.plot(middle, [moved[place == bin].max() for bin in held], color=LOUD, linewidth=1.6, label="most")
    axes.plot(
        middle, [np.median(moved[place == bin]) for bin in held], color=INK, linewidth=1.6, label="median"
    )
    axes.axhline(MOVED_DELTA_E, color="0.4", linewidth=0.8, linestyle=(0, (4, 3)))
    axes.annotate(
        f"ΔE00 {MOVED_DELTA_E:g}",
        (1, MOVED_DELTA_E),
        xycoords=("axes fraction", "data"),
        ha="right",
        va="bottom",
        fontsize=8,
    )
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_xlim(0, 1.05 * far)
    style_axes(axes)
