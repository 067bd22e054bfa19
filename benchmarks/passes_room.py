"""A room with a ColorChecker, lit by daylight and by a sodium lamp: rendered by passes,
as RGB, and as spectra.

Two renderings are the truth. ``scalar_spectral`` traces the measured spectra; its noise
is that of other random numbers. ``scalar_rgb`` traces the 81 wavelengths of the spectra
in passes of three with the random numbers of all other passes, so that differences are
those of the representation alone.
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import Row
from benchmarks.checker import (
    CIE_Y_INTEGRAL,
    Layout,
    chart,
    regular_spectrum,
    show_srgb,
    xyz_film,
)
from uplift.colorimetry import delta_e_2000, lab, observer
from uplift.common.arrays import Array
from uplift.extras.images.processes import call_in_child
from uplift.extras.pages.figure import colour_map, new_figure, show_image, write_png
from uplift.extras.scene import passes as library
from uplift.extras.scene.passes import Materials
from uplift.fit import shipped_library

LAMPS = ("D65", "HP1")
"""Lights of the left and of the right lamp."""
FAMILY = "checker"
"""Family of the library that holds the paints of the room, and is left out."""
COUNTS = (1, 2, 3)
DEPTH = 7
"""Largest number of reflections and one."""
SEED = 3
LIMIT = 3600
"""Seconds after which a rendering counts as hung."""
WHITE_LEVEL = 0.97
"""Quantile of luminance that pictures show as white."""
RADIANCE = 12.0
"""Luminance of the lamps."""
SPECTRA = "spectra, 81 wavelengths"
RGB = "RGB"
VARIANT = "scalar_spectral"
"""Variant of Mitsuba that traces spectra."""
PAINTED = {
    "floor": 20,
    "ceiling": 18,
    "back": 21,
    "left": 14,
    "right": 13,
    "tall": 15,
    "short": 12,
    "ball": 7,
    **{f"patch_{number}": number for number in range(24)},
}
"""Patches of the ColorChecker that parts of the room are painted in."""
LAMP_NAMES = ("day", "sodium")


@dataclass(frozen=True)
class Quality:
    """Rows and columns of pictures, a multiple of 8, and samples per pixel of passes
    and of the spectral variant.
    """

    size: int = 160
    spp: int = 144
    spectral_spp: int = 576


@dataclass(frozen=True, eq=False)
class Paints:
    """What a renderer gets: textures by the number of a patch (24), and radiances of
    the two lamps.
    """

    surfaces: list[Any]
    lamps: list[Any]


def rgb_value(numbers: Array) -> Row:
    """Describe three numbers that a renderer multiplies as they are."""
    return {"type": "rgb", "value": [float(number) for number in numbers]}


def room(paints: Paints, film: Row) -> Row:
    """Describe the room: a box with a chart, two blocks, a ball and two lamps."""
    import mitsuba as mi

    transform = mi.ScalarTransform4f

    def wall(at: list[float], axis: list[float], angle: float) -> Row:
        placed = transform().translate(at).rotate(axis, angle)
        return {"type": "rectangle", "to_world": placed}

    def block(at: list[float], angle: float, size: list[float]) -> Row:
        placed = transform().translate(at).rotate([0, 1, 0], angle).scale(size)
        return {"type": "cube", "to_world": placed}

    def lamp(number: int, at: list[float]) -> Row:
        placed = transform().translate(at).rotate([1, 0, 0], 90).scale([0.25, 0.3, 1])
        return {
            "type": "rectangle",
            "to_world": placed,
            "emitter": {"type": "area", "radiance": paints.lamps[number]},
        }

    scene: Row = {
        "type": "scene",
        # Every path is traced to its end: random numbers then stay those of one pass.
        "integrator": {"type": "path", "max_depth": DEPTH, "rr_depth": 1000},
        "camera": {
            "type": "perspective",
            "fov": 39,
            "to_world": transform().look_at([0, 0, 3.9], [0, 0, 0], [0, 1, 0]),
            "film": film,
            "sampler": {"type": "independent"},
        },
        "floor": wall([0, -1, 0], [1, 0, 0], -90),
        "ceiling": wall([0, 1, 0], [1, 0, 0], 90),
        "back": wall([0, 0, -1], [1, 0, 0], 0),
        "left": wall([-1, 0, 0], [0, 1, 0], 90),
        "right": wall([1, 0, 0], [0, 1, 0], -90),
        "tall": block([-0.5, -0.55, -0.3], 20, [0.22, 0.45, 0.22]),
        "short": block([0.1, -0.78, 0.2], -18, [0.2, 0.22, 0.2]),
        "ball": {"type": "sphere", "center": [0.6, -0.72, -0.1], "radius": 0.28},
        "day": lamp(0, [-0.55, 0.99, 0.0]),
        "sodium": lamp(1, [0.55, 0.99, 0.0]),
    }
    layout = Layout(patch=20, gap=3)
    width, height = layout.size
    scale = 1.2 / width
    for number, (x, y) in enumerate(layout.corners()):
        half = layout.patch / 2
        middle = [
            scale * (x + half - width / 2),
            0.45 + scale * (height / 2 - y - half),
            -0.99,
        ]
        placed = transform().translate(middle).scale([scale * half, scale * half, 1])
        scene[f"patch_{number}"] = {"type": "rectangle", "to_world": placed}
    for name, patch in PAINTED.items():
        scene[name]["bsdf"] = {
            "type": "diffuse",
            "reflectance": paints.surfaces[patch],
        }
    return scene


def render_rgb(passes: list[Paints], quality: Quality) -> tuple[Array, float]:
    """Return the pictures (height, width, 3 P) of passes, and the seconds of one."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    film = {
        **xyz_film(quality.size, quality.size),
        "pixel_format": "rgb",
        "rfilter": {"type": "box"},
    }
    # One scene for all: the order of lamps, and so the use of random numbers, is a
    # matter of chance when a scene is loaded.
    scene = mi.load_dict(room(passes[0], film), optimize=False)
    values = mi.traverse(scene)
    pictures = []
    begin = time.perf_counter()
    for paints in passes:
        for name, patch in PAINTED.items():
            values[f"{name}.bsdf.reflectance.value"] = paints.surfaces[patch]["value"]
        for name, lamp in zip(LAMP_NAMES, paints.lamps, strict=True):
            values[f"{name}.emitter.radiance.value"] = lamp["value"]
        values.update()
        pictures.append(
            np.array(mi.render(scene, spp=quality.spp, seed=SEED), dtype=float)
        )
    seconds = (time.perf_counter() - begin) / len(passes)
    return np.concatenate(pictures, axis=-1), seconds


