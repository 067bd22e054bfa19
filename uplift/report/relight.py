"""Colours of an image under other lights, by products of RGB and by spectra of cubes; a figure and a page of them.

The figure has a row per light, a column per method, and a map of the differences. The page has two methods on the two
sides of a line that moves.
"""

import base64
import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry import Sensor
from uplift.colorimetry.delta_e import delta_e_2000, rgb_to_lab
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.lights import DESCRIPTIONS, RELIGHT_LIGHTS
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array, Floats, StrPath
from uplift.common.errors import OutputError
from uplift.cube import common_sensor
from uplift.io.texture.image import read_error, utf8_name
from uplift.lookup import Cube
from uplift.lookup.node_table import prepare_products
from uplift.report.measures import mean_p95_max
from uplift.viz.figure import GREY, INK, RAMP, colour_map, figure_text, new_figure, ramp_codes, show_image, write_figure
from uplift.viz.html import render, resource

RGB_PRODUCT = "RGB × light"  # name of the method that multiplies the RGB of the image by those of the light
MIN_MAP_LIMIT = 2.0  # smallest ΔE00 at the dark end of a map: invisible differences stay pale
JPEG_QUALITY = 92


@dataclass(frozen=True, eq=False)
class Rendering:
    """An image under one light."""

    sensor: Sensor  # The light with an sRGB screen, whose white is that of the light
    # Linear RGB (height, width, 3) of ``sensor`` by the name of the method; `RGB_PRODUCT` is the first
    colours: Mapping[str, Floats]

    @property
    def light(self) -> str:
        """Name of the light."""
        return self.sensor.illuminant

    @property
    def light_label(self) -> str:
        """Name of the light with a description, if it has one."""
        description = DESCRIPTIONS.get(self.light)
        return f"{self.light}, {description}" if description else self.light

    @cached_property
    def differences(self) -> dict[tuple[str, str], Array]:
        """ΔE00 (height, width) between two methods, relative to the white of the light, for all pairs of them."""
        lab = {method: rgb_to_lab(self.sensor, colours) for method, colours in self.colours.items()}
        return {pair: delta_e_2000(*map(lab.__getitem__, pair)) for pair in combinations(lab, 2)}

    def screen_codes(self, method: str) -> NDArray[np.uint8]:
        """Return 8-bit sRGB codes (height, width, 3) of a method; colours outside the gamut are desaturated."""
        return to_display_codes(self.colours[method], SRGB).astype(np.uint8)

    @property
    def map_limit(self) -> float:
        """ΔE00 at the dark end of maps: nearly all differences from `RGB_PRODUCT` are below."""
        differences = [self.differences[RGB_PRODUCT, method] for method in self.colours if method != RGB_PRODUCT]
        return max(MIN_MAP_LIMIT, math.ceil(max(np.quantile(each, 0.95) for each in differences)))


@dataclass(frozen=True, eq=False)
class Relit:
    """An image under several lights."""

    name: str  # Name of the image
    reduction: int  # Pixels of the image per pixel of the colours, along each side
    original: NDArray[np.uint8]  # 8-bit sRGB codes (height, width, 3) of the image itself
    renderings: tuple[Rendering, ...]  # One for each light

    @property
    def methods(self) -> tuple[str, ...]:
        """Names of the methods."""
        return tuple(self.renderings[0].colours)


def relight(
    name: str,
    rgb: Floats,
    cubes: Mapping[str, Cube],
    lights: Sequence[str] = RELIGHT_LIGHTS,
    *,
    opacity: Floats | None = None,
    reduction: int = 1,
    threads: int = 2,
) -> Relit:
    """Compute the colours of an image, linear RGB (height, width, 3), under lights, by each of the cubes.

    ``opacity`` (height, width, 1) multiplies them; ``reduction`` is that of the image, along each side.
    """
    sensor = common_sensor(cube.data for cube in cubes.values())
    screens = display_sensors(lights, sensor.observer, *sensor.range)
    by_spectra = {method: _by_spectra(cube, rgb, screens, threads) for method, cube in cubes.items()}
    weight = np.float32(1) if opacity is None else opacity
    original = to_display_codes(rgb * weight, sensor).astype(np.uint8)
    renderings = (
        Rendering(
            screen,
            {RGB_PRODUCT: _by_product(sensor, rgb, screen) * weight}
            | {method: colours[number] * weight for method, colours in by_spectra.items()},
        )
        for number, screen in enumerate(screens)
    )
    return Relit(name, reduction, original, tuple(renderings))


def _by_product(sensor: Sensor, rgb: Floats, screen: Sensor) -> Floats:
    """Multiply by the RGB of the light, as renderers do, and adapt the product to the white of the screen."""
    light = sensor.xyz_to_rgb @ screen.light.white
    to_screen = screen.xyz_to_rgb @ sensor.rgb_to_xyz
    return np.asarray((rgb * light) @ to_screen.T, dtype=np.float32)


def _by_spectra(cube: Cube, rgb: Floats, screens: Sequence[Sensor], threads: int) -> list[Floats]:
    """Integrate the spectra of all pixels under each light."""
    matrix = np.concatenate([screen.matrix for screen in screens])
    colours = prepare_products(cube.data, screens[0].wavelengths, matrix, threads)(rgb)
    return np.split(colours, len(screens), axis=-1)


PANEL = 3.4  # width of a panel in inches
DPI = 140
LABELS = 0.3  # height in inches of the texts of a row


