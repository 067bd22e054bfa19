"""Figures of the sensitivity study: Lipschitz constants, and the effect of a removed entry over distance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.common.arrays import Array, StrPath
from uplift.cube import CubeData
from uplift.lab.study.lipschitz import LipschitzConstants
from uplift.lab.study.sensitivity import MOVED_DELTA_E, Change
from uplift.viz.figure import colour_map, new_figure, style_axes, write_png

CHANNELS = ("red", "green", "blue")
LINE, HIGHLIGHT, INK = "#1f6fb4", "#ff5a00", "#111111"
MIN_DELTA_E = 1e-4
"""Smallest ΔE00 that is drawn."""
BINS = 40
"""Bins of distance for maximum and median."""


def plot_steepness(data: CubeData, constants: LipschitzConstants, path: StrPath, *, force: bool = False) -> None:
    """Write the largest constants along each channel, and at each wavelength, as PNG. Raises `OutputError`."""
    from matplotlib.colors import LogNorm

    figure = new_figure(12.0, 3.6)
    *maps, spectrum = figure.subplots(1, 4, width_ratios=(1, 1, 1, 1.25))
    norm = LogNorm(constants.cells.min(), constants.cells.max())
    edges = np.interp(data.lattice.nodes, data.sensor.decoding, np.arange(256))
    for axis, axes in enumerate(maps):
        across, up = (other for other in range(3) if other != axis)
        mesh = axes.pcolormesh(edges, edges, constants.cells.max(axis=axis).T, cmap=colour_map(), norm=norm)
        axes.set(xlabel=CHANNELS[across], ylabel=CHANNELS[up], aspect="equal")
        axes.set_title(f"maximum over {CHANNELS[axis]}", loc="left", fontsize=10)
        axes.set_xticks((0, 128, 255))
        axes.set_yticks((0, 128, 255))
        axes.spines[:].set_visible(False)
    bar = figure.colorbar(mesh, ax=maps[2], shrink=0.85)
    bar.outline.set_visible(False)
    bar.ax.yaxis.set_major_formatter("{x:g}")
    bar.ax.yaxis.set_minor_formatter("")
    spectrum.plot(data.sensor.wavelengths, constants.wavelengths, color=LINE, linewidth=1.8)
    spectrum.set(xlabel="wavelength / nm", ylim=(0, None))
    spectrum.set_title("maximum at each wavelength", loc="left", fontsize=10)
    spectrum.margins(x=0.01)
    style_axes(spectrum)
    figure.suptitle(
        "change of reflectance per unit of linear RGB: rms over wavelength on the left; axes in 8-bit codes",
        fontsize=9,
        color="0.35",
    )
    write_png(figure, path, force=force)


def plot_locality(changes: Sequence[Change], path: StrPath, *, force: bool = False) -> None:
    """Write the changes of lattice points over the distance from the changed entry as PNG. Raises `OutputError`."""
    figure = new_figure(10.0, 4.0)
    left, right = figure.subplots(1, 2, sharey=True)
    delta_e = np.concatenate([change.delta_e for change in changes])
    _scatter(left, np.concatenate([change.rgb_distance for change in changes]), delta_e)
    _scatter(right, np.concatenate([change.lab_distance for change in changes]), delta_e)
    left.set(
        xlabel="distance from the entry, linear RGB",
        ylabel=f"ΔE00 change of a lattice point, {NARROW_BAND_LIGHT}",
    )
    right.set(xlabel="distance from the entry, ΔE*ab")
    right.legend(frameon=False, fontsize=9, loc="upper right")
    figure.suptitle(f"{len(changes)} entries, removed one at a time", fontsize=9, color="0.35")
    write_png(figure, path, force=force)


def _scatter(axes: Any, distance: Array, delta_e: Array) -> None:
    """Draw the density of points, and their maximum and median over the distance."""
    delta_e = np.maximum(delta_e, MIN_DELTA_E)
    visible = delta_e > MIN_DELTA_E
    farthest = float(distance[visible].max(initial=0.1))
    highest = max(float(delta_e.max()), 2 * MOVED_DELTA_E)
    axes.hexbin(
        distance[visible],
        delta_e[visible],
        yscale="log",
        bins="log",
        gridsize=(60, 34),
        cmap="Blues",
        linewidths=0,
        mincnt=1,
        extent=(0, farthest, np.log10(MIN_DELTA_E), np.log10(highest)),
    )
    edges = np.linspace(0, farthest, BINS + 1)
    bin_of = np.digitize(distance, edges[1:-1])
    used = [bin for bin in range(BINS) if (bin_of == bin).any()]
    centres = (edges[1:] + edges[:-1])[used] / 2
    for label, colour, statistic in (("maximum", HIGHLIGHT, np.max), ("median", INK, np.median)):
        values = [statistic(delta_e[bin_of == bin]) for bin in used]
        axes.plot(centres, values, color=colour, linewidth=1.6, label=label)
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
    axes.set_xlim(0, 1.05 * farthest)
    style_axes(axes)
