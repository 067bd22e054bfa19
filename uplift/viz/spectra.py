"""Pictures of spectra."""

from __future__ import annotations

import os
from collections.abc import Sequence

from uplift.colorimetry.srgb import to_display_codes
from uplift.lookup import Cube, QueryResult
from uplift.viz.figure import new_figure, style_spectrum_axes, write_png

NAMED = 12
"""More lines than this are not named in a legend."""


def plot_spectra(
    cube: Cube, answers: Sequence[QueryResult], path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Draw reflectances over wavelength, each in its own colour, as a PNG. Raises `OutputError`."""
    figure = new_figure(7.2, 4.0)
    axes = figure.subplots()
    for answer in answers:
        name = answer.entry or "#" + "".join(
            f"{round(code):02x}" for code in cube.encode(answer.rgb).tolist()
        )
        colour = tuple(to_display_codes(answer.rgb, cube.data.sensor) / 255)
        axes.plot(answer.wavelengths, answer.reflectance, color="0.25", linewidth=3.4, solid_capstyle="round")
        axes.plot(answer.wavelengths, answer.reflectance, color=colour, linewidth=2.4, label=name)
    style_spectrum_axes(axes)
    if len(answers) <= NAMED:
        axes.legend(frameon=False)
    write_png(figure, path, force=force)
