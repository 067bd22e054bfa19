"""The ColorChecker rendered with several methods, for docs/scene.md and its picture."""

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import DOCS, MACBETH, checker, record
from benchmarks.checker import Chart, Layout, Reflectances
from benchmarks.checker import render as render_chart
from uplift.colorimetry import delta_e_2000, lab
from uplift.colorimetry.observer import light, sensor
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
DIM = 32
LAYOUT, SPP = Layout(patch=32, gap=4), 256


@dataclass(frozen=True, eq=False)
class Renders:
    """XYZ images by light and method, and ΔE00 (24,) of their patches from the reference."""

    images: dict[tuple[str, str], Array]
    delta_e: dict[tuple[str, str], Array]


def main() -> None:
    """Render, draw and store."""
    version, painted = checker.start_mitsuba(), checker.chart()
    with tempfile.TemporaryDirectory() as folder:
        renders = render(methods(painted, Path(folder), DIM), LAYOUT, SPP)
    captions = {key: "" if key[1] == REFERENCE else checker.caption(errors) for key, errors in renders.delta_e.items()}
    to_screen = {name: sensor(illuminant=name).xyz_to_rgb for name in LIGHTS}
    picture = DOCS / "render" / "charts.png"
    checker.draw(renders.images, captions, to_screen, (REFERENCE, MITSUBA, ATLAS), LAYOUT, picture, (10.5, 7.6))
    record(
        "render",
        mitsuba=version,
        variant=checker.VARIANT,
        dim=DIM,
        samples=LAYOUT.patch**2 * SPP,
        **figures(painted, renders),
    )


def methods(painted: Chart, folder: Path, dim: int) -> dict[str, Reflectances]:
    """Return the reflectances of the patches by method; cubes are built in ``folder``."""
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
    """Render all methods under all lights with one seed, and the reference with another seed too."""
    images, delta_e = {}, {}
    for name in LIGHTS:
        emitter, white = checker.constant_light(name), light(name).white
        for method, reflectances in methods.items():
            images[name, method] = render_chart(emitter, reflectances, layout, spp, seed=0)
        images[name, OTHER_SEED] = render_chart(emitter, methods[REFERENCE], layout, spp, seed=1)
        labs = {method: lab(layout.means(images[name, method]), white) for method in (*methods, OTHER_SEED)}
        delta_e |= {(name, method): delta_e_2000(labs[REFERENCE], values) for method, values in labs.items()}
    return Renders(images, delta_e)


def figures(painted: Chart, renders: Renders) -> dict[str, Any]:
    """Return the errors by method and by patch; means are over all patches, and over those inside sRGB."""
    errors = renders.delta_e

    def means(name: str, method: str) -> list[float]:
        return [float(errors[name, method].mean()), float(errors[name, method][~painted.outside].mean())]

    def of_patch(row: int) -> dict[str, dict[str, float]]:
        return {name: {"mitsuba": errors[name, MITSUBA][row], "cube": errors[name, ATLAS][row]} for name in LIGHTS}

    ratios = {name: np.divide(means(name, MITSUBA), means(name, ATLAS)).tolist() for name in LIGHTS[1:]}
    return {
        "ratios": [{"light": name, "all": both[0], "in_gamut": both[1]} for name, both in ratios.items()],
        "means": [
            {"method": method, **{name: means(name, method) for name in LIGHTS}}
            for method in (MITSUBA, PLAIN, ATLAS, ATLAS_17, OTHER_SEED)
        ],
        "patches": [{"patch": patch, **of_patch(row)} for row, patch in enumerate(painted.names)],
    }
