"""Chromaticity diagrams (CIE 1976 u′v′) of an emission table: colours, the exact lamps,
and expected errors.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import STANDARD_ILLUMINANTS
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.emission.lattice import chromaticity, unit_xyz
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.pages.figure import GREY, INK, colour_map
from uplift.extras.pages.marks import Mark, line, outline, region
from uplift.extras.pages.panels import Axis, Dot, Panel, draw, square_limits

SIZE = (4.6, 4.4)
"""Inches of a diagram."""
PIXELS = 320
"""Pixels of a picture along u′."""
WAVELENGTHS = (460, 480, 490, 500, 510, 520, 540, 560, 580, 600, 620, 700)
"""Wavelengths in nm that are marked on the spectral locus."""
OUTWARD = 0.022
"""Distance in u′v′ of their names from the locus."""
MAX_NAMES = 12
"""Lamps that are named; the report lists all."""
FADED = 0.35
"""Opacity of colours below names."""
MIN_EXTENT = 0.02
"""Smallest extent of the window of lamps in u′ or v′."""
ALL = np.array([(-0.03, 0.65), (-0.03, 0.65)])
"""Limits of u′ and v′ around all chromaticities of lights."""


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
    turn = np.linspace(0, 2 * np.pi, 65)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    marks = []
    for uv, radius in zip(entries.uv, entries.radius, strict=True):
        marks.append(outline(uv + radius * circle, colour=GREY, linewidth=0.5))
    marks.append(_map(table, window, _codes(table, window), alpha=FADED))
    is_standard = np.isin(entries.names, STANDARD_ILLUMINANTS)
    order = np.lexsort([-entries.radius, ~is_standard])
    title = "Exact lamps, and the discs in which answers blend to them"
    return _panel(table, window, title, marks, order[:MAX_NAMES].tolist())


def _panel(
    table: EmissionTable,
    window: Array,
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
    x, y = (
        Axis(label, limits=tuple(limits))
        for label, limits in zip(("u′", "v′"), window, strict=True)
    )
    return Panel(marks, title, x, y, dots, "lower right")


def lamp_window(table: EmissionTable) -> Array:
    """Return the limits (2, 2) of u′ and v′ around the lamps and white."""
    uv = np.append(table.data.entries.uv, table.data.lattice.white[None], axis=0)
    return square_limits(uv, MIN_EXTENT)


def _pixels(table: EmissionTable, window: Array) -> Array:
    """Linear RGB (P, P, 3) of luminance 1 at the pixels of a window; outside the locus
    that of its edge.
    """
    lattice = table.data.lattice
    middles = (np.arange(PIXELS) + 0.5) / PIXELS
    u, v = window[:, :1] + np.diff(window) * middles
    offset = np.stack(np.meshgrid(u, v), axis=-1) - lattice.white
    length = lattice.polar(offset.reshape(-1, 2))[2].reshape(offset.shape[:2])
    xyz = unit_xyz(lattice.white + offset / np.maximum(length, 1.0)[..., None])
    return table.rgb_of_xyz(xyz / xyz[..., 1:2])


def _codes(table: EmissionTable, window: Array) -> NDArray[np.uint8]:
    """Encoded sRGB (P, P, 3) of the brightest colours of the chromaticities in a
    window.
    """
    rgb = _pixels(table, window)
    brightest = np.clip(rgb / rgb.max(axis=-1, keepdims=True), 0, 1)
    return np.asarray(to_display_codes(brightest, table), dtype=np.uint8)


def _map(
    table: EmissionTable, window: Array, values: NDArray[Any], **style: Any
) -> Mark:
    """Draw values (P, P) or codes (P, P, 3) of a window within the spectral locus."""
    locus = table.data.lattice.knots
    return region(values, window, locus, GREY, interpolation="bilinear", **style)


def _wavelengths(table: EmissionTable) -> Mark:
    """Name wavelengths outside the locus, away from white."""
    is_marked = np.isin(table.wavelengths, WAVELENGTHS)
    places = chromaticity(table.data.cmfs[is_marked])
    outward = places - table.data.lattice.white
    outward *= OUTWARD / np.linalg.norm(outward, axis=1, keepdims=True)

    def draw_names(axes: Any) -> None:
        axes.plot(*places.T, "o", markersize=2, color=GREY)
        names = table.wavelengths[is_marked]
        for name, uv in zip(names, places + outward, strict=True):
            axes.text(*uv, f"{name:.0f}", ha="center", va="center")

    return draw_names
