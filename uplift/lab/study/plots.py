"""Figures of the studies: reconstructions from moments, failures of builds, and how far
an entry affects a cube.
"""

import itertools
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.pages.figure import (
    ACCENT,
    GREY,
    colour_map,
    figure_text,
    new_figure,
    style_axes,
    style_spectrum_axes,
    write_png,
)
from uplift.extras.scene.representations import samples
from uplift.lab.study.moments import TECHNIQUES, MomentsStudy, Technique
from uplift.lab.study.sensitivity import MOVED_DELTA_E, Change
from uplift.models import Sigmoid

FLOATS = 9
"""Numbers stored of the spectra that are drawn, as in figures 4.1 and 4.2 of the
thesis.
"""
PATCHES = ("neutral 5 (.70 D)", "blue flower")
"""Patches of the ColorChecker in the thesis."""
WARPED, UNWARPED = TECHNIQUES[:2]
COLOURS = {WARPED: "#d1495b", UNWARPED: "#1f6fb4"}
WARPED_STYLE: dict[str, Any] = {"linestyle": "-", "marker": "o"}
UNWARPED_STYLE: dict[str, Any] = {
    "linestyle": (0, (3, 1.5)),
    "marker": "s",
    "markerfacecolor": "white",
}


def plot_errors(
    rows: Mapping[str, Mapping[Technique, Array]], path: StrPath, *, force: bool = False
) -> None:
    """Write mean and largest ΔE76 over the numbers stored as PNG, a row of panels per
    name.

    Each technique has an array (n, 3) of numbers stored, mean and largest error, as of
    `MomentsStudy.curves`.
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
                    label=technique.label,
                    linewidth=1.6,
                    markersize=3.5,
                    **(WARPED_STYLE if technique.warped else UNWARPED_STYLE),
                )
            axes.set_yscale("log")
            axes.yaxis.set_major_formatter("{x:g}")
            axes.set_title(figure_text(f"{name}: {title}"), loc="left", fontsize=10)
            style_axes(axes)
    for axes in panels[:, 0]:
        axes.set_ylabel("ΔE76 under D65")
    for axes in panels[-1]:
        axes.set_xlabel("numbers stored per spectrum")
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside upper center",
        ncols=4,
        frameon=False,
    )
    write_png(figure, path, force=force)


def plot_patches(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the patches of the thesis, or other first entries, as PNG."""
    patches = [study.names.index(name) for name in PATCHES if name in study.names]
    drawn = patches or range(min(2, len(study.names)))
    _plot_spectra(study, [drawn], path, force=force)


