"""Colours of an image under other lights, by products of RGB and by spectra of cubes; a
figure and a page of them.

The figure has a row per light, a column per method, and a map of the differences. The
page has two methods on the two sides of a line that moves.
"""

import base64
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_2000, rgb_to_lab
from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.illuminants import Illuminant
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Floats, Mask, StrPath
from uplift.cube.data import common_sensor
from uplift.extras.colour.light_sets import DESCRIPTIONS, RELIGHT_LIGHTS
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.figure import RAMP, ramp_codes, write_figure
from uplift.extras.pages.html import render, resource
from uplift.extras.pages.marks import error_map, picture
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.report.comparison import mean_p95_max
from uplift.lookup.cube import Cube
from uplift.lookup.node_table import prepare_products

# name of the method that multiplies the RGB of the image by those of the light
RGB_PRODUCT = "RGB × light"
# smallest ΔE00 at the dark end of maps: invisible differences stay pale
MIN_MAP_LIMIT = 4
# maps are darker by the root of ΔE00, so that one scale serves daylight and sodium
# lamps
MAP_EXPONENT = 0.5
# Share of the largest linear sRGB component of a light below which its smallest is that
# of a colour, not of a white: lamps from 2500 K on are above, sodium lamps and candles
# below.
MIN_WHITE = 0.05
JPEG_QUALITY = 92


@dataclass(frozen=True, eq=False)
class Rendering:
    """An image under one light."""

    sensor: Sensor  # The light with an sRGB screen, whose white is that of the light
    # Linear RGB (height, width, 3) of ``sensor`` by the name of the method;
    # `RGB_PRODUCT` is the first
    colours: Mapping[str, Floats]
    # (3, 3): from these colours, white-balanced, to linear sRGB that keeps the tint of
    # the light
    tint: Array
    visible: Mask  # Pixels (height, width) whose differences count

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
        """ΔE00 (height, width) between two methods, relative to the white of the light,
        for all pairs of them.
        """
        lab = {
            method: rgb_to_lab(self.sensor, colours)
            for method, colours in self.colours.items()
        }
        return {
            pair: delta_e_2000(*map(lab.__getitem__, pair))
            for pair in combinations(lab, 2)
        }

    def errors(self, pair: tuple[str, str]) -> dict[str, float]:
        """Mean, 95 % and largest ΔE00 between two methods."""
        return mean_p95_max(self.differences[pair][self.visible])

    @property
    def looks_white(self) -> bool:
        """Whether the eye takes the light for white, and adapts to it."""
        white = self.tint.sum(axis=1)
        return bool(white.min() >= MIN_WHITE * white.max())

    def is_balanced(self, adapt: bool | None) -> bool:
        """Whether the light is shown as white: ``adapt``, or by default whether it
        looks white.
        """
        return self.looks_white if adapt is None else adapt

    def screen_codes(self, method: str, *, balanced: bool) -> NDArray[np.uint8]:
        """Return 8-bit sRGB codes (height, width, 3) of a method; colours outside the
        gamut are desaturated.

        Colours that are not ``balanced`` have the tint of the light, as bright as its
        white fits the screen.
        """
        colours = self.colours[method]
        if not balanced:
            brightest = self.tint.sum(axis=1).max()
            colours = colours @ (self.tint / brightest).T
        return to_display_codes(colours, SRGB).astype(np.uint8)


@dataclass(frozen=True, eq=False)
class Relit:
    """An image under several lights."""

    name: str  # Name of the image
    reduction: int  # Pixels of the image per pixel of the colours, along each side
    # 8-bit sRGB codes (height, width, 3) of the image itself
    original: NDArray[np.uint8]
    renderings: tuple[Rendering, ...]  # One for each light

    @property
    def methods(self) -> tuple[str, ...]:
        """Names of the methods."""
        return tuple(self.renderings[0].colours)

    @property
    def shown_pair(self) -> tuple[str, str]:
        """The two methods that figures and pages compare first."""
        return RGB_PRODUCT, self.methods[-1]


