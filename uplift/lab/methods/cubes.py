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
from dataclasses import asdict, dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Values
from uplift.cube.data import CubeData
from uplift.extras.export.program import write_program
from uplift.extras.timing import stopwatch
from uplift.lab.method import (
    Method,
    NotInstalledError,
    PreparedMethod,
    Uplift,
    in_float32,
    nbytes,
    ours,
)
from uplift.lab.runner import Prepare, Task
from uplift.lookup.cube import Cube, load
from uplift.models.moments import Moments
from uplift.pipeline.build import build

KEPT = 4
"""Cubes that are kept for further lookups of the same one."""


@lru_cache(maxsize=KEPT)
def _build(
    atlas: Atlas | None, builds: int, **options: Any
) -> tuple[Cube, float, float]:
    for _ in range(builds):
        cube, building = stopwatch(lambda: build(atlas, **options))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        loaded, loading = stopwatch(lambda: load(path))
    return loaded, building.cpu, loading.cpu


def built_cube(
    task: Task, *, atlas: bool = False, **options: Any
) -> tuple[Cube, float, float]:
    """Build, store and load the cube of a task with options of `uplift.build`, once for
    all lookups; return the CPU seconds of building and loading too.
    """
    known = task.known if atlas else None
    return _build(known, task.builds, leave_out=task.left_out, **options)


def cube(**options: Any) -> Prepare:
    """Return the method of a cube with options of `uplift.build`; with ``atlas=True``
    the known materials are its atlas.
    """
    return partial(prepare_lookup, **options)


def prepare_lookup(
    task: Task, mode: str = "spectra", dtype: str = "float64", **options: Any
) -> PreparedMethod:
    """Prepare `Cube.reflectance` in a mode."""
    cube, build_s, load_s = built_cube(task, **options)
    data = cube.data
    size = nbytes(
        data.points.coefficients,
        data.lattice.nodes,
        data.atlas.rgb,
        data.atlas.spectra.coefficients,
    )

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        return cube.reflectance(rgb, within(cube, wavelengths), mode, dtype=dtype)

    def stated(rgb: Array, light: Light) -> Array:
        columns = cube.standard_error(rgb, light), cube.error_bound(rgb, light)
        return np.stack([np.asarray(column) for column in columns], axis=1)

    known = None if data.points.standard_error is None else stated
    return PreparedMethod(uplift, size, build_s, load_s, known)


def within(cube: Cube, wavelengths: Array) -> Array:
    """Return the nearest wavelengths (N,) in the range of a cube."""
    return np.clip(wavelengths, *cube.wavelengths[[0, -1]])


def prepare_bulk(task: Task, mode: str, **options: Any) -> PreparedMethod:
    """Prepare a bulk sampler of the sensor's wavelengths, which compiles again; its
    only mode is ``bulk``.
    """
    import jax

    from uplift.lookup import bulk

    cube, build_s, load_s = built_cube(task, **options)
    jax.clear_caches()  # type: ignore[no-untyped-call]
    at = task.sensor.wavelengths
    sampler, preparing = stopwatch(lambda: bulk.spectra(cube, at, threads=1))
    _, compiling = stopwatch(lambda: sampler(task.rgb[:1]))

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        if np.array_equal(wavelengths, at):
            return sampler(rgb)
        return bulk.spectra(cube, within(cube, wavelengths), threads=1)(rgb)

    loading = load_s + preparing.cpu + compiling.cpu
    return PreparedMethod(uplift, sampler.nbytes, build_s, loading)


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


def prepare_c(task: Task, mode: str, **options: Any) -> PreparedMethod:
    """Build the cube, export and compile it, and load the library."""
    cube, build_s, _ = built_cube(task, **options)
    with tempfile.TemporaryDirectory() as folder:
        library, compiling = stopwatch(
            lambda: compile_cube(cube.data, mode, Path(folder))
        )
        uplift, loading = stopwatch(lambda: load_library(library))
        # The file may go: the loaded library stays in memory, except on Windows, which
        # has no cc.
        size = library.stat().st_size
        return PreparedMethod(uplift, size, build_s + compiling.cpu, loading.cpu)


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


@dataclass(frozen=True)
class CubeKind:
    """Model, coefficients and nodes of a cube, and whether it has an atlas."""

    model: str
    coefficients: int
    dim: int
    atlas: bool = False

    @property
    def name(self) -> str:
        """Return the name for the command line."""
        return f"{self._model('')}-{self.dim}{'-atlas' if self.atlas else ''}"

    @property
    def title(self) -> str:
        """Return the name to display."""
        return f"{self._model(' ')}, {self.dim}³{', atlas' if self.atlas else ''}"

    @property
    def command(self) -> str:
        """Return the command that builds the cube."""
        atlas = " --atlas FILE" if self.atlas else ""
        model = f"--model {self.model}"
        if self.model == Moments.name:
            model = f"--coefficients {self.coefficients}"
        return f"uplift build{atlas} --dim {self.dim} {model}"

    def _model(self, space: str) -> str:
        """Return the model, with the number of coefficients if there is a choice."""
        is_fixed = self.model != Moments.name
        return self.model if is_fixed else f"{self.model}{space}{self.coefficients}"


