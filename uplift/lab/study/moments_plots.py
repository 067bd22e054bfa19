"""Figures of the moments study: errors over storage, and spectra with their reconstructions."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.lab.study.moments import TECHNIQUES, MomentsStudy, Technique, fine_grid
from uplift.viz.figure import figure_text, new_figure, style_axes, style_spectrum_axes, write_png

FLOATS = 9
"""Numbers stored of the spectra that are drawn, as in figures 4.1 and 4.2 of the thesis."""
PATCHES = ("neutral 5 (.70 D)", "blue flower")
"""Patches of the ColorChecker in the thesis."""
WARPED, UNWARPED = TECHNIQUES[:2]
COLOURS = {WARPED: "#d1495b", UNWARPED: "#1f6fb4"}


@dataclass(frozen=True, eq=False)
class Curve:
    """Mean and largest ΔE76 (n,) over the numbers stored (n,)."""

    floats: Array
    mean: Array
    max: Array


def curves(study: MomentsStudy) -> dict[Technique, Curve]:
    """Compute the errors of all entries together by technique."""
    by_technique = {}
    for technique in TECHNIQUES:
        results = [study.result(technique, moments) for moments in range(study.max_moments + 1)]
        points = [(result.floats, result.mean[0], result.max[0]) for result in results]
        by_technique[technique] = Curve(*np.array(points, dtype=float).T)
    return by_technique


def plot_errors(rows: Mapping[str, Mapping[Technique, Curve]], path: StrPath, *, force: bool = False) -> None:
    """Write mean and largest ΔE76 over the numbers stored as PNG, a row of panels per name. Raises `OutputError`."""
    figure = new_figure(9.0, 0.7 + 3.3 * len(rows))
    panels = figure.subplots(len(rows), 2, sharex=True, sharey=True, squeeze=False)
    for pair, (name, by_technique) in zip(panels, rows.items(), strict=True):
        for axes, key, title in zip(pair, ("mean", "max"), ("mean", "largest"), strict=True):
            _draw_curves(axes, by_technique, key)
            axes.set_title(figure_text(f"{name}: {title}"), loc="left", fontsize=10)
    for axes in panels[:, 0]:
        axes.set_ylabel("ΔE76 under D65")
    for axes in panels[-1]:
        axes.set_xlabel("numbers stored per spectrum")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=4, frameon=False)
    write_png(figure, path, force=force)


def plot_patches(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the patches of the thesis, or the first entries of other atlases, as PNG. Raises `OutputError`."""
    patches = [study.names.index(name) for name in PATCHES if name in study.names]
    _plot_spectra(study, [patches or range(min(2, len(study.names)))], path, force=force)


def plot_worst(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the worst two entries of mirroring, warped (top) and unwarped, as PNG. Raises `OutputError`."""
    errors = study.errors[: len(COLOURS), _drawn_moments(study), :, 0]
    _plot_spectra(study, [np.argsort(row)[::-1][:2] for row in errors], path, force=force)


def _draw_curves(axes: Any, curves: Mapping[Technique, Curve], key: str) -> None:
    for technique, curve in curves.items():
        axes.plot(
            curve.floats,
            getattr(curve, key),
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
    style_axes(axes)


def _plot_spectra(study: MomentsStudy, rows: Sequence[Iterable[int]], path: StrPath, *, force: bool) -> None:
    """Draw a panel for every entry; all rows have equal lengths."""
    entries = [list(row) for row in rows]
    figure = new_figure(9.0, 3.6 * len(entries))
    panels = figure.subplots(len(entries), len(entries[0]), squeeze=False)
    for axes, entry in zip(panels.flat, itertools.chain(*entries), strict=True):
        _draw_entry(axes, study, entry)
    for axes in panels[:, 1:].flat:
        axes.set_ylabel("")
    for axes in panels[:-1].flat:
        axes.set_xlabel("")
    write_png(figure, path, force=force)


def _draw_entry(axes: Any, study: MomentsStudy, entry: int) -> None:
    measured, moments = study.measured[entry : entry + 1], _drawn_moments(study)
    axes.plot(fine_grid(), measured[0], color="0.15", linewidth=3.0, alpha=0.35, label="measured")
    for technique, colour in COLOURS.items():
        coefficients = technique.moments(measured, fine_grid(), moments)
        error = study.errors[TECHNIQUES.index(technique), moments, entry, 0]
        label = f"{'warped' if technique.warped else 'unwarped'}, ΔE76 {error:.2f}"
        reconstructed = technique.reconstruct(coefficients, fine_grid())[0]
        axes.plot(fine_grid(), reconstructed, color=colour, linewidth=1.5, label=label)
    style_spectrum_axes(axes)
    # Dark entries fill their panel, with room for the legend above.
    axes.set_ylim(0, min(1.02, 1.5 * measured.max() + 0.02))
    title = f"{study.names[entry]} ({study.atlases[entry]}), mirrored, {moments + 1} numbers"
    axes.set_title(figure_text(title), loc="left", fontsize=10)
    axes.legend(frameon=False, fontsize=9)


def _drawn_moments(study: MomentsStudy) -> int:
    """Number of moments of the spectra that are drawn."""
    return min(FLOATS - 1, study.max_moments)
