"""Lookups by language: ``make bench`` writes docs/data/programs.json and docs/performance/programs.png."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any

import click
import numpy as np

import uplift
from benchmarks.record import ROOT, write
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.io.export import write_program
from uplift.lookup import Cube, bulk
from uplift.viz.figure import ACCENT, GREY, new_figure, style_axes, write_png

COLOURS, CHECKED, RAY = 400_000, 5000, np.linspace(400, 700, 16)
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math")
OTHER_FLAGS = (("-O2",), ("-O3",), ("-O3", "-march=x86-64-v3"), ("-O3", "-march=native", "-ffast-math"))
WORST = {"spectra": 1e-3, "moments": 1e-3}
"""Largest permitted difference of reflectance from Python."""

Row = dict[str, Any]


@click.command()
@click.option("--runs", default=9, show_default=True, help="Number of runs; the fastest counts.")
def main(runs: int) -> None:
    """Time and check the C header in both modes and models, and lookups in Python on the same colours."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise click.ClickException("this benchmark needs a C compiler, cc")
    cubes = {model: _build(model) for model in ("moments", "sigmoid")}
    rgb = np.random.default_rng(1).random((COLOURS, 3)).astype(np.float32)
    rows = [
        _measure(cube, mode, FLAGS, rgb, runs) for mode in ("spectra", "moments") for cube in cubes.values()
    ]
    flags = [
        _measure(cubes["moments"], mode, each, rgb, runs)
        for each in OTHER_FLAGS
        for mode in ("spectra", "moments")
    ]
    python = [_python(cubes["moments"], mode, rgb, runs) for mode in ("bulk", "spectra", "moments")]
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout
    write(
        "programs",
        "make bench",
        runs=runs,
        colours=COLOURS,
        compiler=version.splitlines()[0],
        flags=" ".join(FLAGS),
        rows=rows,
        by_flags=flags,
        python=python,
    )
    _picture(rows, python, ROOT / "docs" / "performance" / "programs.png")


def _build(model: str) -> Cube:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(ROOT / "atlases" / "macbeth.txt", dim=32, model=model)


def _measure(cube: Cube, mode: str, flags: tuple[str, ...], rgb: Any, runs: int) -> Row:
    """Compile the header, check its reflectances, and time it."""
    data = cube.data
    source = Path(__file__).with_name("rates.c")
    at = cube.wavelengths.astype(np.float32)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(data, folder / "cube.h", mode=mode)
        rgb.tofile(folder / "rgb")
        at.tofile(folder / "at")
        subprocess.run(["cc", *flags, "-I.", str(source), "-o", "rates", "-lm"], cwd=folder, check=True)
        command = ["./rates", "rgb", "at", str(runs), "found"]
        done = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
        found = np.fromfile(folder / "found", np.float32).reshape(CHECKED, -1).astype(float)
    lookup, many, evaluation, shared, _ = map(float, done.stdout.split())
    checked = rgb[:CHECKED].astype(float)
    worst = float(np.abs(found - cube.reflectance(checked, at, mode=mode)).max())
    if not worst <= WORST[mode]:
        raise RuntimeError(f"{mode}: reflectances differ by {worst}: nothing to time")
    difference = delta_e_rgb(data.sensor, data.sensor.rgb(found), checked)
    return {
        "model": data.model.name,
        "coefficients": data.model.count,
        "mode": mode,
        "flags": " ".join(flags),
        "lookup": COLOURS / lookup / 1e6,
        "many": COLOURS / many / 1e6,
        "evaluation": COLOURS / evaluation / 1e6,
        "shared": COLOURS / shared / 1e6,
        "worst": worst,
        "mean_delta_e": float(difference.mean()),
        "max_delta_e": float(difference.max()),
    }


def _python(cube: Cube, mode: str, rgb: Any, runs: int) -> Row:
    """Time lookups in Python: CPU seconds of all threads."""
    colours = rgb[:100_000].astype(float)
    if mode == "bulk":
        sample = bulk.spectra(cube, RAY, threads=1)
    else:

        def sample(values: Any) -> Any:
            return cube.reflectance(values, RAY, mode=mode, dtype=np.float32)

    best = np.inf
    for _ in range(runs):
        begin = time.process_time()
        sample(colours)
        best = min(best, time.process_time() - begin)
    name = "`uplift.bulk`, spectra" if mode == "bulk" else f"numpy, {mode}"
    return {"what": name, "lookup": len(colours) / best / 1e6}


def _picture(rows: list[Row], python: list[Row], path: Path) -> None:
    """Draw bars of lookups per second."""
    bars = [(f"C, {row['mode']}, {row['model']} ({row['coefficients']})", row["lookup"]) for row in rows]
    bars += [(row["what"].replace("`", ""), row["lookup"]) for row in python]
    figure = new_figure(6.4, 0.3 * len(bars) + 0.7)
    axes = figure.subplots()
    colours = [ACCENT] * len(rows) + [GREY] * len(python)
    axes.barh([name for name, _ in bars][::-1], [rate for _, rate in bars][::-1], color=colours[::-1])
    axes.set_xlabel("million colours per second, 16 wavelengths, one core")
    style_axes(axes)
    path.parent.mkdir(exist_ok=True)
    write_png(figure, path, force=True)


if __name__ == "__main__":
    main()
