"""Two cubes compared, as a page: figures, maps over the lattice and over images, and
the spectra that differ most.
"""

import math
from collections.abc import Iterator, Mapping

import numpy as np
from markupsafe import Markup
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes, to_display_codes
from uplift.extras.images.exr import blue_slices
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
    worst_of = diff.nodes.compared.max(axis=1)
    limit = MIN_LIMIT
    if worst_of.size:
        limit = max(limit, math.ceil(np.quantile(worst_of, SHARE)))
    dim = diff.cubes[0].data.lattice.dim
    nodes = blue_slices(diff.nodes.largest[: dim**3], dim)
    return render(
        "extras/report/templates/diff.html.j2",
        title=" and ".join(diff.names),
        lead="Where the answers of two cubes differ: ΔE00 between their spectra, the "
        "largest under any of the lights.",
        diff=diff,
        figures=to_json(diff, None, worst),
        limit=limit,
        ramp=RAMP,
        lattice=_map(
            mosaic(nodes), limit, "ΔE00 over the lattice, a tile for each blue"
        ),
        images=[
            _image(diff, changes, images[changes.name], limit)
            for changes in diff.images
        ],
        spectra=list(_worst_spectra(diff, worst)),
    )


def _worst_spectra(diff: CubeDiff, count: int) -> Iterator[dict[str, object]]:
    for changes in diff.sets:
        for row in changes.worst(count):
            yield _spectra(diff, changes, int(row))


def _map(
    values: Array, limit: float, label: str, codes: NDArray[np.uint8] | None = None
) -> Markup:
    """Draw a map of ΔE00 (height, width), next to a picture of 8-bit codes if one is
    given.
    """
    panels = [Panel([error_map(values, limit)])]
    if codes is not None:
        panels.insert(0, Panel([picture(codes, interpolation="antialiased")]))
    figure = draw(panels, len(panels), WIDTH / len(panels), scale=None)
    return to_page_svg(figure, label)


def _image(
    diff: CubeDiff, changes: Changes, rgb: Array, limit: float
) -> tuple[str, Markup]:
    codes = to_display_codes(rgb, diff.cubes[0].data.sensor).astype(np.uint8)
    values = changes.largest.reshape(rgb.shape[:2])
    return changes.name, _map(
        values, limit, f"{changes.name}, and ΔE00 of its pixels", codes
    )


def _spectra(diff: CubeDiff, changes: Changes, row: int) -> dict[str, object]:
    """The two spectra of a colour, or of an entry."""
    sensor = diff.cubes[0].data.sensor
    rgb = changes.rgb[row]
    wavelengths = sensor.wavelengths
    if changes is diff.entries:
        name = diff.pairs.names[row]
        answers = [spectra[row] for spectra in diff.pairs.spectra]
    else:
        name = ""
        answers = [cube.reflectance(rgb, wavelengths) for cube in diff.cubes]
    (code,) = hex_codes(rgb[None], sensor)
    return {
        "title": name or code,
        "set": changes.name,
        "code": code,
        "light": diff.lights[int(changes.delta_e[row].argmax())],
        "delta_e": float(changes.largest[row]),
        "chart": spectra_chart(wavelengths, answers[0], answers[1], None),
    }
