"""The ColorChecker rendered with several methods, and rates of textures in Mitsuba, for
docs/scene.md and its picture.

Rates of every variant are measured in a child process, as an LLVM too old for Mitsuba
ends it. All textures take turns in every round; a ratio is that of the CPU times of one
round.
"""

import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, MACBETH, Row, checker, record
from benchmarks.checker import Chart, Layout, Reflectances
from benchmarks.checker import render as render_chart
from uplift.colorimetry import delta_e_2000, lab
from uplift.colorimetry.observer import light, sensor
from uplift.common.arrays import Array
from uplift.extras.images.processes import call_in_child

LIGHTS = ("D65", "A", "FL11")
REFERENCE = "measured spectra"
MITSUBA = "Mitsuba 3"
PLAIN = "cube, no atlas"
ATLAS = "cube, ColorChecker"
ATLAS_17 = "cube, ColorChecker, 17 coefficients"
OTHER_SEED = "measured spectra, another seed"
DIM = 32
LAYOUT = Layout(patch=32, gap=4)
SPP = 256
VARIANTS = ("llvm_ad_spectral", "cuda_ad_spectral")
BITMAP = "Mitsuba's bitmap"
SIZE = 512
"""Rows and columns of the texture and of the image."""
RATE_SPP = 8
ROUNDS = 5
LIMIT = 3600
"""Seconds after which a variant counts as hung."""
DEPTHS = (2, 5)
PLAIN_CUBE = str(CUBES / "moments-16.uplift")
ATLAS_CUBE = str(CUBES / "moments-16-macbeth.uplift")


@dataclass(frozen=True, eq=False)
class Renders:
    """XYZ images by light and method, and ΔE00 (24,) of their patches."""

    images: dict[tuple[str, str], Array]
    delta_e: dict[tuple[str, str], Array]


def main() -> None:
    """Render, draw and store."""
    version = checker.start_mitsuba()
    painted = checker.chart()
    with tempfile.TemporaryDirectory() as folder:
        renders = render(methods(painted, Path(folder), DIM), LAYOUT, SPP)
    to_screen = {name: sensor(illuminant=name).xyz_to_rgb for name in LIGHTS}
    picture = DOCS / "render" / "charts.png"
    shown = (REFERENCE, MITSUBA, ATLAS)
    checker.draw(
        renders.images,
        renders.delta_e,
        to_screen,
        shown,
        LAYOUT.middles(),
        picture,
        (10.5, 7.6),
    )
    record(
        "render",
        mitsuba=version,
        variant=checker.VARIANT,
        dim=DIM,
        samples=LAYOUT.patch**2 * SPP,
        **figures(painted, renders),
    )
    rates()


def methods(painted: Chart, folder: Path, dim: int) -> dict[str, Reflectances]:
    """Return the reflectances of the patches by method; cubes are in ``folder``."""
    colours = painted.painted.tolist()

    def cube(name: str, *atlas: Path, **options: Any) -> Reflectances:
        path = folder / f"{name}.uplift"
        uplift.build(*atlas, dim=dim, **options).save(path)
        return [{"type": "uplift", "cube": str(path), "rgb": rgb} for rgb in colours]

    return {
        REFERENCE: checker.measured_spectra(painted),
        MITSUBA: [{"type": "rgb", "value": rgb} for rgb in colours],
        PLAIN: cube("plain"),
        ATLAS: cube("atlas", MACBETH),
        ATLAS_17: cube("atlas-17", MACBETH, coefficients=17),
    }


def render(methods: dict[str, Reflectances], layout: Layout, spp: int) -> Renders:
    """Render all methods under all lights with one seed, the reference with another
    too.
    """
    seeded = {**methods, OTHER_SEED: methods[REFERENCE]}
    images = {}
    delta_e = {}
    for name in LIGHTS:
        emitter = checker.constant_light(name)
        white = light(name).white
        labs = {}
        for method, reflectances in seeded.items():
            seed = int(method == OTHER_SEED)
            image = render_chart(emitter, reflectances, layout, spp, seed)
            images[name, method] = image
            labs[method] = lab(layout.means(image), white)
            delta_e[name, method] = delta_e_2000(labs[REFERENCE], labs[method])
    return Renders(images, delta_e)


def figures(painted: Chart, renders: Renders) -> Row:
    """Return the errors by method and by patch; means are over all patches, and over
    those inside sRGB.
    """
    errors = renders.delta_e

    def means(name: str, method: str) -> Array:
        delta_e = errors[name, method]
        return np.array([delta_e.mean(), delta_e[~painted.outside].mean()])

    ratios = []
    patches = [{"patch": patch} for patch in painted.names]
    for name in LIGHTS:
        every, in_gamut = means(name, MITSUBA) / means(name, ATLAS)
        ratios.append({"light": name, "all": every, "in_gamut": in_gamut})
        pairs = zip(errors[name, MITSUBA], errors[name, ATLAS], strict=True)
        for patch, (mitsuba, cube) in zip(patches, pairs, strict=True):
            patch[name] = {"mitsuba": mitsuba, "cube": cube}
    rows = []
    for method in (MITSUBA, PLAIN, ATLAS, ATLAS_17, OTHER_SEED):
        by_light = {name: means(name, method) for name in LIGHTS}
        rows.append({"method": method, **by_light})
    return {"ratios": ratios[1:], "means": rows, "patches": patches}


