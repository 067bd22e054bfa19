"""HTML table of an atlas for notebooks."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

import numpy as np

from uplift.common.arrays import Array

if TYPE_CHECKING:
    from uplift.atlas.atlas import Atlas

MAX_ROWS = 100
"""Entries shown."""
WIDTH, HEIGHT = 120, 24
"""Size of a plot in pixels: the width is the range of the sensor, the height reflectance from 0 to 1."""
SWATCH = "display:inline-block;width:2em;height:1em;border:1px solid #888;background:"
LINE = 'fill="none" stroke="currentColor" stroke-width="1"'


def atlas_table(atlas: Atlas) -> str:
    """Format an atlas as an HTML table: a swatch under D65, the name and a plot of each entry."""
    from uplift.atlas.resample import resample
    from uplift.colorimetry.observer import sensor
    from uplift.colorimetry.srgb import hex_codes

    shown = atlas[:MAX_ROWS]
    screen = sensor("sRGB")
    spectra = resample(shown, screen.wavelengths).values
    rows = [
        f'<tr><td><span style="{SWATCH}{code}"></span></td><td>{escape(name)}</td><td>{_plot(values)}</td></tr>'
        for name, code, values in zip(
            shown.names, hex_codes(screen.rgb(spectra), screen), spectra, strict=True
        )
    ]
    hidden = len(atlas) - len(shown)
    if hidden:
        rows.append(f'<tr><td></td><td colspan="2">and {hidden} more</td></tr>')
    return f"<table><caption>{escape(repr(atlas))}</caption>{''.join(rows)}</table>"


def _plot(values: Array) -> str:
    """Draw reflectances (N,) in [0, 1] as an SVG line."""
    x = np.linspace(0, WIDTH, len(values))
    points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, HEIGHT * (1 - values), strict=True))
    return f'<svg width="{WIDTH}" height="{HEIGHT}"><polyline points="{points}" {LINE}/></svg>'