def render_spectral(
    spectra: Array, lamps: Array, seed: int, quality: Quality
) -> tuple[Array, float]:
    """Return the XYZ (height, width, 3) of measured spectra (24, 81) under lamps of
    power (2, 81), and the seconds.
    """
    import mitsuba as mi

    mi.set_variant(VARIANT)
    grid = observer.grid()
    # Mitsuba divides XYZ by the integral of y.
    radiance = lamps * CIE_Y_INTEGRAL / observer.STEP
    paints = Paints(
        [regular_spectrum(grid, row) for row in spectra],
        [regular_spectrum(grid, row) for row in radiance],
    )
    film = {**xyz_film(quality.size, quality.size), "rfilter": {"type": "box"}}
    scene = mi.load_dict(room(paints, film))
    begin = time.perf_counter()
    picture = np.array(
        mi.render(scene, spp=quality.spectral_spp, seed=seed), dtype=float
    )
    return picture, time.perf_counter() - begin


def numbers_in_passes(surfaces: Array, lamps: Array) -> list[Paints]:
    """Divide the numbers (24, K) of surfaces and (2, K) of lamps among passes."""
    paints = []
    for first in range(0, surfaces.shape[1], 3):
        bands = slice(first, first + 3)
        paints.append(
            Paints(
                [rgb_value(row) for row in surfaces[:, bands]],
                [rgb_value(row) for row in lamps[:, bands]],
            )
        )
    return paints


def other_materials() -> Materials:
    """Return the library without the paints of the room."""
    families = shipped_library([FAMILY])
    training = np.concatenate([family.measured for family in families])
    return Materials(training, chart().measured, {"source": "library"})


