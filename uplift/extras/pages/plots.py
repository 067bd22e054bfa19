"""Plots that commands write: spectra, powers of lights, strips of colour, and bounds of
metamers in a* and b*.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import zip_longest
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import lab_to_xyz
from uplift.colorimetry.gamut import SRGB, Gamut
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, StrPath
from uplift.extras.colour.query import QueryBlock
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.looks.lab_errors import LIKELY
from uplift.extras.looks.metamer_bounds import Bounds
from uplift.extras.pages.figure import ACCENT, INK, write_figure
from uplift.extras.pages.marks import line, outline, patches, region
from uplift.extras.pages.panels import (
    Axis,
    Dot,
    Panel,
    draw,
    spectra_panel,
    square_limits,
)
from uplift.lookup.cube import Cube

SIZE = (7.2, 4.0)
"""Inches of a plot of curves."""
MAX_LEGEND = 12
"""Largest number of curves with a legend."""
Curve = tuple[Array, Array, Array, str]
"""Wavelengths (N,), values (N,), 8-bit codes (3,) of the colour, and its name."""


def plot_spectra(
    cube: Cube, blocks: Iterable[QueryBlock], path: StrPath, *, force: bool = False
) -> None:
    """Plot reflectances over wavelength as PNG, SVG or PDF, each in its own colour."""
    curves = []
    for block in blocks:
        codes = cube.encode(block.rgb).round().astype(np.uint8)
        colours = to_display_codes(block.rgb, cube.data.sensor)
        rows = zip(block.entry, codes, colours, block.reflectance, strict=True)
        for entry, code, colour, reflectance in rows:
            label = entry or f"#{code.tobytes().hex()}"
            curves.append((block.wavelengths, reflectance, colour, label))
    _write_curves(curves, spectra_panel([]), path, force=force)


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
    curves = []
    for rgb, wavelengths, power in lights:
        brightest = np.clip(rgb / max(rgb.max(), 1e-300), 0, 1)
        label = " ".join(f"{value:.4g}" for value in rgb)
        curves.append((wavelengths, power, to_display_codes(brightest, gamut), label))
    panel = Panel(x=Axis("wavelength / nm"), y=Axis("power", limits=(0, None)))
    _write_curves(curves, panel, path, force=force)


def _write_curves(
    curves: Sequence[Curve], panel: Panel, path: StrPath, *, force: bool
) -> None:
    """Write curves in their colours, with dark edges; few ones have a legend."""
    marks = []
    for wavelengths, values, code, label in curves:
        edge: dict[str, Any] = {"linewidth": 3.4, "solid_capstyle": "round"}
        marks.append(line(wavelengths, values, "", "0.25", **edge))
        marks.append(line(wavelengths, values, label, tuple(code / 255), linewidth=2.4))
    legend = "best" if len(curves) <= MAX_LEGEND else ""
    drawn = replace(panel, marks=marks, legend=legend)
    write_figure(draw([drawn], size=SIZE), path, force=force)


def plot_strips(
    strips: Mapping[str, Array], path: StrPath, *, force: bool = False
) -> None:
    """Plot strips of encoded colours (k, 3) in [0, 1] below one another, by title, as
    PNG, SVG or PDF.
    """
    panels = [Panel([patches(codes[None])], title) for title, codes in strips.items()]
    write_figure(draw(panels, size=(7.2, 0.86)), path, force=force)


MAX_COLOURS = 24
"""Largest number of colours in one plot."""
PIXELS = 160
"""Pixels of the colours in a region, along each side."""
MIN_EXTENT = 5.0
"""Smallest extent of an axis in a* or b*."""


def plot_bounds(
    cube: Cube,
    blocks: Sequence[Sequence[Bounds]],
    path: StrPath,
    *,
    cut: Sequence[Bounds] = (),
    force: bool = False,
) -> None:
    """Plot the region of each colour under each light, as PNG, SVG or PDF: a row per
    colour, a column per light.

    ``cut`` has for each light the bounds of reflectances that also have the colours in
    further photographs. These regions are drawn inside those of the first colour.
    """
    lights = [bounds.light.illuminant for bounds in blocks[0]]
    screens = display_sensors(lights, cube.observer, *cube.data.sensor.range)
    panels = []
    for block in blocks:
        for row in range(len(block[0].xyz)):
            for screen, bounds, part in zip_longest(screens, block, cut):
                panels.append(_region_panel(screen, bounds, row, part))
    shown = panels[: MAX_COLOURS * len(screens)]
    figure = draw(shown, len(screens), (3.1, 3.1), legend="below")
    write_figure(figure, path, force=force)


def _region_panel(
    screen: Sensor, bounds: Bounds, row: int, part: Bounds | None
) -> Panel:
    """Return the colours that one colour may have under a light, and its answer; also a
    ``part`` of them.
    """
    edge = bounds.outline(row)
    inner = bounds if part is None else part
    lightness, a, b = inner.lab[row]
    likely = inner.likely(row)
    extent = square_limits(edge, MIN_EXTENT)
    marks = [
        region(_colours(screen, extent, lightness), extent, edge),
        outline(edge, "all reflectances", INK),
    ]
    inside = [edge, np.array([(a, b)])]
    if likely is not None:
        inside.append(likely)
        marks.append(outline(likely, f"likely {LIKELY:.0%}", ACCENT, linewidth=1.4))
    if part is not None:
        further = part.outline(row)
        marks.append(outline(further, "with further photographs", linestyle="--"))
    marks.append(line([], [], "answer", INK, marker="o", linestyle=""))
    u, v = square_limits(np.concatenate(inside), MIN_EXTENT)
    title = f"{inner.light.name}: ΔE00 up to {inner.largest.delta_e_2000[row]:.1f}"
    x = Axis("a*", limits=tuple(u))
    return Panel(marks, title, x, Axis("b*", limits=tuple(v)), [Dot(a, b)])


def _colours(screen: Sensor, extent: Array, lightness: float) -> Array:
    """Colours (P, P, 3) on a screen of one lightness over a* and b*; those outside its
    gamut are desaturated.
    """
    a, b = np.meshgrid(*(np.linspace(low, high, PIXELS) for low, high in extent))
    lab = np.stack([np.full_like(a, lightness), a, b], axis=-1)
    xyz = lab_to_xyz(lab.reshape(-1, 3), screen.light.white)
    codes = to_display_codes(xyz @ screen.xyz_to_rgb.T, SRGB) / 255
    return codes.reshape(lab.shape)