def rates() -> None:
    """Measure the rates of all variants and store."""
    rows = []
    for variant in VARIANTS:
        try:
            rows += call_in_child(measure_rates, variant, seconds=LIMIT)
        except Exception as error:  # code of other packages may raise anything
            print(f"{variant}: {error}", file=sys.stderr)
            rows.append({"variant": variant, "work": None})
    import mitsuba

    record(
        "render",
        "render-rates",
        mitsuba=mitsuba.__version__,
        size=SIZE,
        rounds=ROUNDS,
        reference=BITMAP,
        rows=rows,
    )


def measure_rates(variant: str) -> list[Row]:
    """Measure a variant in this process."""
    import mitsuba

    checker.start_mitsuba(variant)
    with tempfile.TemporaryDirectory() as folder:
        textures = {
            name: mitsuba.load_dict(texture)
            for name, texture in _textures(Path(folder)).items()
        }
    rows = []
    for depth in DEPTHS:
        rows += _rows(variant, depth, textures)
    return rows


def _rows(variant: str, depth: int, textures: Row) -> Iterator[Row]:
    runs = {name: _rendering(texture, depth) for name, texture in textures.items()}
    seconds = defaultdict(list)
    for seed in range(ROUNDS + 1):
        for name, run in runs.items():
            begin = time.process_time()
            run(seed)
            if seed:  # the first compiles
                seconds[name].append(time.process_time() - begin)
    reference = np.array(seconds[BITMAP])
    for name, times in seconds.items():
        ratios = reference / times
        yield {
            "variant": variant,
            "work": f"rendering, path depth {depth}",
            "texture": name,
            "ns": 1e9 * np.median(times) / (SIZE * SIZE * RATE_SPP),
            "rate": np.median(ratios),
            "lowest": ratios.min(),
            "highest": ratios.max(),
        }


def _textures(folder: Path) -> dict[str, Row]:
    import mitsuba

    from uplift.extras import texture
    from uplift.extras.texture.uplifter import PixelEncoding

    bitmap = mitsuba.Bitmap(_image(SIZE))
    source = folder / "image.exr"
    bitmap.write(str(source))

    def convert(encoding: PixelEncoding) -> Row:
        target = folder / f"{encoding.name}.exr"
        uplifter = texture.prepare(uplift.load(PLAIN_CUBE), encoding)
        texture.convert(uplifter, source, target)
        return {"type": "uplift", "filename": str(target)}

    multipliers = convert(texture.Multipliers())
    entries = {"type": "uplift", "cube": ATLAS_CUBE, "filename": str(source)}
    return {
        BITMAP: {"type": "bitmap", "bitmap": bitmap},
        "9 coefficients": multipliers,
        "9 coefficients, stochastic": {**multipliers, "filter_type": "stochastic"},
        "17 coefficients": entries,
        "17 coefficients, stochastic": {**entries, "filter_type": "stochastic"},
        "81 wavelengths": convert(texture.Spectrum()),
    }


def _image(size: int) -> Any:
    """Return tiles of random colours with noise, float32 (size, size, 3)."""
    rng = np.random.default_rng(8)
    colours = 0.05 + 0.9 * rng.random((16, 16, 3))
    tiles = np.kron(colours, np.ones((size // 16, size // 16, 1)))
    return (tiles * (1 - 0.1 * rng.random((size, size, 1)))).astype(np.float32)


def _rendering(texture: Any, depth: int) -> Callable[[int], None]:
    """Return a function of a seed that renders the scene."""
    import drjit as dr
    import mitsuba as mi

    scene = mi.load_dict(_scene(texture, depth))

    def run(seed: int) -> None:
        dr.eval(mi.render(scene, spp=RATE_SPP, seed=seed))
        dr.sync_thread()

    return run


def _scene(texture: Any, depth: int) -> Row:
    """Describe a plane and a sphere of the texture under uniform light."""
    import mitsuba as mi

    paint = {"type": "diffuse", "reflectance": texture}
    view = mi.ScalarTransform4f().look_at([0, -1.2, 1.6], [0, 0, 0], [0, 0, 1])
    film = {
        "type": "hdrfilm",
        "width": SIZE,
        "height": SIZE,
        "rfilter": {"type": "box"},
    }
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "hide_emitters": True},
        "light": {"type": "constant"},
        "camera": {"type": "perspective", "fov": 45, "to_world": view, "film": film},
        "plane": {
            "type": "rectangle",
            "to_world": mi.ScalarTransform4f().scale(2),
            "bsdf": paint,
        },
        "ball": {"type": "sphere", "radius": 0.4, "center": [0, 0, 0.4], "bsdf": paint},
    }
