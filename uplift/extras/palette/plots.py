"""Plots of a design: its matrix of three-way patches (Bergner, figure 2), and its
spectra.
"""

from typing import Any

import numpy as np

from uplift.common.arrays import Array, StrPath
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.pages.figure import (
    BAND,
    GREY,
    INK,
    figure_text,
    new_figure,
    write_figure,
)
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.palette.design import Design, Matrix
from uplift.extras.palette.palette import SpectrumSpec

CELL = (1.5, 1.0)  # size in inches of a cell
NAMES = 1.35  # width in inches of the column of names
TOP = 0.75  # height in inches of the row of lights
PATCH = (0.92, 0.66)  # size of a patch against that of its cell
SMALL = 8.0  # font size of the numbers below a patch
MIN_WIDTH = 5.2  # inches that the legend takes
LEGEND = (
    "left: target; right: obtained, above by spectra,\nbelow by factor model; ΔE00 to "
    "the target, of the model"
)
MAX_NAME = 18  # characters of a name that fit


def plot_matrix(
    design: Design, colours: Matrix, path: StrPath, *, force: bool = False
) -> None:
    """Draw the matrix: targets on the left of each patch, obtained colours right above,
    modelled ones right below.
    """
    rows, columns = colours.delta_e.shape
    width = max(NAMES + CELL[0] * columns, MIN_WIDTH)
    height = TOP + CELL[1] * rows + 0.4
    figure = new_figure(width, height, layout=None)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.set_axis_off()
    for column, (light, white) in enumerate(
        zip(design.palette.lights, colours.whites, strict=True)
    ):
        x = NAMES + CELL[0] * column
        # The colour of a light, scaled down to the range of the display.
        _patch(
            axes,
            (x, TOP - 0.22),
            (CELL[0] * PATCH[0], 0.14),
            white / max(float(white.max()), 1.0),
        )
        _frame(axes, (x, TOP - 0.22), (CELL[0] * PATCH[0], 0.14))
        _name(axes, (x, TOP - 0.36), light, ha="left")
    for row, material in enumerate(design.palette.materials):
        _name(
            axes,
            (NAMES - 0.12, TOP + CELL[1] * (row + PATCH[1] / 2)),
            material,
            ha="right",
        )
        for column in range(columns):
            _cell(
                axes,
                (NAMES + CELL[0] * column, TOP + CELL[1] * row),
                colours,
                (row, column),
            )
    axes.text(NAMES, height - 0.24, LEGEND, fontsize=SMALL, color=GREY, va="center")
    write_figure(figure, path, force=force)


def plot_spectra(design: Design, path: StrPath, *, force: bool = False) -> None:
    """Draw powers of lights and reflectances of materials over wavelength; given
    spectra are dashed.
    """
    panels = []
    for title, label, specs, samples in (
        ("lights", "power", design.palette.lights, design.powers),
        ("materials", "reflectance", design.palette.materials, design.reflectances),
    ):
        marks = []
        for number, (spec, row) in enumerate(zip(specs, samples, strict=True)):
            dash = "-" if spec.designed else (0, (4, 2))
            at = design.palette.sensor.wavelengths
            name = _short(spec.name)
            marks.append(line(at, row, name, f"C{number % 10}", linestyle=dash))
        x = Axis("wavelength / nm")
        panels.append(Panel(marks, title, x, Axis(label), legend="best"))
    write_figure(draw(panels, 2, (5.0, 3.8)), path, force=force)


def _cell(
    axes: Any, corner: tuple[float, float], colours: Matrix, at: tuple[int, int]
) -> None:
    x, y = corner
    width, height = np.multiply(CELL, PATCH)
    has_goal = not np.isnan(colours.delta_e[at])
    split = width / 2 if has_goal else 0.0
    if has_goal:
        _patch(axes, (x, y), (split, height), colours.target[at])
    _patch(axes, (x + split, y), (width - split, height / 2), colours.obtained[at])
    _patch(
        axes,
        (x + split, y + height / 2),
        (width - split, height / 2),
        colours.factor[at],
    )
    _frame(axes, (x, y), (width, height))
    numbers = [f"{colours.delta_e[at]:.2f}"] * has_goal + [
        f"model {colours.model_error[at]:.2f}"
    ]
    axes.text(
        x,
        y + height + 0.11,
        " · ".join(numbers),
        fontsize=SMALL,
        color=INK,
        va="center",
    )


def _patch(
    axes: Any, corner: tuple[float, float], size: tuple[float, float], rgb: Array
) -> None:
    from matplotlib.patches import Rectangle

    axes.add_patch(
        Rectangle(corner, *size, facecolor=hex_codes(rgb[None])[0], edgecolor="none")
    )


def _frame(axes: Any, corner: tuple[float, float], size: tuple[float, float]) -> None:
    """Draw an outline, so that white is visible on white."""
    from matplotlib.patches import Rectangle

    axes.add_patch(
        Rectangle(corner, *size, facecolor="none", edgecolor=BAND, linewidth=0.6)
    )


def _name(axes: Any, at: tuple[float, float], spec: SpectrumSpec, ha: str) -> None:
    weight = "bold" if spec.designed else "normal"
    axes.text(
        *at,
        figure_text(_short(spec.name)),
        fontsize=9,
        fontweight=weight,
        color=INK,
        ha=ha,
        va="center",
    )


def _short(name: str) -> str:
    return name if len(name) <= MAX_NAME else name[: MAX_NAME - 1] + "…"
