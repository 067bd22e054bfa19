"""Figures of the studies: reconstructions from moments, failures of builds, and how far
an entry affects a cube.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import NARROW_BAND_LIGHT
from uplift.extras.pages.figure import ACCENT, BAND, HIGHLIGHT, write_figure
from uplift.extras.pages.marks import density, line, threshold
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, spectra_panel
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


def plot_errors(
    rows: Mapping[str, Mapping[Technique, Array]], path: StrPath, *, force: bool = False
) -> None:
    """Write mean and largest ΔE76 over the numbers stored as PNG, a row of panels per
    name.

    Each technique has an array (n, 3) of numbers stored, mean and largest error, as of
    `MomentsStudy.curves`.
    """
    panels = []
    for name, curves in rows.items():
        for column, title in ((1, "mean"), (2, "largest")):
            marks = []
            for technique, curve in curves.items():
                style = _style(technique)
                label = technique.label
                marks.append(line(curve[:, 0], curve[:, column], label, **style))
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
    _plot_spectra(study, patches or range(min(2, len(study.names))), path, force)


def plot_worst(study: MomentsStudy, path: StrPath, *, force: bool = False) -> None:
    """Write the worst two entries of mirroring, warped (top) and unwarped, as PNG."""
    errors = study.errors[: len(COLOURS), _drawn_moments(study), :, 0]
    worst = errors.argsort(axis=1)[:, ::-1][:, :2]
    _plot_spectra(study, worst.ravel().tolist(), path, force)


def _drawn_moments(study: MomentsStudy) -> int:
    return min(FLOATS - 1, study.max_moments)


def _plot_spectra(
    study: MomentsStudy, entries: Sequence[int], path: StrPath, force: bool
) -> None:
    """Draw entries, two in a row, measured and reconstructed."""
    panels = [_spectra_panel(study, entry) for entry in entries]
    write_figure(draw(panels, 2), path, force=force)


def _spectra_panel(study: MomentsStudy, entry: int) -> Panel:
    moments = _drawn_moments(study)
    nm = samples.wavelengths()
    measured = study.measured[entry : entry + 1]
    marks = [line(nm, measured[0], "measured", BAND, linewidth=3)]
    for technique, colour in COLOURS.items():
        stored = technique.moments(measured, nm, moments)
        spectrum = technique.reconstruct(stored, nm)[0]
        error = study.errors[TECHNIQUES.index(technique), moments, entry, 0]
        label = f"{'warped' if technique.warped else 'unwarped'}, ΔE76 {error:.2f}"
        marks.append(line(nm, spectrum, label, colour))
    title = (
        f"{study.names[entry]} ({study.atlases[entry]}), mirrored, "
        f"{pluralise(moments + 1, 'number')}"
    )
    # Dark entries fill their panel, with room for the legend above.
    return spectra_panel(marks, title, min(1.02, 1.5 * measured.max() + 0.02))


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
    panels = []
    for option in PANELS:
        values = sorted({_value(run, option) for run in runs})
        dots = []
        for run in runs:
            ratio = float(np.clip(run["worst"] / run["threshold"], *RATIOS))
            row = values.index(_value(run, option))
            hollow = bool(run["stand_ins"])
            dots.append(Dot(ratio, row, colour=ACCENT, hollow=hollow))
        names = [_shown(value, option) for value in values]
        failure = threshold(1, axis="x", colour=HIGHLIGHT)
        x = Axis(log=True, limits=RATIOS)
        panels.append(Panel([failure], option, x, Axis(names=names), dots))
    title = "largest residual / threshold; 1 would be a failure"
    figure = draw(panels, len(PANELS), (1.8, 2.2), title=title)
    write_figure(figure, path, force=force)


def _value(run: Mapping[str, Any], option: str) -> Any:
    """Return the value of an option; that of a model has its coefficients."""
    if option == "model" and run["model"] != Sigmoid.name:
        return f"moments {run['coefficients']:2}"
    return run[option]


def _shown(value: Any, option: str) -> str:
    if option == "threshold":
        return f"{value:.0e}"
    return str(value).removeprefix("ITU-R ")


MIN_DELTA_E = 1e-4
"""Smallest ΔE00 that is drawn."""


def plot_locality(
    changes: Sequence[Change], path: StrPath, *, force: bool = False
) -> None:
    """Write the changes of nodes by an entry left out, over the distance from it, as
    PNG.
    """
    changes = [change for change in changes if change.description.endswith("left out")]
    delta_e = np.concatenate([change.delta_e for change in changes])
    delta_e = np.maximum(delta_e, MIN_DELTA_E)
    distances = np.concatenate(
        [change.distance for change in changes if change.distance is not None], axis=1
    )
    panels = [
        _locality_panel(distances[0], delta_e, "linear RGB"),
        _locality_panel(distances[1], delta_e, "ΔE*ab"),
    ]
    title = f"{pluralise(len(changes), 'entry')}, removed one at a time"
    figure = draw(panels, 2, title=title, share="y", legend="below")
    write_figure(figure, path, force=force)


def _locality_panel(distance: Array, delta_e: Array, unit: str) -> Panel:
    """Return the density of changes over the distance, with maximum and median."""
    highest = max(delta_e.max(), 2 * MOVED_DELTA_E)
    marks = density(distance, delta_e, MIN_DELTA_E, highest)
    marks.append(threshold(MOVED_DELTA_E, f"ΔE00 {MOVED_DELTA_E:g}"))
    x = Axis(f"distance from the entry, {unit}", limits=(0, None))
    y = Axis(f"ΔE00 change of a node, {NARROW_BAND_LIGHT}", log=True)
    return Panel(marks, "", x, y)