def plot_worst(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the worst two entries of mirroring, warped (top) and unwarped, as PNG."""
    errors = study.errors[: len(COLOURS), _drawn_moments(study), :, 0]
    worst = errors.argsort(axis=1)[:, ::-1][:, :2]
    _plot_spectra(study, worst.tolist(), path, force=force)


def _drawn_moments(study: MomentsStudy) -> int:
    return min(FLOATS - 1, study.max_moments)


def _plot_spectra(
    study: MomentsStudy, rows: Sequence[Sequence[int]], path: StrPath, *, force: bool
) -> None:
    """Draw every entry, measured and reconstructed; all rows have equal lengths."""
    moments = _drawn_moments(study)
    nm = samples.wavelengths()
    figure = new_figure(9.0, 3.6 * len(rows))
    panels = figure.subplots(len(rows), len(rows[0]), squeeze=False)
    for axes, entry in zip(panels.flat, itertools.chain(*rows), strict=True):
        measured = study.measured[entry : entry + 1]
        style: dict[str, Any] = {"color": "0.15", "linewidth": 3.0, "alpha": 0.35}
        axes.plot(nm, measured[0], label="measured", **style)
        for technique, colour in COLOURS.items():
            stored = technique.moments(measured, nm, moments)
            spectrum = technique.reconstruct(stored, nm)[0]
            error = study.errors[TECHNIQUES.index(technique), moments, entry, 0]
            label = f"{'warped' if technique.warped else 'unwarped'}, ΔE76 {error:.2f}"
            axes.plot(nm, spectrum, color=colour, linewidth=1.5, label=label)
        style_spectrum_axes(axes)
        # Dark entries fill their panel, with room for the legend above.
        axes.set_ylim(0, min(1.02, 1.5 * measured.max() + 0.02))
        title = (
            f"{study.names[entry]} ({study.atlases[entry]}), mirrored, "
            f"{pluralise(moments + 1, 'number')}"
        )
        axes.set_title(figure_text(title), loc="left", fontsize=10)
        axes.legend(frameon=False, fontsize=9)
    for axes in panels[:, 1:].flat:
        axes.set_ylabel("")
    for axes in panels[:-1].flat:
        axes.set_xlabel("")
    write_png(figure, path, force=force)


PANELS = ("model", "space", "threshold", "dim", "atlas")
"""Options of builds, each with a panel in the figure of failures."""
RATIOS = (1e-3, 3.0)
"""Range of that figure: largest residual over the threshold; smaller ones are drawn at
its left end.
"""


def plot_map(
    runs: Sequence[Mapping[str, Any]], path: StrPath, *, force: bool = False
) -> None:
    """Write the largest residual of realisable nodes over the threshold as PNG: a dot
    for each build, in every panel.

    Dots to the right of the line are failures, hollow ones builds with failed stand-ins
    of unrealisable nodes. ``runs`` are records of `uplift.lab.study.stability.run`.
    """
    ratios = np.clip([run["worst"] / run["threshold"] for run in runs], *RATIOS)
    faces = ["white" if run["stand_ins"] else ACCENT for run in runs]
    figure = new_figure(11.0, 2.9)
    panels = figure.subplots(1, len(PANELS), sharex=True)
    for axes, option in zip(panels, PANELS, strict=True):
        of_run = [run[option] for run in runs]
        if option == "model":
            of_run = list(map(_model_label, runs))
        values = sorted(set(of_run))
        rows = list(map(values.index, of_run))
        axes.axvline(1, color=HIGHLIGHT, linewidth=1)
        axes.scatter(
            ratios,
            rows,
            s=22,
            facecolors=faces,
            edgecolors=ACCENT,
            linewidths=0.8,
            alpha=0.6,
            clip_on=False,
        )
        ticks = [str(value).removeprefix("ITU-R ") for value in values]
        if option == "threshold":
            ticks = [f"{value:.0e}" for value in values]
        axes.set_yticks(range(len(ticks)), map(figure_text, ticks), fontsize=9)
        axes.set(xscale="log", xlim=RATIOS, ylim=(len(ticks) - 0.5, -0.5))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.set_title(option, loc="left", fontsize=10)
        style_axes(axes)
    figure.supxlabel(
        "largest residual / threshold; 1 would be a failure", fontsize=9, color=GREY
    )
    write_png(figure, path, force=force)


def _model_label(run: Mapping[str, Any]) -> str:
    if run["model"] == Sigmoid.name:
        return Sigmoid.name
    return f"moments {run['coefficients']:2}"


HIGHLIGHT = "#ff5a00"
MIN_DELTA_E = 1e-4
"""Smallest ΔE00 that is drawn."""
BINS = 40
"""Bins of distance for maximum and median."""


def plot_locality(
    changes: Sequence[Change], path: StrPath, *, force: bool = False
) -> None:
    """Write the changes of nodes by an entry left out, over the distance from it, as
    PNG.
    """
    changes = [change for change in changes if change.description.endswith("left out")]
    figure = new_figure(10.0, 4.0)
    panels = figure.subplots(1, 2, sharey=True)
    delta_e = np.concatenate([change.delta_e for change in changes])
    delta_e = np.maximum(delta_e, MIN_DELTA_E)
    distances = np.concatenate(
        [change.distance for change in changes if change.distance is not None], axis=1
    )
    units = ("linear RGB", "ΔE*ab")
    for axes, distance, unit in zip(panels, distances, units, strict=True):
        _scatter(axes, distance, delta_e)
        axes.set(xlabel=f"distance from the entry, {unit}")
    panels[0].set(ylabel=f"ΔE00 change of a node, {NARROW_BAND_LIGHT}")
    panels[1].legend(frameon=False, fontsize=9, loc="upper right")
    figure.suptitle(
        f"{pluralise(len(changes), 'entry')}, removed one at a time",
        fontsize=9,
        color="0.35",
    )
    write_png(figure, path, force=force)


def _scatter(axes: Any, distance: Array, delta_e: Array) -> None:
    """Draw the density of points, and their maximum and median over the distance."""
    visible = delta_e > MIN_DELTA_E
    farthest = distance[visible].max(initial=0.1)
    highest = max(delta_e.max(), 2 * MOVED_DELTA_E)
    extent = (0, farthest, np.log10(MIN_DELTA_E), np.log10(highest))
    axes.hexbin(
        distance[visible],
        delta_e[visible],
        yscale="log",
        bins="log",
        extent=extent,
        gridsize=(60, 34),
        cmap=colour_map(),
        linewidths=0,
        mincnt=1,
    )
    edges = np.linspace(0, farthest, BINS + 1)
    bin_of = np.digitize(distance, edges[1:-1])
    used = np.unique(bin_of)
    centres = (edges[1:] + edges[:-1])[used] / 2
    for label, colour, statistic in (
        ("maximum", HIGHLIGHT, np.max),
        ("median", "#111111", np.median),
    ):
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
