"""Chromaticity diagrams (CIE 1976 u′v′) of an emission table: colours, expected errors,
and the exact lamps.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import STANDARD_ILLUMINANTS
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.emission.lattice import chromaticity, unit_xyz
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.pages.figure import GREY, INK, colour_map, styled
from uplift.extras.pages.scatter import (
    LEGEND,
    Label,
    draw_labels,
    new_panels,
    style_title,
)

PANEL = (5.6, 5.4)  # inches of a diagram with its margins
MARGINS = {"left": 0.035, "right": 0.99, "bottom": 0.085, "top": 0.93, "wspace": 0.13}
PIXELS = 320  # pixels of a picture along u′
# Wavelengths in nm that are marked on the spectral locus.
WAVELENGTHS = (460, 480, 490, 500, 510, 520, 540, 560, 580, 600, 620, 700)
MAX_NAMES = 12  # lamps that are named; the report lists all
FADED = 0.35  # opacity of colours below names
MARGIN = 0.012  # u′v′ between the lamps and the edge of their window
LAMP: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 4.5,
    "mfc": "white",
    "mec": INK,
    "mew": 0.8,
}


@dataclass(frozen=True)
class Window:
    """A part of the diagram: lowest and highest u′ and v′."""

    u: tuple[float, float]
    v: tuple[float, float]


ALL = Window((-0.04, 0.64), (0.0, 0.62))  # all chromaticities of lights, with a margin


def light_figure(table: EmissionTable) -> Any:
    """Draw colours, expected errors, and the region of the lamps side by side."""
    with styled():
        figure, ((colours, errors, lamps),) = new_panels(1, 3, PANEL, MARGINS)
        draw_colours(colours, table)
        draw_errors(errors, table)
        draw_lamps(lamps, table)
        knots, rings = table.data.lattice.shape
        for axes, title in (
            (colours, f"Colours  ·  {knots} × {rings} nodes, {table.space}"),
            (errors, "Expected error"),
            (lamps, "Exact lamps, and the discs in which answers blend to them"),
        ):
            style_title(axes, title)
        return figure


def draw_colours(axes: Any, table: EmissionTable) -> None:
    """Draw the colours of lights, the triangle of the RGB space and the wavelengths of
    the spectral locus.
    """
    _draw_map(axes, table, ALL, _codes(table, ALL))
    corners = chromaticity(table.xyz(np.eye(3)[[0, 1, 2, 0]]))
    axes.plot(
        *corners.T,
        color=INK,
        linewidth=0.9,
        linestyle=(0, (4, 2)),
        label=f"{table.space} primaries",
    )
    _draw_wavelengths(axes, table)
    _draw_lamp_marks(axes, table)
    axes.legend(loc="lower right", **LEGEND)


def draw_errors(axes: Any, table: EmissionTable) -> None:
    """Draw the map of expected errors with its scale."""
    errors = table.expected_error(_pixels(table, ALL))
    largest = float(table.data.error.max())
    image = _draw_map(axes, table, ALL, errors, cmap=colour_map(), vmin=0, vmax=largest)
    _draw_lamp_marks(axes, table)
    place = axes.inset_axes((0.6, 0.12, 0.36, 0.03))
    bar = axes.figure.colorbar(image, cax=place, orientation="horizontal")
    bar.set_label("expected ΔE00 of surfaces", color=INK)
    bar.outline.set_visible(False)


def draw_lamps(axes: Any, table: EmissionTable) -> None:
    """Draw the part of the diagram that has the lamps, and name the standard
    illuminants and those with large discs.

    Circles are the discs in which answers blend to a lamp.
    """
    from matplotlib.patches import Circle

    entries = table.data.entries
    window = lamp_window(table)
    _draw_map(axes, table, window, _codes(table, window), alpha=FADED)
    for uv, radius in zip(entries.uv, entries.radius, strict=True):
        axes.add_patch(
            Circle(tuple(uv), radius, fill=False, edgecolor=GREY, linewidth=0.5)
        )
    _draw_lamp_marks(axes, table)
    is_standard = np.isin(entries.names, STANDARD_ILLUMINANTS)
    order = np.lexsort([-entries.radius, ~is_standard])
    labels = [
        Label(
            entries.names[row], tuple(entries.uv[row]), INK, bool(is_standard[row]), ""
        )
        for row in order[:MAX_NAMES].tolist()
    ]
    draw_labels(axes, labels, entries.uv, np.empty((0, 2)))


def lamp_window(table: EmissionTable) -> Window:
    """Return the part of the diagram that has the lamps, of the proportions
    of `ALL`.
    """
    uv = np.concatenate([table.data.entries.uv, table.data.lattice.white[None]])
    low = uv.min(axis=0) - MARGIN
    high = uv.max(axis=0) + MARGIN
    full = np.array([ALL.u[1] - ALL.u[0], ALL.v[1] - ALL.v[0]])
    half = full * ((high - low) / full).max() / 2
    middle = (low + high) / 2
    u, v = np.stack([middle - half, middle + half], axis=1).tolist()
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


def _draw_map(
    axes: Any, table: EmissionTable, window: Window, values: NDArray[Any], **style: Any
) -> Any:
    """Draw values (H, W) or codes (H, W, 3) of a window within the spectral locus."""
    from matplotlib.patches import Polygon

    edge = Polygon(
        table.data.lattice.knots, closed=True, fill=False, edgecolor=GREY, linewidth=1
    )
    axes.add_patch(edge)
    extent = (*window.u, *window.v)
    image = axes.imshow(
        values,
        extent=extent,
        interpolation="bilinear",
        aspect="equal",
        zorder=0,
        **style,
    )
    image.set_clip_path(edge)
    axes.set(xlim=window.u, ylim=window.v, xlabel="u′", ylabel="v′")
    axes.spines[["top", "right"]].set_visible(False)
    return image


def _draw_lamp_marks(axes: Any, table: EmissionTable) -> None:
    axes.plot(*table.data.entries.uv.T, label="lamp that is exact", **LAMP)


def _draw_wavelengths(axes: Any, table: EmissionTable) -> None:
    """Name wavelengths outside the locus, away from white."""
    places = {
        float(at): uv for at, uv in zip(table.wavelengths, _locus(table), strict=True)
    }
    white = table.data.lattice.white
    for wavelength in WAVELENGTHS:
        if wavelength not in places:
            continue
        uv = places[wavelength]
        outward = (uv - white) / np.linalg.norm(uv - white)
        axes.plot(*uv, marker="o", markersize=2, color=GREY)
        axes.annotate(
            f"{wavelength}",
            uv,
            9 * outward,
            textcoords="offset points",
            ha="center",
            va="center",
            color=INK,
        )


def _locus(table: EmissionTable) -> Array:
    """u′v′ (N, 2) of single wavelengths; that of white where the observer does not
    respond.
    """
    responds = table.data.cmfs.sum(axis=1) > 0
    xyz = np.where(responds[:, None], table.data.cmfs, table.rgb_to_xyz.sum(axis=1))
    return chromaticity(xyz)
