"""Rates and differences of uplift.h, which reads cube files at run time, for
docs/integrate.md.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks import CUBES, ROOT, Row, record
from uplift.common.arrays import Array
from uplift.extras.export import write_program
from uplift.extras.export.runtime import HEADER, compose_header, write_header
from uplift.lab.timing import environment
from uplift.lookup import Cube, load
from uplift.lookup.cube import PACKAGED
from uplift.lookup.interpolate import is_inexact

FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-w")
COLOURS = 20_000
RUNS = 9
RAY = np.array([450.0, 510.0, 570.0, 630.0])
INSIDE = -2e-3
"""Distance from the solid of the moved answers that are compared."""
WIDTHS = {"spectrum": 16, "ray": 4}


def main() -> None:
    """Measure stored and packaged cubes, and write docs/data/header.json."""
    paths = [*sorted(CUBES.glob("*.uplift")), *PACKAGED.values()]
    rows = [measure_cube(path) for path in paths]
    size = len(compose_header())
    record("header", environment=environment(), size=size, cubes=rows)


def measure_cube(path: Path) -> Row:
    """Return the nanoseconds of a lookup by both headers, their ratio, and the largest
    difference of uplift.h from Python.
    """
    cube = load(path)
    rgb = np.random.default_rng(1).random((COLOURS, 3)).astype(np.float32)
    row: Row = {"cube": path.stem}
    for kind, at in (("spectrum", cube.wavelengths), ("ray", RAY)):
        found, compiled, runtime = run(path, cube, rgb, at, WIDTHS[kind])
        row[kind] = {
            "compiled": compiled,
            "runtime": runtime,
            "ratio": runtime / compiled,
        }
        row[kind]["difference"] = largest_difference(cube, rgb.astype(float), at, found)
    return row


def largest_difference(cube: Cube, rgb: Array, at: Array, found: Array) -> float:
    """Return the largest difference of reflectances from those of Python, except next
    to colours that no reflectance has.
    """
    data = cube.data
    inside = data.solid.signed_distance(rgb) < INSIDE
    compared = inside | ~is_inexact(data, rgb)
    expected = cube.reflectance(rgb[compared], at)
    return float(np.abs(found[compared] - expected).max())


def run(
    path: Path, cube: Cube, rgb: Array, at: Array, width: int
) -> tuple[Array, float, float]:
    """Return reflectances (n, N) by uplift.h, and nanoseconds of a lookup by the
    exported header and by uplift.h.
    """
    source = ROOT / "benchmarks" / "header.c"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(cube.data, folder / "cube.h")
        write_header(folder / HEADER)
        rgb.tofile(folder / "rgb")
        at.astype(np.float32).tofile(folder / "at")
        widths = (f"-DUPLIFT_WIDTH={width}", f"-DCUBE_WIDTH={width}")
        compiler = ["cc", *FLAGS, *widths, "-I.", str(source), "-o", "rates", "-lm"]
        subprocess.run(compiler, cwd=folder, check=True)
        command = ["./rates", str(path), "rgb", "at", str(RUNS), "spectra"]
        printed = subprocess.check_output(command, cwd=folder, text=True)
        spectra = np.fromfile(folder / "spectra", np.float32).astype(float)
    compiled, runtime = (float(word) / len(rgb) * 1e9 for word in printed.split())
    return spectra.reshape(len(rgb), -1), compiled, runtime
