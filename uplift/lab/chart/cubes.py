"""Cubes of this package: both models, several sizes, with and without an atlas, by
lookup in Python, in bulk and in C.

Domain: linear sRGB in [0, 1] under D65. Range: reflectance in [0, 1] at any
wavelengths. C is the program of `uplift.extras.export.write_program`, compiled with the
system's compiler. A call takes all colours, on one thread.
"""

import ctypes
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from uplift.common.arrays import Array, Values
from uplift.cube import CubeData
from uplift.extras.export import write_program
from uplift.lab.chart.method import (
    Method,
    NotInstalledError,
    PreparedMethod,
    Task,
    Uplift,
    nbytes,
    ours,
    stopwatch,
)
from uplift.lookup import Cube, load
from uplift.models import Moments
from uplift.pipeline.options import ModelName


@dataclass(frozen=True)
class CubeOptions:
    """Options of a build."""

    model: ModelName
    count: int
    dim: int
    atlas: bool = False

    @property
    def name(self) -> str:
        """Return the name for the command line."""
        count = self.count if self.model == Moments.name else ""
        return f"{self.model}{count}-{self.dim}{'-atlas' if self.atlas else ''}"

    @property
    def title(self) -> str:
        """Return the name to display."""
        count = f" {self.count}" if self.model == Moments.name else ""
        return f"{self.model}{count}, {self.dim}³{', atlas' if self.atlas else ''}"

    @property
    def command(self) -> str:
        """Return the command that builds the cube."""
        model = (
            f"--coefficients {self.count}"
            if self.model == Moments.name
            else f"--model {self.model}"
        )
        return (
            f"uplift build {'--atlas FILE ' if self.atlas else ''}--dim {self.dim} "
            f"{model}"
        )


