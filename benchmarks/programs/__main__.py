"""Lookups by language: ``make bench`` writes docs/data/programs.json and docs/performance/programs.png."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
import numpy as np

import uplift
from benchmarks.browser import chromium
from benchmarks.programs import header, live, shaders
from benchmarks.programs.header import Floats, Rates
from benchmarks.record import ROOT, write
from uplift.io.export import write_program
from uplift.lookup import Cube, bulk
from uplift.viz.figure import ACCENT, GREY, new_figure, style_axes, write_png

COLOURS, PIXELS, RAY = 400_000, 262_144, np.linspace(400, 700, 16)
FOUR = [450.0, 500.0, 550.0, 600.0]
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math")
OTHER_FLAGS = (("-O2",), ("-O3",), ("-O3", "-march=x86-64-v3"), ("-O3", "-march=native", "-ffast-math"))
MODES = ("spectra", "moments")
BOXES = (("sRGB", 9), ("sRGB", 17), ("ACEScg", 9), ("ACEScg", 17))
"""Spaces and numbers of coefficients of the cubes on which accuracy near a box is measured."""


@dataclass(frozen=True)
class ShaderRate:
    """Million colours per CPU second at four wavelengths; the largest difference of reflectance from Python."""

    language: str
    mode: str
    lookup: float
    worst: float


@dataclass(frozen=True)
class PythonRate:
    """Million colours per CPU second at sixteen wavelengths."""

    what: str
    lookup: float


@click.command()
@click.option("--runs", default=5, show_default=True, help="Number of runs; the fastest counts.")
def main(runs: int) -> None:
    """Time and check the C header in both modes and models, shaders, and lookups in Python on the same colours."""
    compiler = shutil.which("cc")
    if compiler is None or chromium() is None:
        raise click.ClickException("this benchmark needs a C compiler, cc, and Chromium")
    cubes = {model: _build(dim=32, model=model) for model in ("moments", "sigmoid")}
    cube = cubes["moments"]
    rgb = np.random.default_rng(1).random((COLOURS, 3)).astype(np.float32)
    rows = [header.measure(each, mode, FLAGS, rgb, runs) for mode in MODES for each in cubes.values()]
    flags = [header.measure(cube, mode, each, rgb, runs) for each in OTHER_FLAGS for mode in MODES]
    boxes = [
        header.accuracy(_build(dim=16, space=space, coefficients=count), mode, FLAGS)
        for space, count in BOXES
        for mode in MODES
    ]
    python = [_python(cube, mode, rgb, runs) for mode in ("bulk", *MODES)]
    shader = [_shader(cube, mode, rgb, runs) for mode in MODES]
    frames, product = live.measure(cube, runs)
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    write(
        "programs",
        "make bench",
        runs=runs,
        colours=COLOURS,
        pixels=PIXELS,
        checked=header.CHECKED,
        compiler=version.splitlines()[0],
        flags=" ".join(FLAGS),
        browser=product,
        rows=rows,
        by_flags=flags,
        boxes=boxes,
        python=python,
        shaders=shader,
        frames=frames,
    )
    _picture(rows, python, shader, ROOT / "docs" / "performance" / "programs.png")


def _build(**options: Any) -> Cube:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(ROOT / "atlases" / "macbeth.txt", **options)


def _python(cube: Cube, mode: str, rgb: Floats, runs: int) -> PythonRate:
    """Time lookups in Python: CPU seconds of all threads."""
    colours = rgb[:100_000].astype(float)
    if mode == "bulk":
        sample: Any = bulk.spectra(cube, RAY, threads=1)
    else:

        def sample(values: Any) -> Any:
            return cube.reflectance(values, RAY, mode=mode, dtype=np.float32)

    best = np.inf
    for _ in range(runs):
        begin = time.process_time()
        sample(colours)
        best = min(best, time.process_time() - begin)
    name = "`uplift.bulk`, spectra" if mode == "bulk" else f"numpy, {mode}"
    return PythonRate(name, len(colours) / best / 1e6)


def _shader(cube: Cube, mode: str, rgb: Floats, runs: int) -> ShaderRate:
    """Time a shader in the browser: CPU seconds of all processes."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.glsl"
        write_program(cube.data, path, style="glsl", mode=mode)
        found = shaders.glsl(path, rgb[:PIXELS], FOUR, runs)
    if found is None:
        raise click.ClickException("the browser has no WebGL 2")
    checked = found.reflectances[: header.CHECKED]
    expected = cube.reflectance(rgb[: header.CHECKED].astype(float), FOUR, mode=mode)
    worst = float(np.abs(checked - expected).max())
    return ShaderRate("GLSL", mode, PIXELS / found.seconds / 1e6, worst)


def _picture(rows: list[Rates], python: list[PythonRate], shader: list[ShaderRate], path: Path) -> None:
    """Draw bars of reflectances per second."""
    models = {"moments": "9 coefficients", "sigmoid": "sigmoids"}
    bars = [(f"C, {row.mode}, {models[row.model]}", row.many, RAY.size, ACCENT) for row in rows]
    bars += [(row.what.replace("`", ""), row.lookup, RAY.size, GREY) for row in python]
    bars += [(f"{row.language}, {row.mode}, software rendering", row.lookup, len(FOUR), ACCENT) for row in shader]
    names, rates, sizes, colours = zip(*bars[::-1], strict=True)
    figure = new_figure(7.4, 0.3 * len(bars) + 1)
    axes = figure.subplots()
    axes.barh(names, np.multiply(rates, sizes), color=colours)
    axes.set_xscale("log")
    axes.set_xlabel("million reflectances per CPU second\n(16 wavelengths per colour, 4 in shaders)")
    style_axes(axes)
    path.parent.mkdir(exist_ok=True)
    write_png(figure, path, force=True)


if __name__ == "__main__":
    main()
