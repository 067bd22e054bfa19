"""Plots of bounds: all colours of the metamers of a colour under other lights, in a* and b*."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import lab_to_xyz
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.lookup import Bounds, Cube
from uplift.lookup.light_errors import LIKELY
from uplift.viz.figure import ACCENT, GREY, INK, new_figure, style_axes, write_figure

MAX_COLOURS = 24
"""Largest number of colours in one plot."""
PIXELS = 160
"""Pixels of the colours in a region, along each side."""
MARGIN = 0.06
"""Space around a region, as a share of its size."""
MIN_EXTENT = 5.0
"""Smallest extent of an axis in a* or b*."""


def plot_bounds(
    cube: Cube, blocks: Sequence[Sequence[Bounds]], path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Plot the region of each colour under each light, as PNG, SVG or PDF: a row per colour, a column per light.

    Parameters
    ----------
    cube : Cube
        The cube that was queried.
    blocks : sequence of sequence of Bounds
        Blocks of colours, each with the bounds under the lights. The first `MAX_COLOURS` colours are drawn.
    path : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    panels = [(found, row) for found in blocks for row in range(len(found[0].xyz))][:MAX_COLOURS]
    names = [each.light.name for each in panels[0][0]]
    screens = display_sensors(names, cube.observer, *cube.data.sensor.range)
    lights = len(names)
    figure = new_figure(3.1 * lights, 3.1 * len(panels))
    axes = figure.subplots(len(panels), lights, squeeze=False)
    for line, (found, row) in zip(axes, panels, strict=True):
        for each, screen, bounds in zip(line, screens, found, strict=True):
            _plot_region(each, screen, bounds, row)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    write_figure(figure, path, force=force)


def _plot_region(axes: Any, screen: Sensor, bounds: Bounds, row: int) -> None:
    region, answer = bounds.outline(row), bounds.lab[row]
    likely = bounds.likely(row)
    extent = _extent(np.concatenate([region, answer[None, 1:], *([] if likely is None else [likely])]))
    (patch,) = axes.fill(*region.T, facecolor="none", edgecolor=INK, linewidth=1.0, label="all reflectances")
    image = axes.imshow(_colours(screen, extent, answer[0]), extent=extent.ravel(), origin="lower", zorder=0.5)
    image.set_clip_path(patch)
    if likely is not None:
        axes.fill(*likely.T, facecolor="none", edgecolor=ACCENT, linewidth=1.4, label=f"likely {LIKELY:.0%}")
    axes.plot(*answer[1:], "o", color=INK, markersize=5, markeredgecolor="white", label="answer")
    axes.set(xlim=extent[0], ylim=extent[1], aspect="equal", xlabel="a*", ylabel="b*")
    largest = bounds.largest.delta_e_2000[row]
    axes.set_title(f"{bounds.light.name}: ΔE00 up to {largest:.1f}", color=GREY, fontsize=9)
    style_axes(axes)


def _extent(points: Array) -> Array:
    """Limits (2, 2) of a* and b* of a square around points (n, 2)."""
    low, high = points.min(axis=0), points.max(axis=0)
    half = max(float((high - low).max()) * (0.5 + MARGIN), MIN_EXTENT / 2)
    middle = (low + high) / 2
    return np.stack([middle - half, middle + half], axis=1)


def _colours(screen: Sensor, extent: Array, lightness: float) -> Array:
    """Colours (P, P, 3) on a screen of one lightness over a* and b*; those outside its gamut are desaturated."""
    a, b = (np.linspace(low, high, PIXELS) for low, high in extent.tolist())
    lab = np.stack(np.broadcast_arrays(lightness, a[None, :], b[:, None]), axis=-1)
    linear = lab_to_xyz(lab.reshape(-1, 3), screen.light.white) @ screen.xyz_to_rgb.T
    return to_display_codes(linear, SRGB).reshape(PIXELS, PIXELS, 3) / 255
