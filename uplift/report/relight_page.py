"""Relit images as a page: two methods on the two sides of a line that moves, and maps of their differences."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import StrPath
from uplift.common.files import write_text
from uplift.report.relight import RGB_PRODUCT, Relit, Rendering
from uplift.viz.figure import RAMP, ramp_codes
from uplift.viz.html import render, resource

JPEG_QUALITY = 92


@dataclass(frozen=True)
class Layer:
    """An image of the page: ``light`` and ``shows``, the number of a method or 'first-second' of a map."""

    light: int
    shows: str
    label: str
    source: str


@dataclass(frozen=True)
class Section:
    """One relit image: its layers, and a row of the table for each light and pair of methods."""

    name: str
    width: int
    height: int
    reduction: int
    layers: tuple[Layer, ...]
    rows: tuple[tuple[str, ...], ...]


def write_relit_page(relit: Sequence[Relit], path: StrPath, *, force: bool = False) -> int:
    """Write relit images as one self-contained HTML page."""
    text = page(relit)
    write_text(text, path, force=force)
    return len(text.encode())


def page(relit: Sequence[Relit]) -> str:
    """Render the page. It opens under the light with the largest differences."""
    first, methods = relit[0], relit[0].methods
    lights = [rendering.light_label for rendering in first.renderings]
    last = methods[-1]
    changes = [
        np.mean([image.renderings[number].difference(RGB_PRODUCT, last).mean for image in relit])
        for number in range(len(lights))
    ]
    return render(
        "report/templates/relight_page.html.j2",
        title="Images under other lights",
        lead="The same RGB, lit by products of RGB and by spectra. Drag the line, or use the arrow keys.",
        lights=lights,
        methods=methods,
        start=int(np.argmax(changes)),
        limits=[_limit(relit, number) for number in range(len(lights))],
        ramp=RAMP,
        sections=[_section(image, [_limit(relit, number) for number in range(len(lights))]) for image in relit],
        script=resource("report/relight_page.js"),
    )


def _limit(relit: Sequence[Relit], light: int) -> float:
    return max(image.renderings[light].map_limit for image in relit)


def _section(image: Relit, limits: Sequence[float]) -> Section:
    layers, rows = [], []
    for number, (rendering, limit) in enumerate(zip(image.renderings, limits, strict=True)):
        for method, name in enumerate(image.methods):
            label = f"{image.name} under {rendering.light}, {name}"
            layers.append(Layer(number, str(method), label, _jpeg(rendering.screen_codes(name))))
        for (one, first), (other, second) in combinations(enumerate(image.methods), 2):
            difference = rendering.difference(first, second)
            label = f"ΔE00 map of {image.name} under {rendering.light}: {first}, {second}"
            layers.append(Layer(number, f"{one}-{other}", label, _map(difference.delta_e / limit)))
            figures = (difference.mean, difference.p95, difference.max)
            rows.append((rendering.light, first, second, *(f"{figure:.2f}" for figure in figures)))
    height, width = _size(image.renderings[0])
    return Section(image.name, width, height, image.reduction, tuple(layers), tuple(rows))


def _size(rendering: Rendering) -> tuple[int, int]:
    height, width, _ = rendering.colours[RGB_PRODUCT].shape
    return height, width


def _jpeg(codes: NDArray[np.uint8]) -> str:
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(codes).save(file, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    return _data_url("image/jpeg", file)


def _map(values: NDArray[np.float64]) -> str:
    """Encode a map as a PNG with a palette of the 256 colours of the ramp."""
    from PIL import Image

    image = Image.fromarray(np.rint(255 * np.clip(values, 0, 1)).astype(np.uint8), "P")
    image.putpalette(ramp_codes(np.linspace(0, 1, 256)).tobytes())
    file = io.BytesIO()
    image.save(file, "PNG", optimize=True)
    return _data_url("image/png", file)


def _data_url(kind: str, file: io.BytesIO) -> str:
    return f"data:{kind};base64,{base64.b64encode(file.getvalue()).decode()}"
