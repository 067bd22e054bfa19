"""Figures of the studies: reconstructions from moments, failures of builds, and how far
an entry affects a cube.
"""

from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import Any

import numpy as np

from uplift.common.arrays import StrPath
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.pages.figure import ACCENT, BAND, HIGHLIGHT, write_figure
from uplift.extras.pages.marks import density, line, threshold
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, spectra_panel
from uplift.extras.papers.representations import samples
from uplift.lab.runner import Row
from uplift.lab.study.moments import (
    ALL_ATLASES,
    TECHNIQUES,
    MomentsStudy,
    Technique,
)
from uplift.lab.study.sensitivity import MOVED_DELTA_E, Change

FLOATS = 9
"""Numbers stored of the spectra that are drawn, as in figures 4.1 and 4.2 of the
thesis.
"""
PATCHES = ("neutral 5 (.70 D)", "blue flower")
"""Patches of the ColorChecker in the thesis."""
COLOURS = dict(zip(TECHNIQUES, ("#d1495b", "#1f6fb4"), strict=False))
"""Colours of the mirrored techniques."""
KIND = itemgetter("atlas", "mirrored", "warped")


def plot_errors(
    sets: Mapping[str, Sequence[Row]], path: StrPath, *, force: bool = False
) -> None:
    """Write mean and largest ΔE76 over the numbers stored as PNG, a row of panels for
    the rows of each name, as of `MomentsStudy.rows`.
    """
    panels = []
    for name, rows in sets.items():
        for statistic, title in (("mean", "mean"), ("max", "largest")):
            marks = []
            for technique in TECHNIQUES:
                kind = (ALL_ATLASES, technique.mirrored, technique.warped)
                drawn = [row for row in rows if KIND(row) == kind]
                floats = [row["floats"] for row in drawn]
                errors = [row[f"delta_e_76_D65_{statistic}"] for row in drawn]
                marks.append(line(floats, errors, technique.label, **_style(technique)))
            x = Axis("numbers stored per spectrum")
            y = Axis("ΔE76 under D65", log=True)
            panels.append(Panel(marks, f"{name}: {title}", x, y))
    figure = draw(panels, 2, legend="above", share="xy")
    write_figure(figure, path, force=force)


def _style(technique: Technique) -> dict[str, Any]:
    """Return the line of a technique: solid if it warps, blue if it mirrors."""
    return {
        "colour": "#1f6fb4" if technique.mirrored else "#d98200",
        "linestyle": "-" if technique.warped else (0, (3, 1.5)),
        "marker": "o" if technique.warped else "s",
        "markerfacecolor": None if technique.warped else "white",
        "markersize": 3.5,
    }


def plot_patches(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the patches of the thesis, or other first entries, as PNG."""
    patches = [study.names.index(name) for name in PATCHES if name in study.names]
    _plot_spectra(study, patches or range(len(study.names))[:2], path, force)


def plot_worst(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the worst two entries of mirroring, warped (top) and unwarped, as PNG."""
    errors = study.errors[: len(COLOURS), _drawn_moments(study), :, 0]
    worst = errors.argsort(axis=1)[:, ::-1][:, :2]
    _plot_spectra(study, worst.ravel().tolist(), path, force)


def _drawn_moments(study: MomentsStudy) -> int:
    return min(FLOATS, study.errors.shape[1]) - 1


def _plot_spectra(
    study: MomentsStudy, entries: Sequence[int], path: StrPath, force: bool
) -> None:
    """Draw entries, two in a row, measured and reconstructed."""
    moments = _drawn_moments(study)
    nm = samples.wavelengths()
    panels = []
    for entry in entries:
        measured = study.measured[entry : entry + 1]
        marks = [line(nm, measured[0], "measured", BAND, linewidth=3)]
        for number, (technique, colour) in enumerate(COLOURS.items()):
            stored = technique.moments(measured, nm, moments)
            spectrum = technique.reconstruct(stored, nm)[0]
            error = study.errors[number, moments, entry, 0]
            warp = technique.label.removeprefix("mirrored, ")
            marks.append(line(nm, spectrum, f"{warp}, ΔE76 {error:.2f}", colour))
        stored_as = f"mirrored, {pluralise(moments + 1, 'number')}"
        title = f"{study.names[entry]} ({study.atlases[entry]}), {stored_as}"
        # Dark entries fill their panel, with room for the legend above.
        top = min(1.02, 1.5 * measured.max() + 0.02)
        panels.append(spectra_panel(marks, title, top))
    write_figure(draw(panels, 2), path, force=force)


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
    of unrealisable nodes. ``runs`` are rows of `uplift.lab.study.stability.evaluate`.
    """
    failure = threshold(1, axis="x", colour=HIGHLIGHT)
    x = Axis(log=True, limits=RATIOS)
    variants = [f"{run['model']} {run['coefficients']:2}" for run in runs]
    panels = []
    for option in PANELS:
        of_runs = variants if option == "model" else [run[option] for run in runs]
        values = sorted(set(of_runs))
        dots = []
        for run, value in zip(runs, of_runs, strict=True):
            ratio = float(np.clip(run["worst"] / run["threshold"], *RATIOS))
            hollow = bool(run["stand_ins"])
            dots.append(Dot(ratio, values.index(value), colour=ACCENT, hollow=hollow))
        y = Axis(names=[str(value).removeprefix("ITU-R ") for value in values])
        panels.append(Panel([failure], option, x, y, dots))
    title = "largest residual / threshold; 1 would be a failure"
    figure = draw(panels, len(PANELS), (1.8, 2.2), title=title)
    write_figure(figure, path, force=force)


MIN_DELTA_E = 1e-4
"""Smallest ΔE00 that is drawn."""


def plot_locality(
    changes: Sequence[Change], path: StrPath, *, force: bool = False
) -> None:
    """Write the changes of nodes by an entry left out, over the distance from it, as
    PNG.
    """
    removed = [change for change in changes if change.description.endswith("left out")]
    delta_e = np.concatenate([change.delta_e for change in removed])
    distances = np.concatenate([change.distance for change in removed], axis=1)
    highest = max(delta_e.max(), 2 * MOVED_DELTA_E)
    y = Axis(f"ΔE00 change of a node, {NARROW_BAND_LIGHT}", log=True)
    panels = []
    for unit, distance in zip(("linear RGB", "ΔE*ab"), distances, strict=True):
        drawn = np.maximum(delta_e, MIN_DELTA_E)
        marks = density(distance, drawn, MIN_DELTA_E, highest)
        marks.append(threshold(MOVED_DELTA_E, f"ΔE00 {MOVED_DELTA_E:g}"))
        x = Axis(f"distance from the entry, {unit}", limits=(0, None))
        panels.append(Panel(marks, "", x, y))
    title = f"{pluralise(len(removed), 'entry')}, removed one at a time"
    figure = draw(panels, 2, title=title, share="y", legend="below")
    write_figure(figure, path, force=force)
