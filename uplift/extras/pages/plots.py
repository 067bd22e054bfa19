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
from uplift.extras.pages.figure import ACCENT, INK, PALE, write_figure
from uplift.extras.pages.marks import Mark, line, outline, picture
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, spectra_panel
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
MARGIN = 0.06
"""Space around a region, as a share of its size."""
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
    if cut:
        for screen, whole, part in zip(screens, blocks[0], cut, strict=True):
            dashed = outline(
                part.outline(0), "with further photographs", INK, linestyle="--"
            )
            shown = replace(part, volumes=whole.volumes)
            panels.append(_region_panel(screen, shown, 0, [dashed]))
    else:
        for block in blocks:
            for row in range(len(block[0].xyz)):
                for screen, bounds in zip(screens, block, strict=True):
                    panels.append(_region_panel(screen, bounds, row))
    columns = len(screens)
    shown_panels = panels[: MAX_COLOURS * columns]
    figure = draw(shown_panels, columns, (3.1, 3.1), legend="below")
    write_figure(figure, path, force=force)


def _region_panel(
    screen: Sensor, bounds: Bounds, row: int, marks: Sequence[Mark] = ()
) -> Panel:
    """Return the colours that one colour may have under a light, and its answer."""
    region = bounds.outline(row)
    lightness, a, b = bounds.lab[row]
    likely = bounds.likely(row)
    inside = [region, np.array([(a, b)])]
    drawn = [_filled(screen, region, lightness)]
    drawn.append(outline(region, "all reflectances", INK))
    if likely is not None:
        inside.append(likely)
        drawn.append(outline(likely, f"likely {LIKELY:.0%}", ACCENT, linewidth=1.4))
    answer = line([], [], "answer", INK, marker="o", linestyle="")
    extent = _extent(np.concatenate(inside))
    largest = bounds.largest.delta_e_2000[row]
    return Panel(
        [*drawn, *marks, answer],
        f"{bounds.light.name}: ΔE00 up to {largest:.1f}",
        Axis("a*", limits=tuple(extent[0])),
        Axis("b*", limits=tuple(extent[1])),
        [Dot(a, b)],
    )


def _filled(screen: Sensor, region: Array, lightness: float) -> Mark:
    """Fill a region with its colours on a screen."""
    extent = _extent(region)

    def draw_colours(axes: Any) -> None:
        codes = _colours(screen, extent, lightness)
        image = axes.imshow(codes, extent=extent.ravel(), origin="lower", zorder=0.5)
        (edge,) = axes.fill(*region.T, facecolor="none")
        image.set_clip_path(edge)

    return draw_colours


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
