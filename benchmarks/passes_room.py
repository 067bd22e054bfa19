"""A room with a ColorChecker, lit by daylight and by a sodium lamp: rendered by passes,
as RGB, and as spectra, for docs/guides/passes.md and its picture.

Two renderings are the truth. ``scalar_spectral`` traces the measured spectra; its noise
is that of other random numbers. ``scalar_rgb`` traces the 81 wavelengths of the spectra
in passes of three with the random numbers of all other passes, so that differences are
those of the representation alone.
"""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks import DOCS, Row, mitsuba_scenes, summary
from benchmarks.checker import Layout, chart, photo
from benchmarks.passes import without_family
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.arrays import Array
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import error_map
from uplift.extras.pages.panels import Panel, draw
from uplift.extras.processes import call_in_child
from uplift.extras.scene.passes.bands import CHANNELS
from uplift.extras.scene.passes.choice import choose
from uplift.extras.scene.passes.passes import scaled_power

SPECTRAL = mitsuba_scenes.VARIANT
LAMPS = ("D65", "HP1")
"""Lights of the left and of the right lamp."""
PAINTED = {
    "floor": 20,
    "ceiling": 18,
    "back": 21,
    "red-wall": 14,
    "green-wall": 13,
    "small-box": 15,
}
"""Patches of the ColorChecker that parts of the Cornell box are painted in."""
FAMILY = "checker"
"""Family of the library that holds the paints of the room, and is left out."""
COUNTS = (1, 2, 3)
SIZE = 160
"""Rows and columns of pictures, a multiple of `BLOCK`."""
BLOCK = 8
"""Rows and columns of pixels whose means have little noise."""
SAMPLES = {"scalar_rgb": 144, SPECTRAL: 576}
"""Samples per pixel by variant, of three numbers and of four wavelengths."""
REFLECTIONS = 6
SEED = 3
LIMIT = 3600
"""Seconds after which a rendering counts as hung."""
WHITE_LEVEL = 0.97
"""Quantile of luminance that pictures show as white."""
SPECTRA = "spectra, 81 wavelengths"
RGB = "RGB"
TITLES = {SPECTRA: "spectra", RGB: "plain RGB", "1": "one pass", "2": "two passes"}
PICTURE = DOCS / "passes" / "room.png"


@dataclass(frozen=True, eq=False)
class Numbers:
    """Numbers of the patches (24, K) and of the lamps (2, K), three of them a pass, and
    the matrix (3, K) from those of pixels to XYZ.

    The spectral variant takes all 81 at once, and returns XYZ.
    """

    surfaces: Array
    lamps: Array
    to_xyz: Array


@dataclass(frozen=True, eq=False)
class Rendering:
    """XYZ (height, width, 3) of a picture, and the CPU seconds that it took."""

    xyz: Array
    seconds: float


def room(surfaces: Sequence[Row], lamps: Sequence[Row], film: Row) -> Row:
    """Describe the Cornell box of Mitsuba with a chart, a ball and two lamps, from
    reflectances of the patches (24) and radiances of the lamps.
    """
    import mitsuba as mi

    transform = mi.ScalarTransform4f
    paint = [mitsuba_scenes.diffuse(surface) for surface in surfaces]
    scene = {name: mi.cornell_box()[name] for name in ("sensor", *PAINTED)}
    scene["sensor"]["film"] = film
    # Every path is traced to its end: random numbers then stay those of one pass.
    depths = {"max_depth": REFLECTIONS + 1, "rr_depth": 1000}
    scene["integrator"] = {"type": "path", **depths}
    scene["ball"] = {"type": "sphere", "center": [-0.5, -0.72, -0.1], "radius": 0.28}
    for name, x, radiance in zip(LAMPS, (-0.55, 0.55), lamps, strict=True):
        turned = transform().translate([x, 0.99, 0]).rotate([1, 0, 0], 90)
        scene[name] = {
            "type": "rectangle",
            "to_world": turned.scale([0.25, 0.3, 1]),
            "emitter": {"type": "area", "radiance": radiance},
        }
    layout = Layout(patch=20, gap=3)
    width, height = layout.size
    half = layout.patch / 2
    to_wall = transform().translate([0, 0.45, -0.99]).scale(1.2 / width)
    for number, (x, y) in enumerate(layout.corners()):
        middle = [x + half - width / 2, height / 2 - y - half, 0]
        placed = to_wall.translate(middle).scale(half)
        scene[f"patch {number}"] = {"type": "rectangle", "to_world": placed}
    painted = {**PAINTED, "ball": 7}
    painted |= {f"patch {number}": number for number in range(len(paint))}
    for name, patch in painted.items():
        scene[name]["bsdf"] = paint[patch]
    return scene


