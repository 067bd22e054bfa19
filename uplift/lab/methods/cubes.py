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
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any, Protocol, cast

import numpy as np

from uplift.atlas import Atlas
from uplift.colorimetry import Light
from uplift.common.arrays import Array, Values
from uplift.cube import CubeData
from uplift.extras.export import write_program
from uplift.lab.method import (
    Method,
    NotInstalledError,
    PreparedMethod,
    Uplift,
    nbytes,
    ours,
    stopwatch,
)
from uplift.lab.runner import Prepare, Task
from uplift.lookup import Cube, load
from uplift.models import Moments
from uplift.pipeline.build import build

KEPT = 4
"""Cubes that are kept for further lookups of the same one."""


@dataclass(frozen=True, eq=False)
class BuiltCube:
    """A stored and loaded cube, with the CPU seconds of both."""

    cube: Cube
    build_s: float
    load_s: float


@lru_cache(maxsize=KEPT)
def _built(atlas: Atlas | None, builds: int, **options: Any) -> BuiltCube:
    for _ in range(builds):
        cube, seconds = stopwatch(lambda: build(atlas, **options))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "cube.uplift"
        cube.save(path)
        loaded, loading = stopwatch(lambda: load(path))
    return BuiltCube(loaded, seconds, loading)


def built_cube(task: Task, atlas: bool, **options: Any) -> BuiltCube:
    """Build the cube of a task with options of `uplift.build`, once for all lookups."""
    known = task.known if atlas else None
    return _built(known, task.builds, leave_out=task.left_out, **options)


def cube(atlas: bool = False, **options: Any) -> Prepare:
    """Return the method of a cube, with the known materials as its ``atlas`` or without
    one, and with options of `uplift.build`.
    """
    return partial(prepare_lookup, atlas=atlas, **options)


def prepare_lookup(
    task: Task,
    *,
    atlas: bool,
    mode: str = "spectra",
    dtype: str = "float64",
    **options: Any,
) -> PreparedMethod:
    """Prepare `Cube.reflectance` in a mode."""
    built = built_cube(task, atlas, **options)
    cube = built.cube
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
    return PreparedMethod(uplift, size, built.build_s, built.load_s, known)


def within(cube: Cube, wavelengths: Array) -> Array:
    """Return the nearest wavelengths (N,) in the range of a cube."""
    return np.clip(wavelengths, *cube.wavelengths[[0, -1]])


def prepare_bulk(task: Task, *, atlas: bool, **options: Any) -> PreparedMethod:
    """Prepare a bulk sampler of the sensor's wavelengths, which compiles again."""
    import jax

    from uplift.lookup import bulk

    built = built_cube(task, atlas, **options)
    jax.clear_caches()  # type: ignore[no-untyped-call]
    at = task.sensor.wavelengths
    sampler, preparing = stopwatch(lambda: bulk.spectra(built.cube, at, threads=1))
    _, compiling = stopwatch(lambda: sampler(task.rgb[:1]))

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        if np.array_equal(wavelengths, at):
            return sampler(rgb)
        inside = within(built.cube, wavelengths)
        return bulk.spectra(built.cube, inside, threads=1)(rgb)

    loading = built.load_s + preparing + compiling
    return PreparedMethod(uplift, sampler.nbytes, built.build_s, loading)


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


def prepare_c(task: Task, *, atlas: bool, mode: str, **options: Any) -> PreparedMethod:
    """Build the cube, export and compile it, and load the library."""
    built = built_cube(task, atlas, **options)
    with tempfile.TemporaryDirectory() as folder:
        library, compiling = stopwatch(
            lambda: compile_cube(built.cube.data, mode, Path(folder))
        )
        uplift, loading = stopwatch(lambda: load_library(library))
        # The file may go: the loaded library stays in memory, except on Windows, which
        # has no cc.
        size = library.stat().st_size
        return PreparedMethod(uplift, size, built.build_s + compiling, loading)


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
    """A kind of cube, and the texts about it."""

    model: str
    coefficients: int
    dim: int
    atlas: bool = False

    @property
    def options(self) -> dict[str, Any]:
        """Return the keywords of `built_cube`."""
        return vars(self)

    @property
    def name(self) -> str:
        """Return the name for the command line."""
        count = self.coefficients if self.is_moments else ""
        return f"{self.model}{count}-{self.dim}{'-atlas' if self.atlas else ''}"

    @property
    def title(self) -> str:
        """Return the name to display."""
        count = f" {self.coefficients}" if self.is_moments else ""
        return f"{self.model}{count}, {self.dim}³{', atlas' if self.atlas else ''}"

    @property
    def label(self) -> str:
        """Return the label of its markers."""
        return f"{self.coefficients} · {self.dim}³"

    @property
    def family(self) -> str:
        """Return the name in the legend."""
        return f"uplift, {self.model}{' with atlas' if self.atlas else ''}"

    @property
    def is_moments(self) -> bool:
        """Whether the number of coefficients is free."""
        return self.model == Moments.name

    def claim(self, mode: str) -> float | None:
        """Return the error of round trips: nodes of all modes are exact; colours
        between them are not in ``moments`` and ``nearest``, and refined sigmoids.
        """
        exact = mode == "spectra" or (mode == "refined" and self.is_moments)
        return 0.01 if exact else None

    def method(self, **fields: Any) -> Method:
        """Describe a lookup of the cube."""
        count = f"--coefficients {self.coefficients}"
        model = count if self.is_moments else f"--model {self.model}"
        atlas = "--atlas FILE " if self.atlas else ""
        command = f"uplift build {atlas}--dim {self.dim} {model}"
        common = {"family": self.family, "source": "this package", "build": command}
        return Method(reference_sensor=ours, **common | fields)


