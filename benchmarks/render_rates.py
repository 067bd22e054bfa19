"""Rates of textures in Mitsuba: evaluation, and rendering of a scene, for docs/render.md.

Every variant is measured in a child process, as an LLVM too old for Mitsuba ends it. All textures take turns in every
round; a ratio is that of the CPU times of one round.
"""

from __future__ import annotations

import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import CUBES, record
from uplift.common.processes import call_in_child

VARIANTS = ("llvm_ad_spectral", "cuda_ad_spectral")
REFERENCE = "Mitsuba's bitmap"
SIZE = 512
"""Rows and columns of the texture and of the image."""
SPP = 8
SAMPLES = 1 << 22
ROUNDS = 5
LIMIT = 3600
"""Seconds after which a variant counts as hung."""
DEPTHS = (2, 5)
PLAIN, ATLAS = (str(CUBES / f"moments-16{suffix}.uplift") for suffix in ("", "-macbeth"))


@dataclass(frozen=True)
class Work:
    """What is measured: a name, the number of samples, and a function of a texture and a seed."""

    name: str
    samples: int
    run: Callable[[Any, int], Callable[[], None]]


def main() -> None:
    """Measure all variants and write."""
    rows: list[dict[str, Any]] = []
    for variant in VARIANTS:
        try:
            rows += call_in_child(measure, variant, seconds=LIMIT)
        except Exception as error:  # code of other packages may raise anything
            print(f"{variant}: {error}", file=sys.stderr)
            rows.append({"variant": variant, "work": None})
    import mitsuba

    figures = {"size": SIZE, "samples": SAMPLES, "rounds": ROUNDS, "reference": REFERENCE}
    record("render-rates", mitsuba=mitsuba.__version__, **figures, rows=rows)


def measure(variant: str) -> list[dict[str, Any]]:
    """Measure a variant in this process."""
    import mitsuba

    from uplift.io.mitsuba import register

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    mitsuba.set_variant(variant)
    register()
    with tempfile.TemporaryDirectory() as folder:
        textures = {name: mitsuba.load_dict(texture) for name, texture in _textures(Path(folder)).items()}
    return [row for work in _works() for row in _rows(variant, work, textures)]


def _rows(variant: str, work: Work, textures: dict[str, Any]) -> Iterator[dict[str, Any]]:
    seconds: dict[str, list[float]] = {name: [] for name in textures}
    for seed in range(ROUNDS + 1):
        for name, texture in textures.items():
            run = work.run(texture, seed)
            begin = time.process_time()
            run()
            if seed:  # the first compiles
                seconds[name].append(time.process_time() - begin)
    reference = np.array(seconds[REFERENCE])
    for name, each in seconds.items():
        ratios = reference / each
        yield {
            "variant": variant,
            "work": work.name,
            "texture": name,
            "ns": 1e9 * float(np.median(each)) / work.samples,
            "rate": float(np.median(ratios)),
            "lowest": float(ratios.min()),
            "highest": float(ratios.max()),
        }


def _textures(folder: Path) -> dict[str, dict[str, Any]]:
    import mitsuba

    from uplift.io import texture
    from uplift.io.texture.uplifter import PixelEncoding

    image = _image(SIZE)
    mitsuba.Bitmap(image).write(str(folder / "image.exr"))

    def convert(encoding: PixelEncoding) -> dict[str, Any]:
        target = folder / f"{encoding.name}.exr"
        texture.convert(texture.prepare(uplift.load(PLAIN), encoding), folder / "image.exr", target)
        return {"type": "uplift", "filename": str(target)}

    spectra, multipliers = convert(texture.Spectrum()), convert(texture.Multipliers())
    entries = {"type": "uplift", "cube": ATLAS, "filename": str(folder / "image.exr")}
    return {
        REFERENCE: {"type": "bitmap", "bitmap": mitsuba.Bitmap(image)},
        "9 coefficients": multipliers,
        "9 coefficients, stochastic": {**multipliers, "filter_type": "stochastic"},
        "17 coefficients": entries,
        "17 coefficients, stochastic": {**entries, "filter_type": "stochastic"},
        "81 wavelengths": spectra,
    }


def _image(size: int) -> Any:
    """Return tiles of random colours with noise, float32 (size, size, 3)."""
    rng = np.random.default_rng(8)
    tiles = np.kron(0.05 + 0.9 * rng.random((16, 16, 3)), np.ones((size // 16, size // 16, 1)))
    return (tiles * (1 - 0.1 * rng.random((size, size, 1)))).astype(np.float32)


def _works() -> Iterator[Work]:
    yield Work("evaluation at random places", SAMPLES, _evaluation)
    for depth in DEPTHS:
        yield Work(f"rendering, path depth {depth}", SIZE * SIZE * SPP, _rendering(depth))


def _evaluation(texture: Any, seed: int) -> Callable[[], None]:
    import drjit as dr
    import mitsuba as mi

    generator = mi.PCG32(SAMPLES, initstate=seed)
    si = dr.zeros(mi.SurfaceInteraction3f, SAMPLES)
    si.uv = mi.Point2f(generator.next_float32(), generator.next_float32())
    si.wavelengths = mi.Spectrum([380 + 400 * generator.next_float32() for _ in range(4)])
    dr.eval(si.uv, si.wavelengths)
    dr.sync_thread()

    def run() -> None:
        dr.eval(dr.sum(dr.sum(texture.eval(si))))
        dr.sync_thread()

    return run


def _rendering(depth: int) -> Callable[[Any, int], Callable[[], None]]:
    scenes: dict[int, Any] = {}

    def start(texture: Any, seed: int) -> Callable[[], None]:
        import drjit as dr
        import mitsuba as mi

        if id(texture) not in scenes:
            scenes[id(texture)] = mi.load_dict(_scene(texture, SIZE, depth))

        def run() -> None:
            dr.eval(mi.render(scenes[id(texture)], spp=SPP, seed=seed))
            dr.sync_thread()

        return run

    return start


def _scene(texture: Any, size: int, depth: int) -> dict[str, Any]:
    """Describe a plane and a sphere of the texture under uniform light."""
    import mitsuba as mi

    paint = {"type": "diffuse", "reflectance": texture}
    view = mi.ScalarTransform4f().look_at([0, -1.2, 1.6], [0, 0, 0], [0, 0, 1])
    film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}}
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": depth, "hide_emitters": True},
        "light": {"type": "constant"},
        "camera": {"type": "perspective", "fov": 45, "to_world": view, "film": film},
        "plane": {"type": "rectangle", "to_world": mi.ScalarTransform4f().scale(2), "bsdf": paint},
        "ball": {"type": "sphere", "radius": 0.4, "center": [0, 0, 0.4], "bsdf": paint},
    }


if __name__ == "__main__":
    main()