def all_numbers(counts: Sequence[int]) -> dict[str, Numbers]:
    """Return the numbers of all wavelengths, of RGB, of bands that are chosen without
    the paints, and of spectra.
    """
    spectra = np.clip(chart().measured, 0, 1)
    powers = np.stack([scaled_power(name) for name in LAMPS])
    screen = observer.sensor()
    to_xyz = observer.matching_functions().T
    rgb_lamps = np.maximum(powers @ to_xyz.T @ screen.xyz_to_rgb.T, 0)
    numbers = {
        SPECTRA: Numbers(spectra, powers, to_xyz),
        RGB: Numbers(chart().painted, rgb_lamps, screen.rgb_to_xyz),
    }
    materials = without_family(FAMILY, spectra)
    for count in counts:
        chosen = choose(materials, LAMPS, count)
        lamps = np.stack([light.numbers for light in chosen.lights])
        surfaces = chosen.reflectance_numbers(spectra)
        numbers[f"{count}"] = Numbers(surfaces, lamps, chosen.to_xyz)
    return {**numbers, SPECTRAL: Numbers(spectra, powers, np.eye(3))}


def render(numbers: Numbers, variant: str, size: int, samples: int) -> Rendering:
    """Render all passes by a variant of Mitsuba, and decode."""
    mitsuba_scenes.start_mitsuba(variant)
    surface = light = mitsuba_scenes.rgb
    width = CHANNELS
    film = mitsuba_scenes.film(size, size, "rgb")
    if variant == SPECTRAL:
        surface, light = mitsuba_scenes.spectrum, mitsuba_scenes.radiance
        width = numbers.surfaces.shape[1]
        film = mitsuba_scenes.film(size, size)
    xyz = np.zeros((size, size, 3))
    begin = time.process_time()
    for first in range(0, numbers.surfaces.shape[1], width):
        part = slice(first, first + width)
        surfaces = list(map(surface, numbers.surfaces[:, part]))
        lamps = list(map(light, numbers.lamps[:, part]))
        picture = mitsuba_scenes.render(room(surfaces, lamps, film), samples, SEED)
        xyz += picture @ numbers.to_xyz[:, part].T
    return Rendering(xyz, time.process_time() - begin)


def render_all(
    size: int, samples: Mapping[str, int], counts: Sequence[int]
) -> dict[str, Rendering]:
    """Render all passes in child processes, as bright as pictures show them."""
    rendered = {}
    for name, numbers in all_numbers(counts).items():
        variant = SPECTRAL if name == SPECTRAL else "scalar_rgb"
        job = (numbers, variant, size, samples[variant])
        rendered[name] = call_in_child(render, *job, seconds=LIMIT)
    white = np.quantile(rendered[SPECTRA].xyz[..., 1], WHITE_LEVEL)
    return {
        name: replace(rendering, xyz=rendering.xyz / white)
        for name, rendering in rendered.items()
    }


def delta_e(first: Array, second: Array) -> Array:
    """ΔE00 (height, width) of XYZ (height, width, 3), for the white of D65."""
    white = observer.light("D65").white
    return delta_e_2000(lab(first, white), lab(second, white))


def blocks(picture: Array) -> Array:
    """Return the means of blocks of pixels."""
    rows = len(picture) // BLOCK
    return picture.reshape(rows, BLOCK, rows, BLOCK, 3).mean(axis=(1, 3))


def errors(rendered: dict[str, Rendering]) -> Iterator[Row]:
    """Yield the errors of pixels, those of blocks to the spectral variant, and the
    seconds, by method.
    """
    truth = rendered[SPECTRA].xyz
    spectral = blocks(rendered[SPECTRAL].xyz)
    for method, rendering in rendered.items():
        yield {
            "method": method,
            **summary(delta_e(truth, rendering.xyz).ravel()),
            "to_spectral": delta_e(spectral, blocks(rendering.xyz)).mean(),
            "seconds": rendering.seconds,
        }


def draw_room(rendered: dict[str, Rendering]) -> None:
    """Draw the renderings, and below each its differences from all wavelengths."""
    shown = {**TITLES, SPECTRAL: SPECTRAL}
    to_srgb = observer.sensor().xyz_to_rgb.T
    panels = [
        Panel([photo(rendered[name].xyz @ to_srgb)], title)
        for name, title in shown.items()
    ]
    truth = rendered[SPECTRA].xyz
    maps = [delta_e(truth, rendered[name].xyz) for name in list(TITLES)[1:]]
    largest = float(np.quantile(maps[0], 0.95))
    for values in maps:
        marks = [error_map(values, largest)]
        panels.append(Panel(marks, f"mean ΔE00 {values.mean():.2f}"))
    write_figure(draw(panels, len(TITLES), 2.4, dpi=180), PICTURE, force=True)


def measure() -> list[Row]:
    """Render and draw the room, and return the errors."""
    rendered = render_all(SIZE, SAMPLES, COUNTS)
    draw_room(rendered)
    return list(errors(rendered))


QUESTIONS = {"errors": measure}
