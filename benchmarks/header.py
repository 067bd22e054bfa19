"""Rates, sizes and differences of uplift.h and uplift.js, which read cube files at run
time, for docs/integrate.md.
"""

import base64
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks import CUBES, ROOT, Row, record
from uplift.common.arrays import Array
from uplift.extras.export import write_program
from uplift.extras.export.module import compose_module, write_module
from uplift.extras.export.runtime import HEADER, compose_header, write_header
from uplift.extras.report import live_page
from uplift.lab.timing import environment
from uplift.lookup import Cube, load
from uplift.lookup.cube import PACKAGED
from uplift.lookup.interpolate import is_inexact

FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-w")
COLOURS = 20_000
COMPARED = 100_000
"""Colours anywhere, and as many on the faces of RGB, that are compared."""
RUNS = 9
RAY = np.array([450.0, 510.0, 570.0, 630.0])
INSIDE = -2e-3
"""Distance from the solid of the moved answers that are compared."""
WIDTHS = {"spectrum": 16, "ray": 4}


def main() -> None:
    """Measure stored and packaged cubes, and write docs/data/header.json."""
    sizes = {
        "header": len(compose_header()),
        "module": len(compose_module()),
        "page": measure_page(PACKAGED["srgb"]),
    }
    paths = [*sorted(CUBES.glob("*.uplift")), *PACKAGED.values()]
    rows = [measure_cube(path) for path in paths]
    record("header", environment=environment(), sizes=sizes, cubes=rows)


def measure_page(path: Path) -> Row:
    """Return the bytes of the live page of a cube, and of uplift.js and the file of the
    cube, which it could contain.
    """
    page = live_page.page(load(path).data)
    file = base64.b64encode(path.read_bytes())
    added = len(compose_module()) + len(file)
    return {"cube": path.stem, "size": len(page.encode()), "added": added}


def measure_cube(path: Path) -> Row:
    """Return the nanoseconds of a lookup by both headers and by uplift.js, and the
    largest differences of uplift.h and uplift.js from Python.
    """
    cube = load(path)
    rgb = compared_colours(cube)
    exact = rgb.astype(float)
    row: Row = {"cube": path.stem}
    for kind, at in (("spectrum", cube.wavelengths), ("ray", RAY)):
        expected = cube.reflectance(exact, at)
        found, compiled, runtime = run(path, cube, rgb, at, WIDTHS[kind])
        module_found, module = run_module(path, rgb, at)
        row[kind] = {
            "compiled": compiled,
            "runtime": runtime,
            "ratio": runtime / compiled,
            "difference": float(np.abs(found - expected).max()),
            "module": module,
            "module_difference": float(np.abs(module_found - expected).max()),
        }
    return row


def compared_colours(cube: Cube) -> Array:
    """Return linear RGB (n, 3), float32, anywhere and on the faces of RGB, except next
    to colours that no reflectance has.
    """
    random = np.random.default_rng(1)
    anywhere, faces = random.random((2, COMPARED, 3))
    axes = random.integers(3, size=COMPARED)
    faces[np.arange(COMPARED), axes] = random.integers(2, size=COMPARED)
    rgb = np.concatenate([anywhere, faces]).astype(np.float32)
    exact = rgb.astype(float)
    inside = cube.data.solid.signed_distance(exact) < INSIDE
    return rgb[inside | ~is_inexact(cube.data, exact)]


def timed_colours() -> Array:
    """Return linear RGB (n, 3), float32, of which lookups are timed."""
    return np.random.default_rng(1).random((COLOURS, 3)).astype(np.float32)


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
        widths = (f"-DUPLIFT_WIDTH={width}", f"-DCUBE_WIDTH={width}")
        compiler = ["cc", *FLAGS, *widths, "-I.", str(source), "-o", "rates", "-lm"]
        subprocess.run(compiler, cwd=folder, check=True)
        rates = ["./rates"]
        _, (compiled, runtime) = answer(rates, folder, path, timed_colours(), at)
        found, _ = answer(rates, folder, path, rgb, at)
    return found, compiled, runtime


def run_module(path: Path, rgb: Array, at: Array) -> tuple[Array, float]:
    """Return reflectances (n, N) by uplift.js in node, and nanoseconds of a lookup."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_module(folder / "uplift.mjs")
        shutil.copy(ROOT / "benchmarks" / "header.mjs", folder)
        node = ["node", "header.mjs"]
        _, (module,) = answer(node, folder, path, timed_colours(), at)
        found, _ = answer(node, folder, path, rgb, at)
    return found, module


def answer(
    command: list[str], folder: Path, path: Path, rgb: Array, at: Array
) -> tuple[Array, list[float]]:
    """Run a program in a folder: return the reflectances (n, N) that it writes, and the
    nanoseconds of a lookup of the seconds that it prints.
    """
    rgb.tofile(folder / "rgb")
    at.astype(np.float32).tofile(folder / "at")
    words = [*command, str(path), "rgb", "at", str(RUNS), "spectra"]
    printed = subprocess.check_output(words, cwd=folder, text=True)
    spectra = np.fromfile(folder / "spectra", np.float32).astype(float)
    rates = [float(word) / len(rgb) * 1e9 for word in printed.split()]
    return spectra.reshape(len(rgb), -1), rates
