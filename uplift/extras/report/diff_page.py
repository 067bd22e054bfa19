"""Two cubes compared, as a page: figures, maps over the lattice and over images, and
the spectra that differ most.
"""

import math
from collections.abc import Mapping

import numpy as np
from markupsafe import Markup

from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes, to_display_codes
from uplift.extras.images.slices import blue_slices
from uplift.extras.pages.figure import RAMP, to_page_svg
from uplift.extras.pages.html import render
from uplift.extras.pages.marks import error_map, picture
from uplift.extras.pages.panels import Panel, draw
from uplift.extras.pages.sheet import mosaic
from uplift.extras.report.charts import spectra_chart
from uplift.extras.report.diff import Changes, CubeDiff, to_json

MIN_LIMIT = 1.0
"""Smallest ΔE00 at the dark end of maps, so that invisible differences stay pale."""
SHARE = 0.99
"""Share of the nodes below the end."""

WIDTH = 10.5
"""Inches of a map; the page scales it to its columns."""


def render_diff(diff: CubeDiff, images: Mapping[str, Array], worst: int) -> str:
    """Render a comparison, with the images (height, width, 3) in linear RGB that it was
    made for.
    """
    answered = diff.nodes.answered.max(axis=1)
    limit = MIN_LIMIT
    if answered.size:
        limit = max(limit, math.ceil(np.quantile(answered, SHARE)))
    dim = diff.cubes[0].data.lattice.dim
    nodes = mosaic(blue_slices(diff.nodes.worst[: dim**3], dim))
    label = "ΔE00 over the lattice, a tile for each blue"
    maps = {
        f"Nodes of {diff.names[0]}: red rises to the right, green upwards, blue from "
        "tile to tile": _draw([Panel([error_map(nodes, limit)])], label)
    }
    sensor = diff.cubes[0].data.sensor
    for changes in diff.images:
        rgb = images[changes.set]
        codes = to_display_codes(rgb, sensor).astype(np.uint8)
        delta_e = changes.worst.reshape(rgb.shape[:2])
        panels = [
            Panel([picture(codes, interpolation="antialiased")]),
            Panel([error_map(delta_e, limit)]),
        ]
        maps[changes.set] = _draw(panels, f"{changes.set}, and ΔE00 of its pixels")
    spectra = list[dict[str, object]]()
    for changes in diff.sets:
        for row in changes.worst_rows(worst).tolist():
            spectra.append(_spectra(diff, changes, row))
    return render(
        "extras/report/templates/diff.html.j2",
        title=" and ".join(diff.names),
        lead="Where the answers of two cubes differ: ΔE00 between their spectra, the "
        "largest under any of the lights.",
        names=diff.names,
        figures=to_json(diff, None, worst),
        limit=limit,
        ramp=RAMP,
        maps=maps,
        spectra=spectra,
    )


def _draw(panels: list[Panel], label: str) -> Markup:
    """Draw maps of ΔE00, and pictures, side by side."""
    figure = draw(panels, len(panels), WIDTH / len(panels), scale=None)
    return to_page_svg(figure, label)


def _spectra(diff: CubeDiff, changes: Changes, row: int) -> dict[str, object]:
    """The two spectra of a colour, or of an entry."""
    sensor = diff.cubes[0].data.sensor
    rgb = changes.rgb[row]
    at = sensor.wavelengths
    if changes is diff.entries:
        first, second = (spectra[row] for spectra in diff.pairs.spectra)
    else:
        first, second = (cube.reflectance(rgb, at) for cube in diff.cubes)
    (code,) = hex_codes(rgb[None], sensor)
    figures = changes.describe(row)
    return figures | {
        "title": figures.get("entry", code),
        "code": code,
        "chart": spectra_chart(at, first, second, None),
    }