@cache
def built_cube(task: Task, options: CubeOptions) -> tuple[Cube, float, float]:
    """Build, store and load a cube once for all methods; return the CPU seconds too."""
    from uplift.lab.study.look_alikes import families_like
    from uplift.pipeline.build import build

    timed = partial(
        build,
        task.kept if options.atlas else None,
        leave_out=families_like(task.unseen),
        dim=options.dim,
        model=options.model,
        coefficients=options.count,
    )
    for _ in range(task.effort.builds):
        cube, seconds = stopwatch(timed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        return load(path), seconds, stopwatch(lambda: load(path))[1]


def within(cube: Cube, wavelengths: Array) -> Array:
    """Return the nearest wavelengths (N,) in the range of a cube."""
    return np.clip(wavelengths, *cube.wavelengths[[0, -1]])


def prepare_lookup(
    task: Task, options: CubeOptions, mode: str, dtype: str
) -> PreparedMethod:
    """Prepare `Cube.reflectance` in a mode."""
    cube, seconds, loading = built_cube(task, options)

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        return cube.reflectance(rgb, within(cube, wavelengths), mode, dtype=dtype)

    data = cube.data
    size = nbytes(
        data.points.coefficients,
        data.lattice.nodes,
        data.atlas.rgb,
        data.atlas.spectra.coefficients,
    )
    return PreparedMethod(uplift, size, seconds, loading)


def prepare_bulk(task: Task, options: CubeOptions) -> PreparedMethod:
    """Prepare a bulk sampler of the sensor's wavelengths, which compiles again."""
    import jax

    from uplift.lookup import bulk

    cube, seconds, loading = built_cube(task, options)
    jax.clear_caches()  # type: ignore[no-untyped-call]
    at = task.sensor.wavelengths
    sampler, preparing = stopwatch(lambda: bulk.spectra(cube, at, threads=1))
    _, compiling = stopwatch(lambda: sampler(task.rgb[:1]))

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        if np.array_equal(wavelengths, at):
            return sampler(rgb)
        return bulk.spectra(cube, within(cube, wavelengths), threads=1)(rgb)

    loading += preparing + compiling
    return PreparedMethod(uplift, sampler.nbytes, seconds, loading)


COMPILER = "a C compiler, cc: apt install gcc"
SECONDS = 60
"""Time limit of the compiler."""
FLAGS = (
    "-std=c99",
    "-O3",
    "-march=native",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-shared",
    "-fPIC",
)
SOURCE = """#include "cube.h"
void uplift_colours(
    const float *rgb, const float *wavelengths, int width, long colours,
    float *reflectances)
{
    long k;
    for (k = 0; k < colours; ++k)
        cube_reflectances(rgb + 3 * k, wavelengths, width, reflectances + width * k);
}
"""


def prepare_c(task: Task, options: CubeOptions, mode: str) -> PreparedMethod:
    """Build the cube, export and compile it, and load the library."""
    cube, seconds, _ = built_cube(task, options)
    with tempfile.TemporaryDirectory() as folder:
        library, compiling = stopwatch(
            lambda: compile_cube(cube.data, mode, Path(folder))
        )
        uplift, loading = stopwatch(lambda: load_library(library))
        # The file may go: the loaded library stays in memory, except on Windows, which
        # has no cc.
        size = library.stat().st_size
        return PreparedMethod(uplift, size, seconds + compiling, loading)


def compile_cube(data: CubeData, mode: str, folder: Path) -> Path:
    """Export a cube and compile it to a shared library, whose file is returned. Raises
    `NotInstalledError`.
    """
    if shutil.which("cc") is None:
        raise NotInstalledError(f"needs {COMPILER}")
    write_program(data, folder / "cube.h", mode=mode)
    (folder / "cube.c").write_text(SOURCE)
    command = ["cc", *FLAGS, "cube.c", "-o", "cube.so", "-lm"]
    subprocess.run(
        command, cwd=folder, check=True, capture_output=True, timeout=SECONDS
    )
    return folder / "cube.so"


def load_library(path: Path) -> Uplift:
    """Load a shared library of `compile_cube`; return the function of colours and
    wavelengths.
    """
    function: Any = ctypes.CDLL(str(path)).uplift_colours
    floats = np.ctypeslib.ndpointer(np.float32, flags="C_CONTIGUOUS")
    function.argtypes = [floats, floats, ctypes.c_int, ctypes.c_long, floats]
    function.restype = None

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        size = (len(rgb), len(wavelengths))
        reflectances = np.empty(size, np.float32)
        colours = np.ascontiguousarray(rgb, np.float32)
        at = wavelengths.astype(np.float32)
        function(colours, at, *size[::-1], reflectances)
        return reflectances

    return uplift


FLOAT32 = "-float32"
_BOTH = "spectra spectra-float32 moments moments-float32 refined refined-float32"
JOBS = {
    CubeOptions("moments", 3, 32, atlas=True): "spectra bulk",
    CubeOptions("moments", 5, 32, atlas=True): "spectra bulk",
    CubeOptions("moments", 9, 8, atlas=True): "spectra moments refined bulk",
    CubeOptions("moments", 9, 16, atlas=True): "spectra moments bulk",
    CubeOptions("moments", 9, 32, atlas=True): f"{_BOTH} bulk c-moments c-spectra",
    CubeOptions("moments", 9, 64, atlas=True): "spectra moments bulk",
    CubeOptions("moments", 13, 32, atlas=True): "spectra bulk",
    CubeOptions("moments", 17, 32, atlas=True): "spectra bulk",
    CubeOptions("moments", 17, 64, atlas=True): "spectra bulk",
    CubeOptions("moments", 9, 8): "spectra moments refined bulk",
    CubeOptions("moments", 9, 16): "spectra moments bulk",
    CubeOptions("moments", 9, 32): f"{_BOTH} bulk c-moments c-spectra",
    CubeOptions("moments", 9, 64): "spectra moments nearest bulk",
    CubeOptions("sigmoid", 3, 32, atlas=True): "spectra",
    CubeOptions("sigmoid", 3, 8): "spectra moments refined",
    CubeOptions("sigmoid", 3, 16): "spectra moments",
    CubeOptions("sigmoid", 3, 32): f"{_BOTH} c-moments c-spectra",
    CubeOptions("sigmoid", 3, 64): "spectra moments c-moments",
}
"""Cubes and their lookups: modes of `Cube.reflectance`, in float64 or float32, in bulk
with JAX, and by C.
"""


def _method(options: CubeOptions, lookup: str) -> Method:
    mode = lookup.removeprefix("c-").removesuffix(FLOAT32)
    # Nodes of all modes are exact; colours between them are not in ``moments`` and
    # ``nearest``, and refined sigmoids.
    exact = mode in ("spectra", "bulk") or (
        mode == "refined" and options.model == Moments.name
    )
    dtype = "float64" if lookup == mode and mode != "bulk" else "float32"
    name = f"{options.name}-{lookup}"
    title = f"{options.title}, {lookup.replace('-', ', ')}"
    label = f"{options.count} · {options.dim}³ {mode}"
    family = f"uplift, {options.model}{' with atlas' if options.atlas else ''}"
    note = ""
    needs = ""
    prepare: Callable[..., PreparedMethod]
    if lookup.startswith("c-"):
        name = f"c-{options.name}-{mode}"
        title = f"C, {options.title}, {mode}"
        label = f"C {label}"
        family = "uplift, C export"
        prepare = partial(prepare_c, mode=mode)
        call = (
            f"uplift export CUBE -o cube.h --mode {mode}; cube_reflectances(rgb, "
            "wavelengths, count, out)"
        )
        note = f"cc {' '.join(FLAGS[:5])}, called by ctypes"
        needs = COMPILER
    elif mode == "bulk":
        label = f"{label} f32"
        prepare = prepare_bulk
        call = "uplift.bulk.spectra(cube)(rgb)"
    else:
        of_dtype = ', dtype="float32"' if lookup.endswith(FLOAT32) else ""
        label += " f32" if of_dtype else ""
        prepare = partial(prepare_lookup, mode=mode, dtype=dtype)
        call = f'cube.reflectance(rgb, mode="{mode}"{of_dtype})'
    return Method(
        method=name,
        title=title,
        label=label,
        family=family,
        source="this package",
        mode=mode,
        dtype=dtype,
        build=options.command,
        call=call,
        note=note,
        prepare=partial(prepare, options=options),
        reference_sensor=ours,
        claimed_error=0.01 if exact else None,
        needs=needs,
    )


METHODS: list[Method] = []
for _options, _lookups in JOBS.items():
    METHODS += [_method(_options, lookup) for lookup in _lookups.split()]
