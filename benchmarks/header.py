"""Rates and differences of exported programs, and of uplift.h and uplift.js,
which read cube files at run time, for docs/integrate.md and docs/speed.md.
"""

import shutil
import tempfile
from collections.abc import Iterator
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, MACBETH, ROOT, Row
from benchmarks.programs import Words, compile_c, numbers, program_version
from uplift.common.arrays import Array
from uplift.extras.export.module import write_module
from uplift.extras.export.program import write_program
from uplift.extras.export.runtime import HEADER, write_header
from uplift.lookup.cube import PACKAGED, Cube, load
from uplift.lookup.interpolate import is_inexact

PORTABLE = ("-O3", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math")
NATIVE = ("-O3", "-march=native", "-fno-math-errno", "-w")
"""Flags of the exported program alone, and of both headers."""
MODES = ("spectra", "moments")
MODELS = ("moments", "sigmoid")
EXPORT_DIM = 32
EXPORTED = 400_000
EXPORT_RUNS = 5
CHECKED = 10_000
"""Colours of the timed ones whose reflectances are compared."""
MAX_DIFFERENCE = 1e-3
COLOURS = 20_000
RUNS = 9
COMPARED = 100_000
"""Colours anywhere, and as many on the faces of RGB, that are compared."""
RAY = np.array([450.0, 510.0, 570.0, 630.0])
HEADERS = ("exported", "uplift.h")
MODULES = ("uplift.js",)
"""Programs whose times `header.c` and `header.mjs` print; the last one's spectra are
compared.
"""
INSIDE = -2e-3
"""Distance from the solid of the moved answers that are compared."""


def run_lookups(
    *command: Words, folder: Path, rgb: Array, at: Array, runs: int
) -> tuple[Array, list[float]]:
    """Run a program on colours; return the reflectances (n, N) that it writes, and the
    nanoseconds of a lookup of the CPU seconds that it prints.
    """
    rgb.astype(np.float32).tofile(folder / "rgb")
    at.astype(np.float32).tofile(folder / "at")
    seconds = numbers(*command, "rgb", "at", str(runs), "spectra", folder=folder)
    spectra = np.fromfile(folder / "spectra", np.float32).astype(float)
    return spectra.reshape(-1, len(at)), [1e9 * each / len(rgb) for each in seconds]


def random_colours(count: int) -> Array:
    """Return linear RGB (n, 3), float32."""
    return np.random.default_rng(1).random((count, 3)).astype(np.float32)


def programs() -> Row:
    """Return million colours per second of exported programs on one core: colours one
    by one, many in a call, and of stored multipliers.
    """
    rgb = random_colours(EXPORTED)
    cubes = [uplift.build(MACBETH, dim=EXPORT_DIM, model=name) for name in MODELS]
    rows = [time_export(cube, mode, rgb) for mode, cube in product(MODES, cubes)]
    return {"compiler": program_version("cc"), "rows": rows}


def time_export(cube: Cube, mode: str, rgb: Array) -> Row:
    """Compile the program of a cube, check its reflectances and time it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(cube.data, folder / "cube.h", mode=mode)
        rates = compile_c(ROOT / "benchmarks" / "rates.c", folder, *PORTABLE)
        spectra, nanoseconds = run_lookups(
            rates, folder=folder, rgb=rgb, at=cube.wavelengths, runs=EXPORT_RUNS
        )
    expected = cube.reflectance(rgb[:CHECKED].astype(float), mode=mode)
    np.testing.assert_allclose(spectra, expected, rtol=0, atol=MAX_DIFFERENCE)
    one, many, multipliers = (1e3 / each for each in nanoseconds)
    return {
        "model": cube.data.model.name,
        "coefficients": cube.data.model.count,
        "mode": mode,
        "lookup": one,
        "many": many,
        "evaluation": multipliers,
    }


def lookups() -> Iterator[Row]:
    """Yield the nanoseconds of a lookup in stored and packaged cubes by an exported
    header, uplift.h and uplift.js, and differences of the latter two from Python.
    """
    for path in (*sorted(CUBES.glob("*-16*.uplift")), *PACKAGED.values()):
        cube = load(path)
        rgb = compared_colours(cube)
        for at in (cube.wavelengths, RAY):
            expected = cube.reflectance(rgb.astype(float), at)
            row = {"cube": path.stem, "wavelengths": len(at)}
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                run = partial(run_lookups, folder=folder, at=at)
                header = [write_headers(cube, folder), path]
                module = [*write_script(folder), path]
                for command, programs in ((header, HEADERS), (module, MODULES)):
                    spectra, _ = run(*command, rgb=rgb, runs=1)
                    _, times = run(*command, rgb=random_colours(COLOURS), runs=RUNS)
                    difference = np.abs(spectra - expected).max()
                    for program, ns in zip(programs, times, strict=True):
                        compared = difference if program == programs[-1] else None
                        found = {"program": program, "ns": ns, "difference": compared}
                        yield row | found


def write_headers(cube: Cube, folder: Path) -> Path:
    """Compile the program of the exported header and uplift.h, which take turns."""
    write_program(cube.data, folder / "cube.h")
    write_header(folder / HEADER)
    return compile_c(ROOT / "benchmarks" / "header.c", folder, *NATIVE)


def write_script(folder: Path) -> tuple[str, str]:
    """Write uplift.js, and return the command of the script that runs it."""
    write_module(folder / "uplift.mjs")
    shutil.copy(ROOT / "benchmarks" / "header.mjs", folder)
    return "node", "header.mjs"


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


QUESTIONS = {"programs": programs, "lookups": lookups}
