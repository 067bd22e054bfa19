"""Figures of the studies: reconstructions from moments, heat maps of failures, steepness and locality of cubes."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from uplift.colorimetry.lights import NARROW_BAND_LIGHT
from uplift.common.arrays import Array, StrPath
from uplift.cube import CubeData
from uplift.lab.study.lipschitz import LipschitzConstants
from uplift.lab.study.moments import TECHNIQUES, MomentsStudy, Technique, fine_grid
from uplift.lab.study.sensitivity import MOVED_DELTA_E, Change
from uplift.lab.study.stability import Grid, Record, RunConfig
from uplift.viz.figure import colour_map, figure_text, new_figure, style_axes, style_spectrum_axes, write_png

FLOATS = 9
"""Numbers stored of the spectra that are drawn, as in figures 4.1 and 4.2 of the thesis."""
PATCHES = ("neutral 5 (.70 D)", "blue flower")
"""Patches of the ColorChecker in the thesis."""
WARPED, UNWARPED = TECHNIQUES[:2]
COLOURS = {WARPED: "#d1495b", UNWARPED: "#1f6fb4"}


def plot_errors(rows: Mapping[str, Mapping[Technique, Array]], path: StrPath, *, force: bool = False) -> None:
    """Write mean and largest ΔE76 over the numbers stored as PNG, a row of panels per name.

    Each technique has an array (n, 3) of numbers stored, mean and largest error, as of `MomentsStudy.curves`.
    """
    figure = new_figure(9.0, 0.7 + 3.3 * len(rows))
    panels = figure.subplots(len(rows), 2, sharex=True, sharey=True, squeeze=False)
    for pair, (name, curves) in zip(panels, rows.items(), strict=True):
        for axes, column, title in zip(pair, (1, 2), ("mean", "largest"), strict=True):
            for technique, curve in curves.items():
                axes.plot(
                    curve[:, 0],
                    curve[:, column],
                    color="#1f6fb4" if technique.mirrored else "#d98200",
                    linestyle="-" if technique.warped else (0, (3, 1.5)),
                    linewidth=1.6,
                    marker="o" if technique.warped else "s",
                    markersize=3.5,
                    markerfacecolor=None if technique.warped else "white",
                    label=technique.label,
                )
            axes.set_yscale("log")
            axes.yaxis.set_major_formatter("{x:g}")
            axes.set_title(figure_text(f"{name}: {title}"), loc="left", fontsize=10)
            style_axes(axes)
    for axes in panels[:, 0]:
        axes.set_ylabel("ΔE76 under D65")
    for axes in panels[-1]:
        axes.set_xlabel("numbers stored per spectrum")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False)
    write_png(figure, path, force=force)


def plot_patches(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the patches of the thesis, or the first entries of other atlases, as PNG."""
    patches = [study.names.index(name) for name in PATCHES if name in study.names]
    _plot_spectra(study, [patches or range(min(2, len(study.names)))], path, force=force)


