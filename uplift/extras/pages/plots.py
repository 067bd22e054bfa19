"""Plots that commands write: spectra, powers of lights, strips of colour, and bounds of
metamers in a* and b*.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import zip_longest
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
from uplift.extras.pages.figure import ACCENT, INK, PALE, write_figure
from uplift.extras.pages.marks import Mark, line, outline, picture
from uplift.extras.pages.panels import (
    Axis,
    Dot,
    Panel,
    draw,
    spectra_panel,
    square_limits,
)
from uplift.lookup import Cube

SIZE = (7.2, 4.0)
"""Inches of a plot of curves."""
MAX_LEGEND = 12
"""Largest number of curves with a legend."""


def plot_spectra(
    cube: Cube, results: Sequence[QueryResult], path: StrPath, *, force: bool = False
) -> None:
    """Plot reflectances over wavelength as PNG, SVG or PDF, each in its own colour."""
    marks = []
    for result in results:
        code = cube.encode(result.rgb).round().astype(np.uint8)
        label = result.entry or f"#{code.tobytes().hex()}"
        colour = to_display_codes(result.rgb, cube.data.sensor)
        marks += _curve(result.wavelengths, result.reflectance, colour, label)
    panel = replace(spectra_panel(marks), legend=_legend(len(results)))
    write_figure(draw([panel], size=SIZE), path, force=force)


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
    marks = []
    for rgb, wavelengths, power in lights:
        brightest = np.clip(rgb / max(rgb.max(), 1e-300), 0, 1)
        label = " ".join(f"{value:.4g}" for value in rgb)
        marks += _curve(wavelengths, power, to_display_codes(brightest, gamut), label)
    power_axis = Axis("power", limits=(0, None))
    legend = _legend(len(lights))
    panel = Panel(marks, "", Axis("wavelength / nm"), power_axis, legend=legend)
    write_figure(draw([panel], size=SIZE), path, force=force)


def _legend(count: int) -> str:
    return "best" if count <= MAX_LEGEND else ""


def _curve(wavelengths: Array, values: Array, code: Array, label: str) -> list[Mark]:
    """Draw a curve in its colour, with a dark edge."""
    style: dict[str, Any] = {"solid_capstyle": "round"}
    return [
        line(wavelengths, values, "", "0.25", linewidth=3.4, **style),
        line(wavelengths, values, label, tuple(code / 255), linewidth=2.4, **style),
    ]


@dataclass(frozen=True, eq=False)
class Strip:
    """Encoded colours (k, 3) in [0, 1] under a title."""

    title: str
    codes: Array


def plot_strips(strips: Sequence[Strip], path: StrPath, *, force: bool = False) -> None:
    """Plot strips of colour below one another as PNG, SVG or PDF."""
    panels = []
    for strip in strips:
        marks = [picture(strip.codes[None], aspect="auto"), _frame]
        panels.append(Panel(marks, strip.title))
    write_figure(draw(panels, size=(7.2, 0.86)), path, force=force)


def _frame(axes: Any) -> None:
    """Draw an edge, so that white is visible on white."""
    axes.spines[:].set(visible=True, color=PALE, linewidth=0.6)


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
    region = bounds.outline(row)
    inner = bounds if part is None else part
    lightness, a, b = inner.lab[row]
    likely = inner.likely(row)
    marks = [_filled(screen, region, lightness)]
    marks.append(outline(region, "all reflectances", INK))
    inside = [region, np.array([(a, b)])]
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


def _filled(screen: Sensor, region: Array, lightness: float) -> Mark:
    """Fill a region with its colours on a screen."""
    extent = square_limits(region, MIN_EXTENT)

    def draw_colours(axes: Any) -> None:
        codes = _colours(screen, extent, lightness)
        image = axes.imshow(codes, extent=extent.ravel(), origin="lower", zorder=0.5)
        (edge,) = axes.fill(*region.T, facecolor="none")
        image.set_clip_path(edge)

    return draw_colours


def _colours(screen: Sensor, extent: Array, lightness: float) -> Array:
    """Colours (P, P, 3) on a screen of one lightness over a* and b*; those outside its
    gamut are desaturated.
    """
    a, b = (np.linspace(low, high, PIXELS) for low, high in extent.tolist())
    lab = np.stack(np.broadcast_arrays(lightness, a[None, :], b[:, None]), axis=-1)
    linear = lab_to_xyz(lab.reshape(-1, 3), screen.light.white) @ screen.xyz_to_rgb.T
    return to_display_codes(linear, SRGB).reshape(PIXELS, PIXELS, 3) / 255
