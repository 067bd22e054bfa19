"""A room with a ColorChecker, lit by daylight and by a sodium lamp: rendered by passes,
as RGB, and as spectra, for docs/guides/passes.md and its picture.

Two renderings are the truth. ``scalar_spectral`` traces the measured spectra; its noise
is that of other random numbers. ``scalar_rgb`` traces the 81 wavelengths of the spectra
in passes of three with the random numbers of all other passes, so that differences are
those of the representation alone.
"""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks import DOCS, Row, mitsuba_scenes
from benchmarks.checker import Layout, chart, photo
from benchmarks.passes import without_family
from uplift.colorimetry import delta_e_2000, lab, observer
from uplift.common.arrays import Array
from uplift.extras.images.processes import call_in_child
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import error_map
from uplift.extras.pages.panels import Panel, draw
from uplift.extras.scene import passes

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
RGB_SAMPLES = 144
"""Samples per pixel of passes."""
SPECTRAL_SAMPLES = 576
"""Samples of four wavelengths per pixel of the spectral variant."""
REFLECTIONS = 6
SEED = 3
LIMIT = 3600
"""Seconds after which a rendering counts as hung."""
WHITE_LEVEL = 0.97
"""Quantile of luminance that pictures show as white."""
RADIANCE = 12.0
"""Luminance of the lamps."""
SPECTRA = "spectra, 81 wavelengths"
RGB = "RGB"
SPECTRAL = mitsuba_scenes.VARIANT
TITLES = {SPECTRA: "spectra", RGB: "plain RGB", "1": "one pass", "2": "two passes"}
PICTURE = DOCS / "passes" / "room.png"


@dataclass(frozen=True, eq=False)
class Representation:
    """Numbers (24, K) of the patches and (2, K) of the lamps, and the matrix (3, K) to
    XYZ from those of pixels.
    """

    surfaces: Array
    lamps: Array
    to_xyz: Array


@dataclass(frozen=True, eq=False)
class Rendering:
    """XYZ (height, width, 3) of a representation, and the seconds that it took."""

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


def render_passes(represented: Representation, size: int, samples: int) -> Rendering:
    """Render three numbers at a time as RGB, and decode."""
    mitsuba_scenes.start_mitsuba("scalar_rgb")
    film = mitsuba_scenes.film(size, size, "rgb")
    xyz = np.zeros((size, size, 3))
    begin = time.perf_counter()
    for first in range(0, represented.to_xyz.shape[1], 3):
        three = slice(first, first + 3)
        surfaces = map(mitsuba_scenes.rgb, represented.surfaces[:, three])
        lamps = map(mitsuba_scenes.rgb, represented.lamps[:, three])
        scene = room(list(surfaces), list(lamps), film)
        numbers = mitsuba_scenes.render(scene, samples, SEED)
        xyz += numbers @ represented.to_xyz[:, three].T
    return Rendering(xyz, time.perf_counter() - begin)


def render_spectra(
    reflectances: Array, lamps: Array, size: int, samples: int
) -> Rendering:
    """Render reflectances (24, 81) under lamps of power (2, 81)."""
    mitsuba_scenes.start_mitsuba()
    surfaces = map(mitsuba_scenes.spectrum, reflectances)
    radiances = map(mitsuba_scenes.radiance, lamps)
    film = mitsuba_scenes.film(size, size)
    scene = room(list(surfaces), list(radiances), film)
    begin = time.perf_counter()
    xyz = mitsuba_scenes.render(scene, samples, SEED)
    return Rendering(xyz, time.perf_counter() - begin)


def representations(
    spectra: Array, powers: Array, counts: Sequence[int]
) -> dict[str, Representation]:
    """Represent reflectances (24, 81) and lamps (2, 81) by all wavelengths, as RGB, and
    by passes that are chosen without the paints.
    """
    screen = observer.sensor()
    to_xyz = observer.matching_functions().T
    rgb_lamps = np.maximum(powers @ to_xyz.T @ screen.xyz_to_rgb.T, 0)
    represented = {
        SPECTRA: Representation(spectra, powers, to_xyz),
        RGB: Representation(chart().painted, rgb_lamps, screen.rgb_to_xyz),
    }
    materials = without_family(FAMILY, spectra)
    for count in counts:
        chosen = passes.choose(materials, LAMPS, count)
        lamps = RADIANCE * np.stack([light.numbers for light in chosen.lights])
        surfaces = chosen.reflectance_numbers(spectra)
        represented[f"{count}"] = Representation(surfaces, lamps, chosen.to_xyz)
    return represented


def render_all(
    size: int, rgb_samples: int, spectral_samples: int, counts: Sequence[int]
) -> dict[str, Rendering]:
    """Render all representations, and the spectra by the spectral variant, in child
    processes.
    """
    spectra = np.clip(chart().measured, 0, 1)
    powers = RADIANCE * np.stack([passes.scaled_power(name) for name in LAMPS])
    rendered = {
        name: call_in_child(
            render_passes, represented, size, rgb_samples, seconds=LIMIT
        )
        for name, represented in representations(spectra, powers, counts).items()
    }
    rendered[SPECTRAL] = call_in_child(
        render_spectra, spectra, powers, size, spectral_samples, seconds=LIMIT
    )
    return rendered


def white_level(truth: Array) -> float:
    """Return the luminance that pictures show as white."""
    return float(np.quantile(truth[..., 1], WHITE_LEVEL))


def delta_e(first: Array, second: Array, level: float) -> Array:
    """ΔE00 (height, width) of XYZ (height, width, 3), for the white of D65."""
    white = level * observer.light("D65").white
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
    level = white_level(truth)
    for method, rendering in rendered.items():
        pixels = delta_e(truth, rendering.xyz, level)
        spectral = blocks(rendered[SPECTRAL].xyz)
        yield {
            "method": method,
            "mean": pixels.mean(),
            "p95": np.quantile(pixels, 0.95),
            "to_spectral": delta_e(spectral, blocks(rendering.xyz), level).mean(),
            "seconds": rendering.seconds,
        }


def draw_room(rendered: dict[str, Rendering]) -> None:
    """Draw the renderings, and below each its differences from all wavelengths."""
    truth = rendered[SPECTRA].xyz
    level = white_level(truth)
    to_srgb = observer.sensor().xyz_to_rgb / level
    errors = {name: delta_e(truth, rendered[name].xyz, level) for name in TITLES}
    largest = float(np.quantile(errors[RGB], 0.95))
    panels = []
    for name, title in TITLES.items():
        panels.append(Panel([photo(rendered[name].xyz @ to_srgb.T)], title))
    panels.append(Panel([photo(rendered[SPECTRAL].xyz @ to_srgb.T)], SPECTRAL))
    for name in list(TITLES)[1:]:
        title = f"mean ΔE00 {errors[name].mean():.2f}"
        panels.append(Panel([error_map(errors[name], largest)], title))
    write_figure(draw(panels, len(TITLES), 2.4), PICTURE, force=True)


def measure() -> list[Row]:
    """Render and draw the room, and return the errors."""
    rendered = render_all(SIZE, RGB_SAMPLES, SPECTRAL_SAMPLES, COUNTS)
    draw_room(rendered)
    return list(errors(rendered))


QUESTIONS = {"errors": measure}
