"""A palette as pictures: its matrix of three-way patches (Bergner, figure 2), and its spectra."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from uplift.colorimetry.srgb import hex_codes
from uplift.common.arrays import Array
from uplift.design.palette.design import Design
from uplift.design.palette.matrix import Matrix
from uplift.design.palette.palette import SpectrumSpec
from uplift.viz.figure import BAND, GREY, INK, new_figure, style_axes, write_png

CELL, NAMES, TOP = (1.5, 1.0), 1.35, 0.75
"""Inches of a cell, of the column of names, and of the row of lights."""
PATCH, SMALL = (0.92, 0.66), 8.0
"""Shares of the cell that a patch takes; points of the numbers below it."""
NARROWEST = 5.2
"""Inches that the key takes."""
KEY = "left: wanted; right: obtained, above by spectra,\nbelow by factor model; ΔE00 from wish, of model"
LONGEST = 18
"""Characters of a name that fit."""


def plot_matrix(found: Design, colours: Matrix, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Wanted colours on the left of each patch, obtained ones right above, the factor model's right below, as a PNG."""
    rows, columns = colours.delta_e.shape
    width, height = max(NAMES + CELL[0] * columns, NARROWEST), TOP + CELL[1] * rows + 0.4
    figure = new_figure(width, height, layout=None)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    for column, (part, white) in enumerate(zip(found.palette.lights, colours.whites, strict=True)):
        x = NAMES + CELL[0] * column
        _patch(axes, (x, TOP - 0.22), (CELL[0] * PATCH[0], 0.14), _fitting(white))
        _frame(axes, (x, TOP - 0.22), (CELL[0] * PATCH[0], 0.14))
        _name(axes, (x, TOP - 0.36), part, ha="left")
    for row, part in enumerate(found.palette.materials):
        _name(axes, (NAMES - 0.12, TOP + CELL[1] * (row + PATCH[1] / 2)), part, ha="right")
        for column in range(columns):
            _cell(axes, (NAMES + CELL[0] * column, TOP + CELL[1] * row), colours, (row, column))
    axes.text(NAMES, height - 0.24, KEY, fontsize=SMALL, color=GREY, va="center")
    write_png(figure, path, force=force)


def plot_spectra(found: Design, path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Powers of the lights and reflectances of the materials over wavelength as a PNG; dashed what was given."""
    figure = new_figure(10.0, 3.8)
    for axes, title, label, parts, samples in zip(
        figure.subplots(1, 2),
        ("lights", "materials"),
        ("power", "reflectance"),
        (found.palette.lights, found.palette.materials),
        (found.powers, found.reflectances),
        strict=True,
    ):
        _lines(axes, found.palette.sensor.wavelengths, parts, samples)
        axes.set(xlabel="wavelength / nm", ylabel=label)
        axes.set_title(title, loc="left", fontsize=10, fontweight="bold", color=INK)
    write_png(figure, path, force=force)


def _cell(axes: Any, corner: tuple[float, float], colours: Matrix, at: tuple[int, int]) -> None:
    (x, y), (width, height) = corner, (CELL[0] * PATCH[0], CELL[1] * PATCH[1])
    wished = not np.isnan(colours.delta_e[at])
    split = width / 2 if wished else 0.0
    if wished:
        _patch(axes, (x, y), (split, height), colours.target[at])
    _patch(axes, (x + split, y), (width - split, height / 2), colours.obtained[at])
    _patch(axes, (x + split, y + height / 2), (width - split, height / 2), colours.factor[at])
    _frame(axes, (x, y), (width, height))
    told = [f"{colours.delta_e[at]:.2f}"] * wished + [f"model {colours.model_error[at]:.2f}"]
    axes.text(x, y + height + 0.11, " · ".join(told), fontsize=SMALL, color=INK, va="center")


def _patch(axes: Any, corner: tuple[float, float], size: tuple[float, float], rgb: Array) -> None:
    from matplotlib.patches import Rectangle

    axes.add_patch(Rectangle(corner, *size, facecolor=hex_codes(rgb[None])[0], edgecolor="none"))


def _frame(axes: Any, corner: tuple[float, float], size: tuple[float, float]) -> None:
    """So that white is seen on white."""
    from matplotlib.patches import Rectangle

    axes.add_patch(Rectangle(corner, *size, facecolor="none", edgecolor=BAND, linewidth=0.6))


def _name(axes: Any, at: tuple[float, float], part: SpectrumSpec, ha: str) -> None:
    weight = "bold" if part.designed else "normal"
    axes.text(*at, _short(part.name), fontsize=9, fontweight=weight, color=INK, ha=ha, va="center")


def _lines(axes: Any, wavelengths: Array, parts: tuple[SpectrumSpec, ...], samples: Array) -> None:
    for part, row in zip(parts, samples, strict=True):
        dash = "-" if part.designed else (0, (4, 2))
        axes.plot(wavelengths, row, linewidth=1.8, linestyle=dash, label=_short(part.name))
    axes.margins(x=0.01)
    axes.legend(frameon=False, fontsize=8)
    style_axes(axes)


def _fitting(rgb: Array) -> Array:
    """A light's colour as bright as a screen shows it."""
    return rgb / max(float(rgb.max()), 1.0)


def _short(name: str) -> str:
    return name if len(name) <= LONGEST else name[: LONGEST - 1] + "…"