def plot_worst(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the worst two entries of mirroring, warped (top) and unwarped, as PNG."""
    errors = study.errors[: len(COLOURS), _drawn_moments(study), :, 0]
    _plot_spectra(study, [np.argsort(row)[::-1][:2] for row in errors], path, force=force)


def _drawn_moments(study: MomentsStudy) -> int:
    return min(FLOATS - 1, study.max_moments)


def _plot_spectra(study: MomentsStudy, rows: Sequence[Iterable[int]], path: StrPath, *, force: bool) -> None:
    """Draw a panel for every entry, measured and reconstructed; all rows have equal lengths."""
    entries, moments = [list(row) for row in rows], _drawn_moments(study)
    figure = new_figure(9.0, 3.6 * len(entries))
    panels = figure.subplots(len(entries), len(entries[0]), squeeze=False)
    for axes, entry in zip(panels.flat, itertools.chain(*entries), strict=True):
        measured = study.measured[entry : entry + 1]
        axes.plot(fine_grid(), measured[0], color="0.15", linewidth=3.0, alpha=0.35, label="measured")
        for technique, colour in COLOURS.items():
            found = technique.reconstruct(technique.moments(measured, fine_grid(), moments), fine_grid())[0]
            error = study.errors[TECHNIQUES.index(technique), moments, entry, 0]
            label = f"{'warped' if technique.warped else 'unwarped'}, ΔE76 {error:.2f}"
            axes.plot(fine_grid(), found, color=colour, linewidth=1.5, label=label)
        style_spectrum_axes(axes)
        # Dark entries fill their panel, with room for the legend above.
        axes.set_ylim(0, min(1.02, 1.5 * measured.max() + 0.02))
        title = f"{study.names[entry]} ({study.atlases[entry]}), mirrored, {moments + 1} numbers"
        axes.set_title(figure_text(title), loc="left", fontsize=10)
        axes.legend(frameon=False, fontsize=9)
    for axes in panels[:, 1:].flat:
        axes.set_ylabel("")
    for axes in panels[:-1].flat:
        axes.set_xlabel("")
    write_png(figure, path, force=force)


HIGHLIGHT, FAINT, DARK = "#ff5a00", "#ffcfae", "#1b2733"
CELL_WIDTH, CELL_HEIGHT = 0.56, 0.34
"""Inches."""
FAILURES = "unfitted points (stand-ins)"
Panel = tuple[Callable[[Record], float], tuple[float, float], Callable[[Record], str]]
PANELS: dict[str, Panel] = {
    FAILURES: (
        lambda run: 0,
        (1, 10),
        lambda run: f"{run['unfitted']} ({run['stand_ins']})" if run["stand_ins"] else f"{run['unfitted'] or '·'}",
    ),
    "worst distance / threshold": (
        lambda run: run["worst"] / run["threshold"],
        (1e-2, 1),
        lambda run: f"{run['worst'] / run['threshold']:.2g}",
    ),
    "rounds / improvement calls": (
        lambda run: 1 + run["rounds"] + run["calls"],
        (1, 1e3),
        lambda run: f"{run['rounds']}/{run['calls']}" if run["rounds"] or run["calls"] else "·",
    ),
    "seconds": (lambda run: run["seconds"], (0.1, 100), lambda run: f"{run['seconds']:.2g}"),
}
"""Columns of the failure map: value of a build, range of the logarithmic scale of colours, and text."""


def plot_map(grids: Sequence[Grid], results: Mapping[RunConfig, Record], path: StrPath, *, force: bool = False) -> None:
    """Write heat maps with numbers as PNG, a row per grid; orange marks failed nodes, pale orange failed stand-ins."""
    heights = [len(grid.rows) * CELL_HEIGHT + 0.75 for grid in grids]
    width = max(len(grid.rows[0]) for grid in grids) * CELL_WIDTH + 0.3
    figure = new_figure(1.2 + len(PANELS) * width, sum(heights))
    panels = figure.subplots(len(grids), len(PANELS), squeeze=False, height_ratios=heights)
    for row, grid in zip(panels, grids, strict=True):
        table = [[results[config] for config in configs] for configs in grid.rows]
        ticks = [_short(getattr(config, grid.axis)) for config in grid.rows[0]]
        for axes, title in zip(row, PANELS, strict=True):
            _draw_panel(axes, table, title)
            axes.set_xticks(range(len(ticks)), ticks, fontsize=8)
        row[0].set_title(grid.title, loc="left", fontsize=9, color=DARK)
        row[0].set_yticks(range(len(table)), [figure_text(configs[0].model_label) for configs in grid.rows])
    for axes, title in zip(panels[0], PANELS, strict=True):
        axes.text(0, 1.32, title, transform=axes.transAxes, weight="bold", color=DARK)
    write_png(figure, path, force=force)


def _draw_panel(axes: Any, table: list[list[Record]], title: str) -> None:
    from matplotlib.colors import to_rgb

    value, (low, high), text = PANELS[title]
    values = np.array([[max(value(run), low) for run in row] for row in table])
    values = np.clip(np.log10(values / low) / np.log10(high / low), 0, 1)
    failed = np.array([[run["unfitted"] > 0 for run in row] for row in table])
    stand_ins = np.array([[run["stand_ins"] > 0 and title == FAILURES for run in row] for row in table])
    colours = np.where(stand_ins[..., None], to_rgb(FAINT), colour_map()(values)[..., :3])
    colours = np.where(failed[..., None], to_rgb(HIGHLIGHT), colours)
    axes.imshow(colours, aspect="auto", interpolation="nearest")
    for (row, column), level in np.ndenumerate(values):
        colour = "white" if level > 0.55 and not failed[row, column] else DARK
        axes.text(column, row, text(table[row][column]), ha="center", va="center", fontsize=7.5, color=colour)
    axes.set_yticks([])
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.set_xticks(np.arange(len(table[0]) - 1) + 0.5, minor=True)
    axes.set_yticks(np.arange(len(table) - 1) + 0.5, minor=True)
    axes.grid(which="minor", color="white", linewidth=1.5)
    axes.tick_params(which="minor", length=0)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.0e}".replace("e-0", "e-")
    return figure_text(str(value).removeprefix("ITU-R ").removesuffix(" RGB"))


CHANNELS = ("red", "green", "blue")
MIN_DELTA_E = 1e-4
"""Smallest ΔE00 that is drawn."""
BINS = 40
"""Bins of distance for maximum and median."""


def plot_steepness(data: CubeData, constants: LipschitzConstants, path: StrPath, *, force: bool = False) -> None:
    """Write the largest constants along each channel, and at each wavelength, as PNG."""
    from matplotlib.colors import LogNorm

    figure = new_figure(12.0, 3.6)
    *maps, spectrum = figure.subplots(1, 4, width_ratios=(1, 1, 1, 1.25))
    norm = LogNorm(constants.cells.min(), constants.cells.max())
    edges = np.interp(data.lattice.nodes, data.sensor.decoding, np.arange(256))
    for axis, axes in enumerate(maps):
        across, up = (other for other in range(3) if other != axis)
        mesh = axes.pcolormesh(edges, edges, constants.cells.max(axis=axis).T, cmap=colour_map(), norm=norm)
        axes.set(
            xlabel=CHANNELS[across], ylabel=CHANNELS[up], aspect="equal", xticks=(0, 128, 255), yticks=(0, 128, 255)
        )
        axes.set_title(f"maximum over {CHANNELS[axis]}", loc="left", fontsize=10)
        axes.spines[:].set_visible(False)
    bar = figure.colorbar(mesh, ax=maps[2], shrink=0.85)
    bar.outline.set_visible(False)
    bar.ax.yaxis.set_major_formatter("{x:g}")
    bar.ax.yaxis.set_minor_formatter("")
    spectrum.plot(data.sensor.wavelengths, constants.wavelengths, color="#1f6fb4", linewidth=1.8)
    spectrum.set(xlabel="wavelength / nm", ylim=(0, None))
    spectrum.set_title("maximum at each wavelength", loc="left", fontsize=10)
    spectrum.margins(x=0.01)
    style_axes(spectrum)
    title = "change of reflectance per unit of linear RGB: rms over wavelength on the left; axes in 8-bit codes"
    figure.suptitle(title, fontsize=9, color="0.35")
    write_png(figure, path, force=force)


def plot_locality(changes: Sequence[Change], path: StrPath, *, force: bool = False) -> None:
    """Write the changes of nodes over the distance from the changed entry as PNG."""
    figure = new_figure(10.0, 4.0)
    panels = figure.subplots(1, 2, sharey=True)
    delta_e = np.maximum(np.concatenate([change.delta_e for change in changes]), MIN_DELTA_E)
    distances = np.concatenate([change.distance for change in changes if change.distance is not None], axis=1)
    for axes, distance, unit in zip(panels, distances, ("linear RGB", "ΔE*ab"), strict=True):
        _scatter(axes, distance, delta_e)
        axes.set(xlabel=f"distance from the entry, {unit}")
    panels[0].set(ylabel=f"ΔE00 change of a lattice point, {NARROW_BAND_LIGHT}")
    panels[1].legend(frameon=False, fontsize=9, loc="upper right")
    figure.suptitle(f"{len(changes)} entries, removed one at a time", fontsize=9, color="0.35")
    write_png(figure, path, force=force)


def _scatter(axes: Any, distance: Array, delta_e: Array) -> None:
    """Draw the density of points, and their maximum and median over the distance."""
    visible = delta_e > MIN_DELTA_E
    farthest = float(distance[visible].max(initial=0.1))
    highest = max(float(delta_e.max()), 2 * MOVED_DELTA_E)
    extent = (0, farthest, np.log10(MIN_DELTA_E), np.log10(highest))
    style: dict[str, Any] = {"gridsize": (60, 34), "cmap": "Blues", "linewidths": 0, "mincnt": 1}
    axes.hexbin(distance[visible], delta_e[visible], yscale="log", bins="log", extent=extent, **style)
    edges = np.linspace(0, farthest, BINS + 1)
    bin_of = np.digitize(distance, edges[1:-1])
    used = np.unique(bin_of)
    centres = (edges[1:] + edges[:-1])[used] / 2
    for label, colour, statistic in (("maximum", HIGHLIGHT, np.max), ("median", "#111111", np.median)):
        values = [statistic(delta_e[bin_of == bin]) for bin in used]
        axes.plot(centres, values, color=colour, linewidth=1.6, label=label)
    axes.axhline(MOVED_DELTA_E, color="0.4", linewidth=0.8, linestyle=(0, (4, 3)))
    place: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "ha": "right", "va": "bottom", "fontsize": 8}
    axes.annotate(f"ΔE00 {MOVED_DELTA_E:g}", (1, MOVED_DELTA_E), **place)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_xlim(0, 1.05 * farthest)
    style_axes(axes)