def measure(
    folder: Path, quality: Quality | None = None, counts: Sequence[int] = COUNTS
) -> Row:
    """Render all, draw, and return figures."""
    quality = quality or Quality()
    painted = chart()
    spectra = np.clip(painted.measured, 0, 1)
    powers = RADIANCE * np.stack([library.scaled_power(name) for name in LAMPS])
    jobs = {SPECTRA: (spectra, powers, spectral_decoding())}
    screen = observer.sensor()
    rgb_lamps = powers @ observer.matching_functions() @ screen.xyz_to_rgb.T
    jobs[RGB] = (painted.painted, np.maximum(rgb_lamps, 0), screen.rgb_to_xyz)
    for count in counts:
        chosen = library.choose(other_materials(), LAMPS, count)
        lamps = RADIANCE * np.stack([light.numbers for light in chosen.lights])
        surfaces = chosen.reflectance_numbers(spectra)
        jobs[f"{count}"] = (surfaces, lamps, chosen.to_xyz)
    every = []
    for surfaces, lamps, _ in jobs.values():
        every += numbers_in_passes(surfaces, lamps)
    rendered, one = call_in_child(render_rgb, every, quality, seconds=LIMIT)
    pictures = {}
    seconds = {}
    first = 0
    for name, (surfaces, _, to_xyz) in jobs.items():
        count = surfaces.shape[1] // 3
        numbers = rendered[..., 3 * first : 3 * (first + count)]
        pictures[name] = numbers @ to_xyz.T
        seconds[name] = one * count
        first += count
    truth, spectral_seconds = call_in_child(
        render_spectral, spectra, powers, SEED, quality, seconds=LIMIT
    )
    figures = draw_and_compare(pictures, seconds, truth, folder)
    figures["room_spectra"] |= {
        "seconds": spectral_seconds,
        "spp": quality.spectral_spp,
    }
    return figures | {
        "room_size": quality.size,
        "room_spp": quality.spp,
        "room_lamps": LAMPS,
        "room_depth": DEPTH - 1,
    }


def spectral_decoding() -> Array:
    """Matrix (3, 81) from powers at all wavelengths to XYZ."""
    return observer.matching_functions().T


def blocks_of(picture: Array, size: int) -> Array:
    """Means of blocks of pixels, which have less noise."""
    rows = len(picture) // size
    return picture.reshape(rows, size, rows, size, 3).mean(axis=(1, 3))


def draw_and_compare(
    pictures: dict[str, Array],
    seconds: dict[str, float],
    spectral: Array,
    folder: Path,
) -> Row:
    """Draw pictures and maps of ΔE00, and return figures."""
    truth = pictures[SPECTRA]
    level = float(np.quantile(truth[..., 1], WHITE_LEVEL))
    white = level * observer.light("D65").white
    reference = lab(truth, white)
    maps = {
        name: delta_e_2000(reference, lab(picture, white))
        for name, picture in pictures.items()
    }
    rows = []
    for name in list(pictures)[1:]:
        errors = maps[name]
        blocks = delta_e_2000(
            lab(blocks_of(spectral, 8), white),
            lab(blocks_of(pictures[name], 8), white),
        )
        rows.append(
            {
                "method": name,
                "mean": errors.mean(),
                "p95": np.quantile(errors, 0.95),
                "spectral_variant": blocks.mean(),
                "seconds": seconds[name],
            }
        )
    noise = delta_e_2000(
        lab(blocks_of(spectral, 8), white), lab(blocks_of(truth, 8), white)
    )
    folder.mkdir(exist_ok=True)
    _draw({**pictures, VARIANT: spectral}, maps, level, folder / "room.png")
    return {"room": rows, "room_spectra": {"noise": noise.mean()}}


def _draw(
    pictures: dict[str, Array], maps: dict[str, Array], level: float, path: Path
) -> None:
    names = {
        SPECTRA: "spectra",
        RGB: "plain RGB",
        "1": "one pass",
        "2": "two passes",
    }
    to_srgb = observer.sensor().xyz_to_rgb / level
    figure = new_figure(11.0, 5.7)
    figure.set_dpi(150)
    grid = figure.subplots(2, len(names))
    largest = float(np.quantile(maps[RGB], 0.95))
    for column, (name, title) in enumerate(names.items()):
        top = grid[0, column]
        show_srgb(top, pictures[name] @ to_srgb.T)
        top.set_title(title, fontsize=11, pad=6)
        below = grid[1, column]
        if name == SPECTRA:
            show_srgb(below, pictures[VARIANT] @ to_srgb.T)
            below.set_xlabel(VARIANT, fontsize=9, color="0.3")
            continue
        shown = show_image(below, maps[name], cmap=colour_map(), vmin=0, vmax=largest)
        below.set_xlabel(f"mean ΔE00 {maps[name].mean():.2f}", fontsize=9, color="0.3")
    bar = figure.colorbar(shown, ax=list(grid[:, -1]), format="%.0f", shrink=0.5)
    bar.set_label("ΔE00", fontsize=9)
    write_png(figure, path, force=True)
