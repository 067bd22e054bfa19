"""Cubes of this package as C, compiled with the system's compiler: the programs of `uplift.io.export.write_program`.

Domain: linear sRGB in [0, 1] under D65, float32. Range: reflectance in [0, 1] at any wavelengths, float32. A call takes
all colours; the loop over them is in C, on one thread.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.io.export import write_program
from uplift.lab.chart.method import (
    Claims,
    Family,
    Method,
    NotInstalledError,
    PreparedMethod,
    Task,
    Uplift,
    ours,
    stopwatch,
)
from uplift.lab.chart.methods.uplift_cubes import EXACT, CubeOptions, built_cube

COMPILER = "a C compiler, cc: apt install gcc"
SECONDS = 60
"""Time limit of the compiler."""
FLAGS = ("-std=c99", "-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-shared", "-fPIC")
SOURCE = """#include "cube.h"
void uplift_colours(const float *rgb, const float *wavelengths, int width, long colours, float *reflectances)
{
    long k;
    for (k = 0; k < colours; ++k) cube_reflectances(rgb + 3 * k, wavelengths, width, reflectances + width * k);
}
"""
"""The wavelengths are those of all colours; ``cube_reflectances_n`` takes different ones for each."""
JOBS = (
    (CubeOptions("sigmoid", 3, 32, atlas=False), "moments"),
    (CubeOptions("sigmoid", 3, 32, atlas=False), "spectra"),
    (CubeOptions("sigmoid", 3, 64, atlas=False), "moments"),
    (CubeOptions("moments", 9, 32, atlas=False), "moments"),
    (CubeOptions("moments", 9, 32, atlas=False), "spectra"),
    (CubeOptions("moments", 9, 32, atlas=True), "moments"),
    (CubeOptions("moments", 9, 32, atlas=True), "spectra"),
)
"""Cubes and modes."""


def prepare(task: Task, options: CubeOptions, mode: str) -> PreparedMethod:
    """Build the cube, export and compile it, and load the library."""
    compiler = shutil.which("cc")
    if compiler is None:
        raise NotInstalledError(f"needs {COMPILER}")
    cube, seconds, _ = built_cube(task, options)
    with tempfile.TemporaryDirectory() as folder:
        library, compilation = stopwatch(lambda: compile_cube(cube.data, mode, compiler, Path(folder)))
        size = library.stat().st_size
        uplift, loading = stopwatch(lambda: load_library(library))
        # The file may go: the loaded library stays in memory, except on Windows, which has no cc.
        return PreparedMethod(uplift, size, seconds + compilation, loading)


def compile_cube(data: CubeData, mode: str, compiler: str, folder: Path) -> Path:
    """Export a cube and compile it to a shared library, whose file is returned."""
    write_program(data, folder / "cube.h", mode=mode)
    (folder / "cube.c").write_text(SOURCE)
    command = [compiler, *FLAGS, "cube.c", "-o", "cube.so", "-lm"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=SECONDS)
    return folder / "cube.so"


def load_library(path: Path) -> Uplift:
    """Load a shared library of `compile_cube`; return the function of colours and wavelengths."""
    function: Any = ctypes.CDLL(str(path)).uplift_colours
    floats = np.ctypeslib.ndpointer(np.float32, flags="C_CONTIGUOUS")
    function.argtypes = [floats, floats, ctypes.c_int, ctypes.c_long, floats]
    function.restype = None

    def uplift(rgb: Array, wavelengths: Array) -> NDArray[np.float32]:
        colours = np.ascontiguousarray(rgb, np.float32)
        reflectances = np.empty((len(rgb), len(wavelengths)), np.float32)
        function(colours, wavelengths.astype(np.float32), len(wavelengths), len(rgb), reflectances)
        return reflectances

    return uplift


def _method(options: CubeOptions, mode: str) -> Method:
    return Method(
        f"c-{options.name}-{mode}",
        f"C, {options.title}, {mode}",
        partial(prepare, options=options, mode=mode),
        EXACT if mode == "spectra" else Claims(),
        dtype="float32",
        judge=ours,
        quick=(options.dim, options.model, mode) == (32, "sigmoid", "moments"),
        label=f"C {options.label} {mode}",
        mode=mode,
        build=options.command,
        call=f"uplift export CUBE -o cube.h --mode {mode}; cube_reflectances(rgb, wavelengths, count, out)",
        note=f"cc {' '.join(FLAGS[:5])}, called by ctypes",
        needs=COMPILER,
    )


FAMILIES = (Family("uplift, C export", "this package", "#b8860b", tuple(_method(*job) for job in JOBS)),)
