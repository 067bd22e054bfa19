"""The ColorChecker under uplifted environments: ``make environment`` stores environment.json and a picture."""

from __future__ import annotations

import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

import uplift
from benchmarks.environment.picture import draw
from benchmarks.environment.skies import SKIES, Sky
from benchmarks.record import ROOT, write
from benchmarks.render import scene
from benchmarks.render.chart import Layout, chart
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.arrays import Array
from uplift.io.texture.pixel_encoding import SPECTRAL_LAYOUT, spectral_channels

VARIANT = "llvm_ad_spectral"
TRUE, MITSUBA, KNOWN, UNKNOWN = (
    "measured spectra",
    "Mitsuba 3",
    "table, lamps known",
    "table, lamps left out",
)
OTHER_SEED = "measured spectra, another seed"
LAYOUT, SPP = Layout(patch=32, gap=4), 512
PICTURE = ROOT / "docs" / "emission" / "environments.png"


@dataclass(frozen=True, eq=False)
class Renders:
    """XYZ images by sky and method, XYZ (3,) of a perfect reflector by sky, and ΔE00 (24,) of the patches."""

    images: dict[tuple[str, str], Array]
    whites: dict[str, Array]
    delta_e: dict[tuple[str, str], Array]


def main() -> None:
    """Render, draw and store."""
    import mitsuba

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    scene.start(VARIANT)
    with tempfile.TemporaryDirectory() as folder:
        renders = render(SKIES, Path(folder), LAYOUT, SPP)
    PICTURE.parent.mkdir(exist_ok=True)
    draw(renders.images, renders.whites, renders.delta_e, (TRUE, KNOWN, UNKNOWN, MITSUBA), LAYOUT, PICTURE)
    write(
        "environment",
        "make environment",
        precision="full",
        mitsuba=mitsuba.__version__,
        variant=VARIANT,
        samples=LAYOUT.patch**2 * SPP,
        skies=[{"sky": sky.name, "lights": ", ".join(sky.lamp_names)} for sky in SKIES],
        rows=list(rows(renders)),
    )


def render(skies: tuple[Sky, ...], folder: Path, layout: Layout, spp: int) -> Renders:
    """Render the chart under all skies with all methods and one seed, and the truth with another seed too."""
    reflectances, perfect = scene.measured(chart()), [{"type": "uniform", "value": 1.0}] * 24
    images, whites, delta_e = {}, {}, {}
    for sky in skies:
        begin, emitters = time.perf_counter(), methods(sky, folder)
        whites[sky.name] = layout.means(scene.render_under(emitters[TRUE], perfect, layout, spp, seed=2)).mean(axis=0)
        for method, emitter in emitters.items():
            images[sky.name, method] = scene.render_under(emitter, reflectances, layout, spp, seed=0)
        images[sky.name, OTHER_SEED] = scene.render_under(emitters[TRUE], reflectances, layout, spp, seed=1)
        found = {
            method: lab(layout.means(images[sky.name, method]), whites[sky.name]) for method in (*emitters, OTHER_SEED)
        }
        delta_e |= {(sky.name, method): delta_e_2000(found[TRUE], values) for method, values in found.items()}
        print(f"{sky.name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return Renders(images, whites, delta_e)


def methods(sky: Sky, folder: Path) -> dict[str, dict[str, Any]]:
    """Return the emitters by method: the spectra of the sky, or its RGB uplifted."""
    table = uplift.load_emission()
    power, stem = sky.power(), sky.name.replace(" ", "-")
    names = spectral_channels("S0", table.wavelengths)
    spectral = _write(folder / f"{stem}-spectral.exr", names, power, **SPECTRAL_LAYOUT)
    rgb = _write(folder / f"{stem}.exr", ("R", "G", "B"), table.rgb(power))
    partial = folder / f"{stem}.uplift"
    uplift.build_emission(without=sky.lamp_names).save(partial)
    return {
        TRUE: {"type": "uplift_envmap", "filename": str(spectral)},
        KNOWN: {"type": "uplift_envmap", "filename": str(rgb)},
        UNKNOWN: {"type": "uplift_envmap", "filename": str(rgb), "cube": str(partial)},
        MITSUBA: {"type": "envmap", "filename": str(rgb)},
    }


def rows(renders: Renders) -> Iterator[dict[str, Any]]:
    """Yield the errors by sky and method."""
    for sky in renders.whites:
        for method in (KNOWN, UNKNOWN, MITSUBA, OTHER_SEED):
            errors = renders.delta_e[sky, method]
            yield {
                "sky": sky,
                "method": method,
                "mean": float(errors.mean()),
                "median": float(np.median(errors)),
                "p95": float(np.percentile(errors, 95)),
                "worst": float(errors.max()),
            }


def _write(path: Path, names: tuple[str, ...], planes: Array, **header: Any) -> Path:
    channels = {name: np.ascontiguousarray(planes[..., place], dtype=np.float32) for place, name in enumerate(names)}
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, channels).write(str(path))
    return path


if __name__ == "__main__":
    main()