class Lookup(Protocol):
    """A way to look up the spectra of a cube."""

    def of(self, kind: CubeKind) -> Method:
        """Return the method of a kind of cube."""


@dataclass(frozen=True)
class PythonLookup:
    """`Cube.reflectance` in a mode."""

    mode: str

    def of(self, kind: CubeKind) -> Method:
        """Return the method in float64."""
        return kind.method(
            method=f"{kind.name}-{self.mode}",
            title=f"{kind.title}, {self.mode}",
            label=f"{kind.label} {self.mode}",
            mode=self.mode,
            call=f'cube.reflectance(rgb, mode="{self.mode}")',
            claimed_error=kind.claim(self.mode),
            prepare=partial(prepare_lookup, mode=self.mode, **kind.options),
        )


@dataclass(frozen=True)
class SinglePrecision(PythonLookup):
    """`Cube.reflectance` in a mode, in float32."""

    def of(self, kind: CubeKind) -> Method:
        """Return the method in float32."""
        double = super().of(kind)
        return replace(
            double,
            method=f"{double.method}-float32",
            title=f"{double.title}, float32",
            label=f"{double.label} f32",
            dtype="float32",
            call=f'{double.call[:-1]}, dtype="float32")',
            prepare=partial(cast(Any, double.prepare), dtype="float32"),
        )


@dataclass(frozen=True)
class Bulk:
    """`uplift.bulk`, by JAX."""

    def of(self, kind: CubeKind) -> Method:
        """Return the method in float32."""
        return kind.method(
            method=f"{kind.name}-bulk",
            title=f"{kind.title}, bulk",
            label=f"{kind.label} bulk f32",
            mode="bulk",
            dtype="float32",
            call="uplift.bulk.spectra(cube)(rgb)",
            claimed_error=kind.claim("spectra"),
            prepare=partial(prepare_bulk, **kind.options),
        )


@dataclass(frozen=True)
class CProgram:
    """The exported program of a mode."""

    mode: str

    def of(self, kind: CubeKind) -> Method:
        """Return the method in float32."""
        return kind.method(
            method=f"c-{kind.name}-{self.mode}",
            title=f"C, {kind.title}, {self.mode}",
            label=f"C {kind.label} {self.mode}",
            family="uplift, C export",
            mode=self.mode,
            dtype="float32",
            call=(
                f"uplift export CUBE -o cube.h --mode {self.mode}; "
                "cube_reflectances(rgb, wavelengths, count, out)"
            ),
            note=f"cc {' '.join(FLAGS[:5])}, called by ctypes",
            claimed_error=kind.claim(self.mode),
            prepare=partial(prepare_c, mode=self.mode, **kind.options),
            needs=COMPILER,
        )


SPECTRA = PythonLookup("spectra")
MOMENTS = PythonLookup("moments")
REFINED = PythonLookup("refined")
NEAREST = PythonLookup("nearest")
BULK = Bulk()
C_MOMENTS = CProgram("moments")
C_SPECTRA = CProgram("spectra")
BOTH: list[Lookup] = [SPECTRA, MOMENTS, REFINED]
BOTH += map(SinglePrecision, ("spectra", "moments", "refined"))
JOBS: dict[CubeKind, tuple[Lookup, ...]] = {
    CubeKind("moments", 3, 32, atlas=True): (SPECTRA, BULK),
    CubeKind("moments", 5, 32, atlas=True): (SPECTRA, BULK),
    CubeKind("moments", 9, 8, atlas=True): (SPECTRA, MOMENTS, REFINED, BULK),
    CubeKind("moments", 9, 16, atlas=True): (SPECTRA, MOMENTS, BULK),
    CubeKind("moments", 9, 32, atlas=True): (*BOTH, BULK, C_MOMENTS, C_SPECTRA),
    CubeKind("moments", 9, 64, atlas=True): (SPECTRA, MOMENTS, BULK),
    CubeKind("moments", 13, 32, atlas=True): (SPECTRA, BULK),
    CubeKind("moments", 17, 32, atlas=True): (SPECTRA, BULK),
    CubeKind("moments", 17, 64, atlas=True): (SPECTRA, BULK),
    CubeKind("moments", 9, 8): (SPECTRA, MOMENTS, REFINED, BULK),
    CubeKind("moments", 9, 16): (SPECTRA, MOMENTS, BULK),
    CubeKind("moments", 9, 32): (*BOTH, BULK, C_MOMENTS, C_SPECTRA),
    CubeKind("moments", 9, 64): (SPECTRA, MOMENTS, NEAREST, BULK),
    CubeKind("sigmoid", 3, 32, atlas=True): (SPECTRA,),
    CubeKind("sigmoid", 3, 8): (SPECTRA, MOMENTS, REFINED),
    CubeKind("sigmoid", 3, 16): (SPECTRA, MOMENTS),
    CubeKind("sigmoid", 3, 32): (*BOTH, C_MOMENTS, C_SPECTRA),
    CubeKind("sigmoid", 3, 64): (SPECTRA, MOMENTS, C_MOMENTS),
}
"""Kinds of cubes and their lookups."""
METHODS: list[Method] = []
for _kind, _lookups in JOBS.items():
    METHODS += [lookup.of(_kind) for lookup in _lookups]
