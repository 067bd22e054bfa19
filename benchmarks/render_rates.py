"""Rates of textures in Mitsuba, rendering a scene, for docs/scene.md.

Every variant is measured in a child process, as an LLVM too old for Mitsuba ends it. All textures take turns in every
round; a ratio is that of the CPU times of one round.
"""

import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
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
ROUNDS = 5
LIMIT = 3600
"""Seconds after which a variant counts as hung."""
DEPTHS = (2, 5)
PLAIN, ATLAS = (str(CUBES / f"moments-16{suffix}.uplift") for suffix in ("", "-macbeth"))


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

    figures = {"size": SIZE, "rounds": ROUNDS, "reference": REFERENCE}
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
    return [row for depth in DEPTHS for row in _rows(variant, depth, textures)]


def _rows(variant: str, depth: int, textures: dict[str, Any]) -> Iterator[dict[str, Any]]:
    runs = {name: _rendering(texture, depth) for name, texture in textures.items()}
    seconds: dict[str, list[float]] = {name: [] for name in textures}
    for seed in range(ROUNDS + 1):
        for name, run in runs.items():
            begin = time.process_time()
            run(seed)
            if seed:  # the first compiles
                seconds[name].append(time.process_time() - begin)
    reference = np.array(seconds[REFERENCE])
    for name, each in seconds.items():
        ratios = reference / each
        yield {
            "variant": variant,
            "work": f"rendering, path depth {depth}",
            "texture": name,
            "ns": 1e9 * float(np.median(each)) / (SIZE * SIZE * SPP),
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


def _rendering(texture: Any, depth: int) -> Callable[[int], None]:
    """Return a function of a seed that renders the scene."""
    import drjit as dr
    import mitsuba as mi

    scene = mi.load_dict(_scene(texture, SIZE, depth))

    def run(seed: int) -> None:
        dr.eval(mi.render(scene, spp=SPP, seed=seed))
        dr.sync_thread()

    return run


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
