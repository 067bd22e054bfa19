"""Plots of spectra."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from uplift.colorimetry.gamut import Gamut
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.lookup import Cube, QueryResult
from uplift.viz.figure import figure_text, new_figure, style_axes, style_spectrum_axes, write_figure

MAX_LEGEND = 12
"""Largest number of lines with a legend."""


def plot_spectra(
    cube: Cube, results: Sequence[QueryResult], path: str | os.PathLike[str], *, force: bool = False
) -> None:
    """Plot reflectances over wavelength as PNG, SVG or PDF, each in its own colour.

    Parameters
    ----------
    cube : Cube
        The cube that was queried.
    results : sequence of QueryResult
        The reflectances.
    path : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    figure = new_figure(7.2, 4.0)
    axes = figure.subplots()
    for result in results:
        codes = "".join(f"{round(code):02x}" for code in cube.encode(result.rgb).tolist())
        colour = tuple(to_display_codes(result.rgb, cube.data.sensor) / 255)
        axes.plot(result.wavelengths, result.reflectance, color="0.25", linewidth=3.4, solid_capstyle="round")
        axes.plot(
            result.wavelengths,
            result.reflectance,
            color=colour,
            linewidth=2.4,
            label=figure_text(result.entry or f"#{codes}"),
        )
    style_spectrum_axes(axes)
    if len(results) <= MAX_LEGEND:
        axes.legend(frameon=False)
    write_figure(figure, path, force=force)


def plot_lights(
    lights: Sequence[tuple[Array, Array, Array]],
    gamut: Gamut,
    path: str | os.PathLike[str],
    *,
    force: bool = False,
) -> None:
    """Plot spectral powers over wavelength as PNG, SVG or PDF, each in its own colour.

    Parameters
    ----------
    lights : sequence of tuple
        Linear RGB (3,), wavelengths (N,) in nm and power (N,) of each light.
    gamut : Gamut
        The RGB space.
    path : path-like
        The file to write.
    force : bool, default False
        Replace an existing file.

    Raises
    ------
    OutputError
        If the file exists and ``force`` is false, or cannot be written.
    """
    figure = new_figure(7.2, 4.0)
    axes = figure.subplots()
    for rgb, wavelengths, power in lights:
        colour = tuple(to_display_codes(np.clip(rgb / max(rgb.max(), 1e-300), 0, 1), gamut) / 255)
        label = " ".join(f"{value:.4g}" for value in rgb)
        axes.plot(wavelengths, power, color="0.25", linewidth=3.4, solid_capstyle="round")
        axes.plot(wavelengths, power, color=colour, linewidth=2.4, label=figure_text(label))
    axes.set(xlabel="wavelength / nm", ylabel="power")
    axes.set_ylim(bottom=0)
    axes.margins(x=0.01)
    style_axes(axes)
    if len(lights) <= MAX_LEGEND:
        axes.legend(frameon=False)
    write_figure(figure, path, force=force)
