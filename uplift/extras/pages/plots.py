"""Plots that commands write: spectra, powers of lights, strips of colour, and bounds of
metamers in a* and b*.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from uplift.colorimetry import Sensor, lab_to_xyz
from uplift.colorimetry.gamut import SRGB, Gamut
from uplift.colorimetry.observer import display_sensors
from uplift.common.arrays import Array, StrPath
from uplift.extras.colour.query import QueryResult
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.looks.lab_errors import LIKELY
from uplift.extras.looks.metamer_bounds import Bounds
from uplift.extras.pages.figure import (
    ACCENT,
    GREY,
    INK,
    PALE,
    figure_text,
    new_figure,
    style_axes,
    style_spectrum_axes,
    write_figure,
)
from uplift.lookup import Cube

MAX_LEGEND = 12  # largest number of lines with a legend


def plot_spectra(
    cube: Cube, results: Sequence[QueryResult], path: StrPath, *, force: bool = False
) -> None:
    """Plot reflectances over wavelength as PNG, SVG or PDF, each in its own colour."""
    figure = new_figure(7.2, 4.0)
    axes = figure.subplots()
    for result in results:
        code = cube.encode(result.rgb).round().astype(np.uint8)
        _plot_curve(
            axes,
            result.wavelengths,
            result.reflectance,
            to_display_codes(result.rgb, cube.data.sensor),
            result.entry or f"#{code.tobytes().hex()}",
        )
    style_spectrum_axes(axes)
    _write_curves(figure, len(results), path, force)


def plot_lights(
    lights: Sequence[tuple[Array, Array, Array]],
    gamut: Gamut,
    path: StrPath,
    *,
    force: bool = False,
) -> None:
    """Plot spectral powers over wavelength as PNG, SVG or PDF, each in its
    own colour.
    """
    figure = new_figure(7.2, 4.0)
    axes = figure.subplots()
    for rgb, wavelengths, power in lights:
        brightest = np.clip(rgb / max(rgb.max(), 1e-300), 0, 1)
        label = " ".join(f"{value:.4g}" for value in rgb)
        _plot_curve(axes, wavelengths, power, to_display_codes(brightest, gamut), label)
    axes.set(xlabel="wavelength / nm", ylabel="power")
    axes.set_ylim(bottom=0)
    axes.margins(x=0.01)
    style_axes(axes)
    _write_curves(figure, len(lights), path, force)


def _plot_curve(
    axes: Any, wavelengths: Array, values: Array, codes: Array, label: str
) -> None:
    axes.plot(wavelengths, values, color="0.25", linewidth=3.4, solid_capstyle="round")
    axes.plot(
        wavelengths,
        values,
        color=tuple(codes / 255),
        linewidth=2.4,
        label=figure_text(label),
    )


def _write_curves(figure: Any, count: int, path: StrPath, force: bool) -> None:
    if count <= MAX_LEGEND:
        figure.axes[0].legend(frameon=False)
    write_figure(figure, path, force=force)


# Inches of a picture's width, and of the heights of a strip and its title.
WIDTH = 7.2
HEIGHT = 0.62
TITLE_HEIGHT = 0.24


@dataclass(frozen=True, eq=False)
class Strip:
    """Encoded colours (k, 3) in [0, 1] under a title."""

    title: str
    codes: Array


def plot_strips(strips: Sequence[Strip], path: StrPath, *, force: bool = False) -> None:
    """Plot strips of colour below one another as PNG, SVG or PDF."""
    figure = new_figure(WIDTH, len(strips) * (HEIGHT + TITLE_HEIGHT) + 0.1)
    for axes, strip in zip(
        figure.subplots(len(strips), 1, squeeze=False)[:, 0], strips, strict=True
    ):
        axes.imshow(strip.codes[None], aspect="auto", interpolation="nearest")
        axes.set(xticks=(), yticks=())
        axes.spines[:].set(color=PALE, linewidth=0.6)
        axes.set_title(
            figure_text(strip.title), loc="left", fontsize=9, color=INK, pad=3
        )
    write_figure(figure, path, force=force)


MAX_COLOURS = 24  # largest number of colours in one plot
PIXELS = 160  # pixels of the colours in a region, along each side
MARGIN = 0.06  # space around a region, as a share of its size
MIN_EXTENT = 5.0  # smallest extent of an axis in a* or b*


def plot_bounds(
    cube: Cube,
    blocks: Sequence[Sequence[Bounds]],
    path: StrPath,
    *,
    force: bool = False,
) -> None:
    """Plot the region of each colour under each light, as PNG, SVG or PDF: a row per
    colour, a column per light.
    """
    panels = list[tuple[Sequence[Bounds], int]]()
    for block in blocks:
        panels += [(block, row) for row in range(len(block[0].xyz))]
    panels = panels[:MAX_COLOURS]
    screens = _screens(cube, panels[0][0])
    figure = new_figure(3.1 * len(screens), 3.1 * len(panels))
    axes = figure.subplots(len(panels), len(screens), squeeze=False)
    for line, (block, row) in zip(axes, panels, strict=True):
        for cell, screen, bounds in zip(line, screens, block, strict=True):
            _plot_region(cell, screen, bounds, row)
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=len(labels), frameon=False
    )
    write_figure(figure, path, force=force)


def plot_cut_bounds(
    cube: Cube,
    whole: Sequence[Bounds],
    cut: Sequence[Bounds],
    path: StrPath,
    *,
    force: bool = False,
) -> None:
    """Plot the region of one colour under each light, and in it that of reflectances
    which also have its colours in further photographs, as PNG, SVG or PDF.
    """
    screens = _screens(cube, whole)
    figure = new_figure(3.1 * len(screens), 3.7)
    axes = figure.subplots(1, len(screens), squeeze=False)[0]
    for cell, screen, before, after in zip(axes, screens, whole, cut, strict=True):
        _plot_region(cell, screen, replace(after, volumes=before.volumes), 0)
        cell.fill(
            *after.outline(0).T,
            facecolor="none",
            edgecolor=INK,
            linewidth=1.0,
            linestyle="--",
            label="with further photographs",
        )
        largest = after.largest.delta_e_2000[0]
        title = f"{after.light.name}: ΔE00 up to {largest:.1f}"
        cell.set_title(title, color=GREY, fontsize=9)
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    write_figure(figure, path, force=force)


def _screens(cube: Cube, by_light: Sequence[Bounds]) -> tuple[Sensor, ...]:
    lights = [bounds.light.illuminant for bounds in by_light]
    return display_sensors(lights, cube.observer, *cube.data.sensor.range)


def _plot_region(axes: Any, screen: Sensor, bounds: Bounds, row: int) -> None:
    region = bounds.outline(row)
    answer = bounds.lab[row]
    likely = bounds.likely(row)
    extent = _extent(
        np.concatenate(
            [region, answer[None, 1:], *([] if likely is None else [likely])]
        )
    )
    (patch,) = axes.fill(
        *region.T,
        facecolor="none",
        edgecolor=INK,
        linewidth=1.0,
        label="all reflectances",
    )
    image = axes.imshow(
        _colours(screen, extent, answer[0]),
        extent=extent.ravel(),
        origin="lower",
        zorder=0.5,
    )
    image.set_clip_path(patch)
    if likely is not None:
        axes.fill(
            *likely.T,
            facecolor="none",
            edgecolor=ACCENT,
            linewidth=1.4,
            label=f"likely {LIKELY:.0%}",
        )
    axes.plot(
        *answer[1:],
        "o",
        color=INK,
        markersize=5,
        markeredgecolor="white",
        label="answer",
    )
    axes.set(xlim=extent[0], ylim=extent[1], aspect="equal", xlabel="a*", ylabel="b*")
    largest = bounds.largest.delta_e_2000[row]
    axes.set_title(
        f"{bounds.light.name}: ΔE00 up to {largest:.1f}", color=GREY, fontsize=9
    )
    style_axes(axes)


def _extent(points: Array) -> Array:
    """Limits (2, 2) of a* and b* of a square around points (n, 2)."""
    low = points.min(axis=0)
    high = points.max(axis=0)
    half = max(float((high - low).max()) * (0.5 + MARGIN), MIN_EXTENT / 2)
    middle = (low + high) / 2
    return np.stack([middle - half, middle + half], axis=1)


def _colours(screen: Sensor, extent: Array, lightness: float) -> Array:
    """Colours (P, P, 3) on a screen of one lightness over a* and b*; those outside its
    gamut are desaturated.
    """
    a, b = (np.linspace(low, high, PIXELS) for low, high in extent.tolist())
    lab = np.stack(np.broadcast_arrays(lightness, a[None, :], b[:, None]), axis=-1)
    linear = lab_to_xyz(lab.reshape(-1, 3), screen.light.white) @ screen.xyz_to_rgb.T
    return to_display_codes(linear, SRGB).reshape(PIXELS, PIXELS, 3) / 255