def in_python(
    cube: CubeKind, mode: str, prepare: Callable[..., PreparedMethod] = prepare_lookup
) -> Method:
    """Describe `Cube.reflectance` in a mode."""
    # Nodes of all modes are exact; colours between them are not in ``moments`` and
    # ``nearest``, and refined sigmoids.
    is_exact = mode in ("spectra", "bulk")
    if mode == "refined":
        is_exact = cube.model == Moments.name
    return Method(
        method=f"{cube.name}-{mode}",
        title=f"{cube.title}, {mode}",
        label=f"{cube.coefficients} · {cube.dim}³ {mode}",
        family=f"uplift, {cube.model}{' with atlas' if cube.atlas else ''}",
        source="this package",
        mode=mode,
        build=cube.command,
        call=f'cube.reflectance(rgb, mode="{mode}")',
        prepare=partial(prepare, mode=mode, **asdict(cube)),
        reference_sensor=ours,
        claimed_error=0.01 if is_exact else None,
    )


def in_single(cube: CubeKind, mode: str) -> Method:
    """Describe `Cube.reflectance` in a mode, in float32."""
    prepare = partial(prepare_lookup, dtype="float32")
    call = f'cube.reflectance(rgb, mode="{mode}", dtype="float32")'
    return in_float32(replace(in_python(cube, mode, prepare), call=call))


def in_bulk(cube: CubeKind) -> Method:
    """Describe `uplift.bulk`, by JAX."""
    python = in_python(cube, "bulk", prepare_bulk)
    return replace(
        python,
        label=f"{python.label} f32",
        dtype="float32",
        call="uplift.bulk.spectra(cube)(rgb)",
    )


def in_c(cube: CubeKind, mode: str) -> Method:
    """Describe the exported program of a mode."""
    python = in_python(cube, mode, prepare_c)
    return replace(
        python,
        method=f"c-{python.method}",
        title=f"C, {python.title}",
        label=f"C {python.label}",
        family="uplift, C export",
        dtype="float32",
        call=(
            f"uplift export CUBE -o cube.h --mode {mode}; cube_reflectances(rgb, "
            "wavelengths, count, out)"
        ),
        note=f"cc {' '.join(FLAGS[:5])}, called by ctypes",
        needs=COMPILER,
    )


Lookup = Callable[[CubeKind], Method]
"""Describes a lookup in a cube."""
SPECTRA = partial(in_python, mode="spectra")
MOMENTS = partial(in_python, mode="moments")
REFINED = partial(in_python, mode="refined")
NEAREST = partial(in_python, mode="nearest")
C_SPECTRA = partial(in_c, mode="spectra")
C_MOMENTS = partial(in_c, mode="moments")
BOTH_PRECISIONS = (
    SPECTRA,
    partial(in_single, mode="spectra"),
    MOMENTS,
    partial(in_single, mode="moments"),
    REFINED,
    partial(in_single, mode="refined"),
)
CUBES: dict[CubeKind, tuple[Lookup, ...]] = {
    CubeKind("moments", 3, 32, atlas=True): (SPECTRA, in_bulk),
    CubeKind("moments", 5, 32, atlas=True): (SPECTRA, in_bulk),
    CubeKind("moments", 9, 8, atlas=True): (SPECTRA, MOMENTS, REFINED, in_bulk),
    CubeKind("moments", 9, 16, atlas=True): (SPECTRA, MOMENTS, in_bulk),
    CubeKind("moments", 9, 32, atlas=True): (
        *BOTH_PRECISIONS,
        in_bulk,
        C_MOMENTS,
        C_SPECTRA,
    ),
    CubeKind("moments", 9, 64, atlas=True): (SPECTRA, MOMENTS, in_bulk),
    CubeKind("moments", 13, 32, atlas=True): (SPECTRA, in_bulk),
    CubeKind("moments", 17, 32, atlas=True): (SPECTRA, in_bulk),
    CubeKind("moments", 17, 64, atlas=True): (SPECTRA, in_bulk),
    CubeKind("moments", 9, 8): (SPECTRA, MOMENTS, REFINED, in_bulk),
    CubeKind("moments", 9, 16): (SPECTRA, MOMENTS, in_bulk),
    CubeKind("moments", 9, 32): (*BOTH_PRECISIONS, in_bulk, C_MOMENTS, C_SPECTRA),
    CubeKind("moments", 9, 64): (SPECTRA, MOMENTS, NEAREST, in_bulk),
    CubeKind("sigmoid", 3, 32, atlas=True): (SPECTRA,),
    CubeKind("sigmoid", 3, 8): (SPECTRA, MOMENTS, REFINED),
    CubeKind("sigmoid", 3, 16): (SPECTRA, MOMENTS),
    CubeKind("sigmoid", 3, 32): (*BOTH_PRECISIONS, C_MOMENTS, C_SPECTRA),
    CubeKind("sigmoid", 3, 64): (SPECTRA, MOMENTS, C_MOMENTS),
}
"""Cubes and their lookups."""
METHODS: list[Method] = []
for _cube, _lookups in CUBES.items():
    METHODS += [describe(_cube) for describe in _lookups]