def map_limit(relit: Sequence[Relit]) -> int:
    """ΔE00 at the dark end of all maps of a figure or page, a multiple of 4.

    Nearly all differences from `RGB_PRODUCT` are below.
    """
    limits = [MIN_MAP_LIMIT]
    for image in relit:
        for rendering in image.renderings:
            for method in image.methods[1:]:
                difference = rendering.differences[RGB_PRODUCT, method]
                limits.append(4 * math.ceil(np.quantile(difference, 0.95) / 4))
    return max(limits)


def relight(
    name: str,
    rgb: Floats,
    cubes: Mapping[str, Cube],
    lights: Sequence[Illuminant] = RELIGHT_LIGHTS,
    *,
    opacity: Floats | None = None,
    visible: Mask | None = None,
    reduction: int = 1,
    threads: int = 2,
) -> Relit:
    """Compute the colours of an image, linear RGB (height, width, 3), under lights, by
    each of the cubes.

    ``opacity`` (height, width, 1) multiplies them; of differences those of ``visible``
    pixels (height, width) count, unless there are none; ``reduction`` is that of the
    image, along each side.
    """
    sensor = common_sensor(cube.data for cube in cubes.values())
    screens = display_sensors(lights, sensor.observer, *sensor.range)
    by_spectra = {
        method: _by_spectra(cube, rgb, screens, threads)
        for method, cube in cubes.items()
    }
    weight = np.float32(1) if opacity is None else opacity
    if visible is None or not visible.any():
        visible = np.ones(rgb.shape[:2], dtype=bool)
    original = to_display_codes(rgb * weight, sensor).astype(np.uint8)
    to_srgb = conversion(sensor, SRGB) @ sensor.xyz_to_rgb
    renderings = []
    for number, screen in enumerate(screens):
        colours = {RGB_PRODUCT: _by_product(sensor, rgb, screen) * weight}
        for method, of_lights in by_spectra.items():
            colours[method] = of_lights[number] * weight
        tint = to_srgb @ screen.rgb_to_xyz
        renderings.append(Rendering(screen, colours, tint, visible))
    return Relit(name, reduction, original, tuple(renderings))


def _by_product(sensor: Sensor, rgb: Floats, screen: Sensor) -> Floats:
    """Multiply by the RGB of the light, as renderers do, and adapt the product to the
    white of the screen.
    """
    light = sensor.xyz_to_rgb @ screen.light.white
    to_screen = screen.xyz_to_rgb @ sensor.rgb_to_xyz
    return np.asarray((rgb * light) @ to_screen.T, dtype=np.float32)


def _by_spectra(
    cube: Cube, rgb: Floats, screens: Sequence[Sensor], threads: int
) -> list[Floats]:
    """Integrate the spectra of all pixels under each light."""
    matrix = np.concatenate([screen.matrix for screen in screens])
    colours = prepare_products(cube.data, screens[0].wavelengths, matrix, threads)(rgb)
    return np.split(colours, len(screens), axis=-1)


PANEL = 3.4  # width of a panel in inches
DPI = 140


def write_relit_sheet(
    relit: Sequence[Relit],
    path: StrPath,
    *,
    adapt: bool | None = None,
    force: bool = False,
) -> None:
    """Write relit images as one figure: PNG, SVG or PDF, by the suffix of its file.

    With ``adapt`` the white of each light is shown as white; by default if it
    `looks_white`.
    """
    limit = map_limit(relit)
    panels: list[Panel] = []
    for image in relit:
        for rendering in image.renderings:
            balanced = rendering.is_balanced(adapt)
            panels += _sheet_row(image, rendering, limit, balanced=balanced)
    first, second = relit[0].shown_pair
    titles = [*relit[0].methods, f"ΔE00 between {first}\nand {second}"]
    for number, title in enumerate(titles):
        panels[number] = replace(panels[number], title=title)
    figure = draw(panels, len(titles), PANEL, dpi=DPI)
    write_figure(figure, path, force=force)


