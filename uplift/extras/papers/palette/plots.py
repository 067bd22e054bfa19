"""Plots of a design: its matrix of three-way patches (Bergner, figure 2), and its
spectra.
"""

import textwrap

import numpy as np

from uplift.colorimetry.gamut import SRGB
from uplift.common.arrays import Array, StrPath
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import line, patches
from uplift.extras.pages.panels import Axis, Panel, draw, sheet
from uplift.extras.papers.palette.design import Design, Matrix
from uplift.extras.papers.palette.palette import SpectrumSpec

CELL = (1.7, 1.2)
"""Inches of a cell."""
MIN_WIDTH = 5.2
"""Inches that the legend takes."""
LEGEND = (
    "left: target; right: obtained, above by spectra,\nbelow by factor model; ΔE00 to "
    "the target, of the model"
)
MAX_NAME = 18
"""Characters of a line of a name."""


def plot_matrix(
    design: Design, colours: Matrix, path: StrPath, *, force: bool = False
) -> None:
    """Draw the matrix: targets on the left of each patch, obtained colours right above,
    modelled ones right below; and above them the colours of the lights.
    """
    # The colours of lights are scaled down to the range of the display.
    whites = colours.whites / np.maximum(colours.whites.max(axis=1, keepdims=True), 1)
    rows = {"colour\nof light": [_patch(white[None, None]) for white in whites]}
    for row, material in enumerate(design.palette.materials):
        cells = [_cell(colours, row, column) for column in range(len(whites))]
        rows[_name(material)] = cells
    titles = list(map(_name, design.palette.lights))
    width = max(CELL[0], MIN_WIDTH / len(titles))
    panels = sheet(titles, rows)
    figure = draw(panels, len(titles), (width, CELL[1]), title=LEGEND)
    write_figure(figure, path, force=force)


def _cell(colours: Matrix, row: int, column: int) -> Panel:
    at = row, column
    right = [colours.obtained[at], colours.factor[at]]
    caption = f"model {colours.model_error[at]:.2f}"
    if np.isnan(colours.delta_e[at]):
        return _patch(np.stack(right)[:, None], caption)
    cells = np.stack([[colours.target[at]] * 2, right], axis=1)
    return _patch(cells, f"{colours.delta_e[at]:.2f} · {caption}")


def _patch(rgb: Array, caption: str = "") -> Panel:
    codes = to_display_codes(rgb, SRGB) / 255
    return Panel([patches(codes)], x=Axis(caption))


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
            marks.append(line(at, row, _name(spec), f"C{number % 10}", linestyle=dash))
        x = Axis("wavelength / nm")
        panels.append(Panel(marks, title, x, Axis(label), legend="best"))
    write_figure(draw(panels, 2, (5.0, 3.8)), path, force=force)


def _name(spec: SpectrumSpec) -> str:
    """Return the name of a light or a material in lines, and whether it is designed."""
    lines = textwrap.wrap(spec.name, MAX_NAME)
    return "\n".join(lines + ["(designed)"] * spec.designed)
