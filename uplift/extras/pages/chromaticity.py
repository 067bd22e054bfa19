"""Chromaticity diagrams (CIE 1976 u′v′) of an emission table: colours, the exact lamps,
and expected errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import STANDARD_ILLUMINANTS
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.emission.lattice import chromaticity, unit_xyz
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.pages.figure import GREY, INK, colour_map
from uplift.extras.pages.marks import Mark, line
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, square_limits

SIZE = (4.6, 4.4)
"""Inches of a diagram."""
PIXELS = 320
"""Pixels of a picture along u′."""
WAVELENGTHS = (460, 480, 490, 500, 510, 520, 540, 560, 580, 600, 620, 700)
"""Wavelengths in nm that are marked on the spectral locus."""
MAX_NAMES = 12
"""Lamps that are named; the report lists all."""
FADED = 0.35
"""Opacity of colours below names."""
MIN_EXTENT = 0.02
"""Smallest extent of the window of lamps in u′ or v′."""


@dataclass(frozen=True)
class Window:
    """A part of the diagram: lowest and highest u′ and v′."""

    u: tuple[float, float]
    v: tuple[float, float]


ALL = Window(
    (-0.03, 0.65), (-0.03, 0.65)
)  # all chromaticities of lights, with a margin


def light_figure(table: EmissionTable) -> Any:
    """Draw colours, the region of the lamps, and expected errors side by side."""
    panels = [colours_panel(table), lamps_panel(table), errors_panel(table)]
    return draw(panels, 3, SIZE, scale="expected ΔE00 of surfaces")


def colours_panel(table: EmissionTable) -> Panel:
    """Return the colours of lights, the triangle of the RGB space and the wavelengths
    of the spectral locus.
    """
    u, v = chromaticity(table.xyz(np.eye(3)[[0, 1, 2, 0]])).T
    space = f"{table.space} primaries"
    marks = [
        line(u, v, space, linewidth=0.9, linestyle=(0, (4, 2))),
        _wavelengths(table),
        line([], [], "lamp that is exact", marker="o", linestyle="", mfc="white"),
        _map(table, ALL, _codes(table, ALL)),
    ]
    knots, rings = table.data.lattice.shape
    title = f"Colours  ·  {knots} × {rings} nodes, {table.space}"
    return _panel(table, ALL, title, marks)


def errors_panel(table: EmissionTable) -> Panel:
    """Return the map of expected errors."""
    errors = table.expected_error(_pixels(table, ALL))
    largest = float(table.data.error.max())
    marks = [_map(table, ALL, errors, cmap=colour_map(), vmin=0, vmax=largest)]
    return _panel(table, ALL, "Expected error", marks)


def lamps_panel(table: EmissionTable) -> Panel:
    """Return the part of the diagram that has the lamps, with the names of the standard
    illuminants and of those with large discs.

    Circles are the discs in which answers blend to a lamp.
    """
    entries = table.data.entries
    window = lamp_window(table)
    is_standard = np.isin(entries.names, STANDARD_ILLUMINANTS)
    order = np.lexsort([-entries.radius, ~is_standard])
    marks = [_map(table, window, _codes(table, window), alpha=FADED), _discs(table)]
    title = "Exact lamps, and the discs in which answers blend to them"
    return _panel(table, window, title, marks, order[:MAX_NAMES].tolist())


def _panel(
    table: EmissionTable,
    window: Window,
    title: str,
    marks: Sequence[Mark],
    named: Sequence[int] = (),
) -> Panel:
    """Return a panel with all lamps, of which some are ``named``."""
    entries = table.data.entries
    dots = []
    for row, (name, (u, v)) in enumerate(zip(entries.names, entries.uv, strict=True)):
        text = name if row in named else ""
        is_bold = name in STANDARD_ILLUMINANTS
        dots.append(Dot(u, v, text, INK, hollow=True, bold=is_bold, size=0.6))
    x = Axis("u′", limits=window.u)
    return Panel(marks, title, x, Axis("v′", limits=window.v), dots, "lower right")


def lamp_window(table: EmissionTable) -> Window:
    """Return the part of the diagram that has the lamps and white."""
    uv = np.append(table.data.entries.uv, table.data.lattice.white[None], axis=0)
    u, v = square_limits(uv, MIN_EXTENT).tolist()
    return Window(tuple(u), tuple(v))


def _pixels(table: EmissionTable, window: Window) -> Array:
    """Linear RGB (H, W, 3) of luminance 1 at the pixels of a window, v′ upwards;
    outside the locus that of its edge.
    """
    step = (window.u[1] - window.u[0]) / PIXELS
    u, v = (
        low + step * (np.arange(round((high - low) / step)) + 0.5)
        for low, high in (window.u, window.v)
    )
    lattice = table.data.lattice
    offset = np.stack(np.meshgrid(u, v[::-1]), axis=-1) - lattice.white
    length = lattice.polar(offset.reshape(-1, 2))[2].reshape(offset.shape[:2])
    xyz = unit_xyz(lattice.white + offset / np.maximum(length, 1.0)[..., None])
    return table.rgb_of_xyz(xyz / xyz[..., 1:2])


def _codes(table: EmissionTable, window: Window) -> NDArray[np.uint8]:
    """Encoded sRGB (H, W, 3) of the brightest colours of the chromaticities in a
    window.
    """
    rgb = _pixels(table, window)
    brightest = np.clip(rgb / rgb.max(axis=-1, keepdims=True), 0, 1)
    return np.asarray(to_display_codes(brightest, table), dtype=np.uint8)


def _map(
    table: EmissionTable, window: Window, values: NDArray[Any], **style: Any
) -> Mark:
    """Draw values (H, W) or codes (H, W, 3) of a window within the spectral locus."""
    extent = (*window.u, *window.v)
    place: dict[str, Any] = {"extent": extent, "zorder": 0, "aspect": "equal"}

    def draw_map(axes: Any) -> None:
        edge = {"facecolor": "none", "edgecolor": GREY, "linewidth": 1}
        (locus,) = axes.fill(*table.data.lattice.knots.T, **edge)
        image = axes.imshow(values, interpolation="bilinear", **place, **style)
        image.set_clip_path(locus)
        axes.grid(visible=False)

    return draw_map


def _discs(table: EmissionTable) -> Mark:
    """Draw the disc of each lamp."""

    def draw_discs(axes: Any) -> None:
        from matplotlib.patches import Circle

        entries = table.data.entries
        style: dict[str, Any] = {"fill": False, "edgecolor": GREY, "linewidth": 0.5}
        for uv, radius in zip(entries.uv, entries.radius, strict=True):
            axes.add_patch(Circle(tuple(uv), radius, **style))

    return draw_discs


def _wavelengths(table: EmissionTable) -> Mark:
    """Name wavelengths outside the locus, away from white."""
    is_marked = np.isin(table.wavelengths, WAVELENGTHS)
    places = _locus(table)[is_marked]
    names = [f"{at:.0f}" for at in table.wavelengths[is_marked]]
    outward = places - table.data.lattice.white
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    middle: dict[str, Any] = {"ha": "center", "va": "center"}

    def draw_names(axes: Any) -> None:
        axes.plot(*places.T, "o", markersize=2, color=GREY)
        for name, uv, away in zip(names, places, 9 * outward, strict=True):
            axes.annotate(name, uv, away, textcoords="offset points", **middle)

    return draw_names


def _locus(table: EmissionTable) -> Array:
    """u′v′ (N, 2) of single wavelengths; that of white where the observer does not
    respond.
    """
    responds = table.data.cmfs.sum(axis=1) > 0
    xyz = np.where(responds[:, None], table.data.cmfs, table.rgb_to_xyz.sum(axis=1))
    return chromaticity(xyz)
