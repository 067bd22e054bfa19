"""The ColorChecker rendered with several methods: ``make demo-render`` writes docs/data/render.json and a picture."""

from __future__ import annotations

import sys
import tempfile
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks.record import ROOT, write
from benchmarks.render import scene
from benchmarks.render.chart import MACBETH, Chart, Layout, chart
from benchmarks.render.picture import draw
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.observer import light
from uplift.common.arrays import Array

LIGHTS = ("D65", "A", "FL11")
REFERENCE, MITSUBA, PLAIN, ATLAS, ATLAS_17 = (
    "measured spectra",
    "Mitsuba 3",
    "cube, no atlas",
    "cube, ColorChecker",
    "cube, ColorChecker, 17 coefficients",
)
OTHER_SEED = "measured spectra, another seed"
DRAWN = (REFERENCE, MITSUBA, ATLAS)
DIM = 32
LAYOUT, SPP = Layout(patch=32, gap=4), 256
Reflectances = list[dict[str, Any]]


@dataclass(frozen=True, eq=False)
class Renders:
    """XYZ images by light and method, and ΔE00 (24,) of their patches from the reference."""

    images: dict[tuple[str, str], Array]
    delta_e: dict[tuple[str, str], Array]


def main() -> None:
    """Render, draw and store."""
    import mitsuba

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    scene.start()
    painted = chart()
    with tempfile.TemporaryDirectory() as folder:
        renders = render(methods(painted, Path(folder), DIM), LAYOUT, SPP)
    captions = {
        key: "" if key[1] == REFERENCE else f"mean ΔE00 {errors.mean():.2f}, worst {errors.max():.1f}"
        for key, errors in renders.delta_e.items()
    }
    picture = ROOT / "docs" / "render" / "charts.png"
    draw(renders.images, captions, LIGHTS, DRAWN, LAYOUT, picture)
    write(
        "render",
        "make demo-render",
        precision="full",
        mitsuba=mitsuba.__version__,
        variant=scene.VARIANT,
        dim=DIM,
        samples=LAYOUT.patch**2 * SPP,
        **figures(painted, renders),
    )


def methods(chart: Chart, folder: Path, dim: int) -> dict[str, Reflectances]:
    """Return the reflectances of the patches by method; cubes are built in ``folder``."""

    def cube(name: str, *atlas: Path, **options: Any) -> Reflectances:
        path = folder / f"{name}.uplift"
        uplift.build(*atlas, dim=dim, **options).save(path)
        return scene.from_cube(chart, str(path))

    return {
        REFERENCE: scene.measured(chart),
        MITSUBA: scene.built_in(chart),
        PLAIN: cube("plain"),
        ATLAS: cube("atlas", MACBETH),
        ATLAS_17: cube("atlas-17", MACBETH, coefficients=17),
    }


def render(methods: dict[str, Reflectances], layout: Layout, spp: int) -> Renders:
    """Render all methods under all lights with one seed, and the reference with another seed too."""
    images, delta_e = {}, {}
    for name in LIGHTS:
        begin, white = time.perf_counter(), light(name).white
        for method, reflectances in methods.items():
            images[name, method] = scene.render(reflectances, name, layout, spp, seed=0)
        images[name, OTHER_SEED] = scene.render(methods[REFERENCE], name, layout, spp, seed=1)
        labs = {method: lab(layout.means(images[name, method]), white) for method in (*methods, OTHER_SEED)}
        delta_e |= {(name, method): delta_e_2000(labs[REFERENCE], values) for method, values in labs.items()}
        print(f"{name}: {time.perf_counter() - begin:.0f} s", file=sys.stderr)
    return Renders(images, delta_e)


def figures(chart: Chart, renders: Renders) -> dict[str, Any]:
    """Return the errors by method and by patch; means are over all patches, and over those inside sRGB."""
    inside = ~chart.outside

    def means(name: str, method: str) -> list[float]:
        errors = renders.delta_e[name, method]
        return [float(errors.mean()), float(errors[inside].mean())]

    ratios = [np.divide(means(name, MITSUBA), means(name, ATLAS)) for name in LIGHTS[1:]]
    return {
        "ratios": [
            {"light": name, "all": float(ratio[0]), "in_gamut": float(ratio[1])}
            for name, ratio in zip(LIGHTS[1:], ratios, strict=True)
        ],
        "means": [
            {"method": method, **{name: means(name, method) for name in LIGHTS}}
            for method in (MITSUBA, PLAIN, ATLAS, ATLAS_17, OTHER_SEED)
        ],
        "patches": [
            {
                "patch": patch,
                **{
                    name: {
                        "mitsuba": float(renders.delta_e[name, MITSUBA][row]),
                        "cube": float(renders.delta_e[name, ATLAS][row]),
                    }
                    for name in LIGHTS
                },
            }
            for row, patch in enumerate(chart.names)
        ],
    }


if __name__ == "__main__":
    main()