def write_relit_sheet(relit: Sequence[Relit], path: StrPath, *, force: bool = False) -> None:
    """Write relit images as one figure: PNG, SVG or PDF, by the suffix of its file."""
    rows = [(image, rendering) for image in relit for rendering in image.renderings]
    columns = len(relit[0].methods) + 1
    heights = [image.original.shape[0] / image.original.shape[1] * PANEL + LABELS for image, _ in rows]
    figure = new_figure(columns * (PANEL + 0.06) + 0.5, sum(heights) + 0.35)
    figure.set_dpi(DPI)
    figure.get_layout_engine().set(w_pad=0.03, h_pad=0.03, wspace=0, hspace=0)
    grid = figure.subplots(len(rows), columns, squeeze=False, height_ratios=heights)
    for axes, (image, rendering) in zip(grid, rows, strict=True):
        _draw_row(figure, axes, image, rendering)
    for axes, title in zip(grid[0], (*relit[0].methods, "ΔE00, first to last"), strict=True):
        axes.set_title(figure_text(title), fontsize=11, color=INK, pad=6)
    write_figure(figure, path, force=force)


def _draw_row(figure: Any, axes: Sequence[Any], image: Relit, rendering: Rendering) -> None:
    from matplotlib.ticker import MaxNLocator

    for each, method in zip(axes, image.methods, strict=False):
        show_image(each, rendering.screen_codes(method), interpolation="antialiased")
        if method != RGB_PRODUCT:
            found = mean_p95_max(rendering.differences[RGB_PRODUCT, method])
            text = f"ΔE00 from RGB × light: mean {found['mean']:.1f}, 95 % {found['p95']:.1f}"
            each.set_xlabel(text, fontsize=9, color=GREY)
    difference = rendering.differences[RGB_PRODUCT, image.methods[-1]]
    drawn = show_image(axes[-1], difference, cmap=colour_map(), vmin=0, vmax=rendering.map_limit)
    bar = figure.colorbar(drawn, ax=axes[-1], fraction=0.04, pad=0.02, extend="max")
    bar.outline.set_visible(False)
    bar.locator = MaxNLocator(4, integer=True)
    axes[0].set_ylabel(rendering.light_label, fontsize=11, color=INK, labelpad=6)
    axes[0].set_xlabel(figure_text(image.name), fontsize=9, color=GREY)


def relit_page(relit: Sequence[Relit]) -> str:
    """Render relit images as one self-contained HTML page. It opens under the light with the largest differences."""
    first, methods = relit[0], relit[0].methods
    lights = [rendering.light_label for rendering in first.renderings]
    last = methods[-1]
    changes = [
        np.mean([image.renderings[number].differences[RGB_PRODUCT, last].mean() for image in relit])
        for number in range(len(lights))
    ]
    limits = [max(image.renderings[number].map_limit for image in relit) for number in range(len(lights))]
    return render(
        "report/templates/relight_page.html.j2",
        title="Images under other lights",
        lead="Lights multiply the RGB of the image, or spectra of these colours. Drag the line, or use the arrow keys.",
        lights=lights,
        methods=methods,
        start=int(np.argmax(changes)),
        limits=limits,
        ramp=RAMP,
        sections=[_section(image, limits) for image in relit],
        script=resource("report/relight_page.js"),
    )


def _section(image: Relit, limits: Sequence[float]) -> dict[str, Any]:
    """One relit image: its layers, and a row of the table for each light and pair of methods.

    A layer has the number of its ``light``, and ``shows`` the number of a method or 'first-second' of a map. The
    original, whose number follows those of the methods, has no light.
    """

    def layer(light: int | str, shows: str, label: str, codes: NDArray[np.uint8], kind: str = "jpeg") -> dict[str, Any]:
        return {"light": light, "shows": shows, "label": label, "source": _encoded(codes, kind)}

    layers, rows = [layer("", str(len(image.methods)), image.name, image.original)], []
    for number, (rendering, limit) in enumerate(zip(image.renderings, limits, strict=True)):
        for method, name in enumerate(image.methods):
            label = f"{image.name} under {rendering.light}, {name}"
            layers.append(layer(number, str(method), label, rendering.screen_codes(name)))
        for (one, first), (other, second) in combinations(enumerate(image.methods), 2):
            difference = rendering.differences[first, second]
            label = f"ΔE00 map of {image.name} under {rendering.light}: {first}, {second}"
            codes = ramp_codes(np.rint(255 * np.clip(difference / limit, 0, 1)) / 255)
            layers.append(layer(number, f"{one}-{other}", label, codes, "png"))
            errors = (f"{each:.2f}" for each in mean_p95_max(difference).values())
            rows.append((rendering.light, first, second, *errors))
    height, width, _ = image.original.shape
    size = {"width": width, "height": height, "reduction": image.reduction}
    return {"name": image.name, **size, "layers": layers, "rows": rows}


def _encoded(codes: NDArray[np.uint8], kind: str = "jpeg") -> str:
    """Encode 8-bit codes (height, width, 3) as the URL of a JPEG, or of a PNG, which has them exactly."""
    import OpenImageIO

    height, width, channels = codes.shape
    spec = OpenImageIO.ImageSpec(width, height, channels, "uint8")
    spec.attribute("Compression", f"jpeg:{JPEG_QUALITY}")
    spec.attribute("jpeg:subsampling", "4:4:4")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"image.{kind}"
        image = OpenImageIO.ImageOutput.create(kind)
        if not (image and image.open(utf8_name(path, OutputError), spec) and image.write_image(codes)):
            raise OSError(read_error(image or OpenImageIO))
        image.close()
        return f"data:image/{kind};base64,{base64.b64encode(path.read_bytes()).decode()}"