def _sheet_row(
    image: Relit, rendering: Rendering, limit: float, *, balanced: bool
) -> list[Panel]:
    """Return the panels of an image under one light: each method, and the map."""
    panels = []
    for method in image.methods:
        codes = rendering.screen_codes(method, balanced=balanced)
        caption = image.name
        if method != RGB_PRODUCT:
            errors = rendering.errors((RGB_PRODUCT, method))
            caption = (
                f"ΔE00 from RGB × light: mean {errors['mean']:.1f}, 95 % "
                f"{errors['p95']:.1f}"
            )
        marks = [picture(codes, interpolation="antialiased")]
        panels.append(Panel(marks, x=Axis(caption)))
    state = "white-balanced" if balanced else "tinted"
    panels[0] = replace(panels[0], y=Axis(f"{rendering.light_label}\n{state}"))
    difference = rendering.differences[image.shown_pair]
    panels.append(Panel([error_map(difference, limit, exponent=MAP_EXPONENT)]))
    return panels


def relit_page(relit: Sequence[Relit], *, adapt: bool | None = None) -> str:
    """Render relit images as one self-contained HTML page. It opens under the light
    with the largest differences.

    The page has both white-balanced and tinted pictures, and begins with those that
    ``adapt`` names.
    """
    first = relit[0]
    changes = []
    for number in range(len(first.renderings)):
        errors = [image.renderings[number].errors(image.shown_pair) for image in relit]
        changes.append(np.mean([error["mean"] for error in errors]))
    limit = map_limit(relit)
    balanced = [rendering.is_balanced(adapt) for rendering in first.renderings]
    return render(
        "extras/relight/templates/relight_page.html.j2",
        title="Images under other lights",
        lead="RGB multiplied by the light, against spectra under the light. Drag the "
        "line, or use the arrow keys.",
        lights=[rendering.light_label for rendering in first.renderings],
        balanced=balanced,
        numbers={"balanced": balanced},
        methods=first.methods,
        start=int(np.argmax(changes)),
        ticks=(0, limit // 4, limit),
        ramp=RAMP,
        sections=[_section(image, limit) for image in relit],
        script=resource("extras/pages/draw.js", "extras/relight/relight_page.js"),
    )


def _section(image: Relit, limit: float) -> dict[str, Any]:
    """One relit image: its layers, and a row of the table for each light and pair of
    methods.

    A layer has the number of its ``light``, and ``shows`` the number of a method or
    'first-second' of a map. The original, whose number follows those of the methods,
    has no light. Only layers of methods are ``balanced`` or not.
    """
    layers = [_layer(image.name, image.original, shows=str(len(image.methods)))]
    rows = []
    for number, rendering in enumerate(image.renderings):
        for method, name in enumerate(image.methods):
            for balanced in (True, False):
                label = f"{image.name} under {rendering.light}, {name}"
                label += ", white-balanced" if balanced else ""
                codes = rendering.screen_codes(name, balanced=balanced)
                layers.append(
                    _layer(
                        label, codes, light=number, shows=str(method), balanced=balanced
                    )
                )
        for (left, first), (right, second) in combinations(enumerate(image.methods), 2):
            difference = rendering.differences[first, second]
            label = (
                f"ΔE00 map of {image.name} under {rendering.light}: {first}, {second}"
            )
            shade = np.clip(difference / limit, 0, 1) ** MAP_EXPONENT
            codes = ramp_codes(np.rint(255 * shade) / 255)
            layers.append(
                _layer(label, codes, light=number, shows=f"{left}-{right}", kind="png")
            )
            errors = (
                f"{value:.2f}" for value in rendering.errors((first, second)).values()
            )
            rows.append((rendering.light, first, second, *errors))
    height, width, _ = image.original.shape
    size = {"width": width, "height": height, "reduction": image.reduction}
    return {"name": image.name, **size, "layers": layers, "rows": rows}


def _layer(
    label: str,
    codes: NDArray[np.uint8],
    *,
    shows: str,
    light: int | str = "",
    balanced: bool | None = None,
    kind: str = "jpeg",
) -> dict[str, Any]:
    return {
        "label": label,
        "source": _encoded(codes, kind),
        "light": light,
        "shows": shows,
        "balanced": balanced,
    }


def _encoded(codes: NDArray[np.uint8], kind: str) -> str:
    """Encode 8-bit codes (height, width, 3) as the URL of a JPEG, or of a PNG, which
    has them exactly.
    """
    from PIL import Image

    file = io.BytesIO()
    image = Image.fromarray(codes)
    image.save(file, kind, quality=JPEG_QUALITY, subsampling=0)
    content = base64.b64encode(file.getvalue()).decode()
    return f"data:image/{kind};base64,{content}"
