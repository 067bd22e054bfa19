"""Cubes and atlases in notebooks: figures of spectra, and HTML. `Cube` and `Atlas`
import it when needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from markupsafe import Markup, escape

from uplift.atlas import Atlas, resample
from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array
from uplift.common.text import pluralise, printable
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.pages.figure import GREY, new_figure, style_spectrum_axes, to_svg
from uplift.lookup import Cube

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MAX_SWATCHES = 64
MAX_SPECTRA = 24
MAX_ROWS = 100  # entries of an atlas shown
# Linear RGB shown for a cube without an atlas.
PRIMARIES = np.array(
    [
        [0.8, 0.1, 0.1],
        [0.1, 0.8, 0.1],
        [0.1, 0.1, 0.8],
        [0.8, 0.8, 0.8],
        [0.2, 0.2, 0.2],
    ]
)
SWATCH = "display:inline-block;width:1.4em;height:1.4em;margin:1px;background:"
# Width and height of the plot of an entry in pixels; the height is reflectance from 0
# to 1.
SPARKLINE = (120, 24)


def plot_cube(cube: Cube, rgb: Array) -> Figure:
    """Plot the reflectance spectra of linear RGB (n, 3), each in its own colour."""
    figure = new_figure(6.0, 3.2)
    axes = figure.subplots()
    for spectrum, code in zip(
        cube.reflectance(rgb), hex_codes(rgb, cube.data.sensor), strict=True
    ):
        axes.plot(cube.wavelengths, spectrum, color=GREY, linewidth=2.4)
        axes.plot(cube.wavelengths, spectrum, color=code, linewidth=1.6, label=code)
    style_spectrum_axes(axes)
    return figure


def cube_html(cube: Cube) -> Markup:
    """Summarise a cube: facts, swatches of its atlas entries, and spectra."""
    rows = Markup().join(
        Markup("<tr><th style='text-align:left'>{}</th><td>{}</td></tr>").format(*fact)
        for fact in _facts(cube).items()
    )
    colours = cube.data.atlas.rgb if cube.atlas_names else PRIMARIES
    shown = colours[cube.covers(colours)][:MAX_SPECTRA]
    plot = to_svg(plot_cube(cube, shown)) if len(shown) else Markup()
    return Markup(
        "<div><table>{}</table><div>{}</div><div style='max-width:36em'>{}</div></div>"
    ).format(rows, _swatches(cube), plot)


def atlas_html(atlas: Atlas) -> Markup:
    """Format an atlas as a table: a swatch under D65, the name and a small plot of each
    entry.
    """
    shown = atlas[:MAX_ROWS]
    screen = sensor()
    spectra = resample(shown, screen.wavelengths).values
    codes = hex_codes(screen.rgb(spectra), screen)
    rows = Markup().join(
        Markup(
            "<tr><td><span style='{}{}'></span></td><td>{}</td><td>{}</td></tr>"
        ).format(SWATCH, code, printable(name), _sparkline(values))
        for name, code, values in zip(shown.names, codes, spectra, strict=True)
    )
    more = len(atlas) - len(shown)
    if more:
        rows += Markup("<tr><td></td><td colspan='2'>and {} more</td></tr>").format(
            more
        )
    return Markup("<table><caption>{}</caption>{}</table>").format(repr(atlas), rows)


def _sparkline(values: Array) -> Markup:
    """Draw reflectances (N,) in [0, 1] as an SVG line."""
    width, height = SPARKLINE
    x = np.linspace(0, width, len(values))
    points = " ".join(
        f"{a:.1f},{b:.1f}" for a, b in zip(x, height * (1 - values), strict=True)
    )
    line = Markup(
        "<polyline points='{}' fill='none' stroke='currentColor' stroke-width='1'/>"
    ).format(points)
    return Markup("<svg width='{}' height='{}'>{}</svg>").format(width, height, line)


def _facts(cube: Cube) -> dict[str, str]:
    points = cube.data.points.present
    size = cube.data.lattice.size
    return {
        "model": (
            f"{cube.data.model.name}, "
            f"{pluralise(cube.coefficient_count, 'coefficient')}"
        ),
        "lattice": (
            f"dim {cube.dim}, {np.count_nonzero(points):,} of {pluralise(size, 'node')}"
        ),
        "RGB space": f"{cube.space} under {cube.illuminant}",
        "observer": cube.observer,
        "atlas entries": f"{len(cube.atlas_names):,}",
    }


def _swatches(cube: Cube) -> Markup:
    names = cube.atlas_names[:MAX_SWATCHES]
    rgb: Array = cube.data.atlas.rgb[:MAX_SWATCHES]
    swatch = Markup("<span title='{}' style='{}{}'></span>")
    codes = hex_codes(rgb, cube.data.sensor)
    swatches = Markup().join(
        swatch.format(printable(name), SWATCH, code)
        for name, code in zip(names, codes, strict=True)
    )
    more = len(cube.atlas_names) - len(names)
    return swatches + escape(f" and {more} more" if more else "")
