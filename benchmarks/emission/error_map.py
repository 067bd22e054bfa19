"""Picture of the expected error over chromaticity, and of the errors of lamps that were left out."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lights.fit import unit_xyz
from uplift.lights.lattice import chromaticity
from uplift.lights.lookup import EmissionTable
from uplift.viz.figure import GREY, INK, new_figure, rendered, write_png
from uplift.viz.scatter import Label, draw_labels

SIZE = 320
"""Points of the map along u′."""
WIDTH, HEIGHT = 0.65, 0.62
"""Range of u′ and v′."""
MARGIN = 0.03
"""Distance in u′v′ around the lamps that the second panel shows."""
LABELLED = 8
"""Lamps with the largest errors, which are named."""


def draw(table: EmissionTable, names: tuple[str, ...], power: Array, errors: Array, path: Path) -> None:
    """Write the picture.

    Parameters
    ----------
    table : EmissionTable
        Table of the map.
    names : tuple of str
        L lamps.
    power : ndarray, shape (L, N)
        Their power.
    errors : ndarray, shape (L,)
        Mean ΔE00 of the ColorChecker lit by the table that does not know the lamp.
    path : Path
        PNG file.
    """
    expected, uv = expected_errors(table), chromaticity(power @ table.data.cmfs)
    limit = float(np.nanmax(expected))
    figure = new_figure(11, 5.4)
    left, right = figure.subplots(1, 2)
    shown = left.imshow(expected, origin="lower", extent=(0, WIDTH, 0, HEIGHT), cmap="viridis", vmin=0, vmax=limit)
    left.plot(*uv.T, ".", color="white", markersize=2.5)
    left.set_title("expected by the table; points are its lamps")
    right.scatter(*uv.T, c=errors, s=16, cmap="viridis", vmin=0, vmax=limit, edgecolors=INK, linewidths=0.3)
    right.set_title("measured: each lamp left out")
    for axes in (left, right):
        _diagram(axes, table)
    low, high = uv.min(axis=0) - MARGIN, uv.max(axis=0) + MARGIN
    right.set_xlim(low[0], high[0])
    right.set_ylim(low[1], high[1])
    bar = figure.colorbar(shown, ax=[left, right], shrink=0.85, extend="max")
    bar.set_label("mean ΔE00 of the ColorChecker")
    rendered(figure)  # the layout decides where labels have room
    figure.set_layout_engine("none")
    largest = np.argsort(errors)[::-1][:LABELLED]
    labels = [Label(names[row], (uv[row, 0], uv[row, 1]), INK, bold=False, gid="") for row in largest]
    draw_labels(right, labels, uv, np.empty((0, 2)))
    write_png(figure, path, force=True)


def expected_errors(table: EmissionTable, size: int = SIZE) -> Array:
    """Return the expected errors over u′v′, row by row from v′ = 0; NaN where no light is."""
    u = (np.arange(size) + 0.5) / size * WIDTH
    v = (np.arange(round(size * HEIGHT / WIDTH)) + 0.5) / size * WIDTH
    uv = np.stack(np.meshgrid(u, v), axis=-1)
    flat = uv.reshape(-1, 2)
    inside = table.data.lattice.contains(flat)
    found = np.full(len(flat), np.nan)
    xyz = unit_xyz(flat[inside])
    found[inside] = table.expected_error(table.rgb_of_xyz(xyz))
    return found.reshape(uv.shape[:2])


def _diagram(axes: Any, table: EmissionTable) -> None:
    """Draw the spectral locus and the triangle of the space."""
    knots = table.data.lattice.knots
    axes.plot(*np.concatenate([knots, knots[:1]]).T, color=INK, linewidth=0.8)
    corners = chromaticity(table.rgb_to_xyz.T)
    axes.plot(*np.concatenate([corners, corners[:1]]).T, color=GREY, linewidth=0.7, linestyle="--")
    axes.set_aspect("equal")
    axes.set_xlim(0, WIDTH)
    axes.set_ylim(0, HEIGHT)
    axes.set_xlabel("u′")
    axes.spines[["top", "right"]].set_visible(False)
    axes.set_ylabel("v′")
