"""Reproducibility of builds, for docs/stability.md.

Threads, cores and devices must not change a byte. Instruction sets must not change
where the nodes lie. They may change spectra; the largest difference is what `uplift
check` has to allow between machines (`uplift.extras.report.regression`).
"""

import os
import subprocess
import sys
import tempfile
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ROOT, Row, record
from uplift.atlas import Atlas
from uplift.extras.report.regression import LIMITS, compare_rebuilt

CASES: dict[str, tuple[tuple[str, ...], Row]] = {
    "moments, Macbeth, 16³": (("macbeth",), {"dim": 16}),
    "sigmoid, Macbeth, 16³": (("macbeth",), {"dim": 16, "model": "sigmoid"}),
    "17 coefficients, four atlases, 12³": (
        ("babelcolor", "cie2017", "pmc", "vs"),
        {"dim": 12, "coefficients": 17},
    ),
    "ProPhoto RGB, Macbeth, 12³": (("macbeth",), {"dim": 12, "space": "ProPhoto RGB"}),
}
"""Atlases and options of the cubes."""
NUMPY_SSE4 = {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR"}
"""numpy at its baseline. A feature is disabled by its own name only, those above it
must be named too.
"""
NUMPY_AVX2 = {"NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR"}
XLA_SSE4, XLA_AVX2 = (
    {"XLA_FLAGS": f"--xla_cpu_max_isa={name}"} for name in ("SSE4_2", "AVX2")
)
BLAS_SSE4, BLAS_AVX2 = ({"OPENBLAS_CORETYPE": name} for name in ("Nehalem", "Haswell"))
WITHOUT_AVX512 = NUMPY_AVX2 | XLA_AVX2 | BLAS_AVX2
"""Environment of a process that computes as on a CPU with AVX2 and without AVX-512."""
SAME: dict[str, dict[str, str]] = {
    "again": {},
    "one core": {},
    "1 thread of BLAS": {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
    "2 threads of BLAS": {"OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"},
    "8 threads of BLAS": {"OPENBLAS_NUM_THREADS": "8"},
    "1 thread of XLA": {"NPROC": "1"},
    "16 threads of XLA": {"NPROC": "16"},
    "no threads in a product of XLA": {
        "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false"
    },
    "3 devices": {"XLA_FLAGS": "--xla_force_host_platform_device_count=3"},
}
"""Environment variables of settings that must not change a byte."""
APART: dict[str, dict[str, str]] = {
    "numpy without AVX-512": NUMPY_AVX2,
    "numpy without AVX2": NUMPY_SSE4,
    "XLA with AVX2": XLA_AVX2,
    "XLA with AVX": {"XLA_FLAGS": "--xla_cpu_max_isa=AVX"},
    "XLA with SSE 4.2": XLA_SSE4,
    "BLAS for Haswell (AVX2)": BLAS_AVX2,
    "BLAS for Sandy Bridge (AVX)": {"OPENBLAS_CORETYPE": "Sandybridge"},
    "BLAS for Nehalem (SSE 4.2)": BLAS_SSE4,
    "all three without AVX-512": WITHOUT_AVX512,
    "all three without AVX": NUMPY_SSE4 | XLA_SSE4 | BLAS_SSE4,
}
"""Environment variables of settings that must not change where the nodes lie."""
PREFIXES = {"one core": ("taskset", "-c", "0")}
"""Commands before that of a setting."""


BUILD = (
    "import sys; from benchmarks.determinism import build_cubes; "
    "build_cubes(sys.argv[1])"
)


def main() -> None:
    """Build under all settings and compare."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("default", {}, folder)
        same, apart = (
            [measure(key, each[key], folder) for key in each] for each in (SAME, APART)
        )
    record(
        "determinism",
        "stability-determinism",
        cubes=list(CASES),
        same=same,
        apart=apart,
    )
    failed = [row["setting"] for row in same if row["different"]]
    failed += [row["setting"] for row in apart if row["different_nodes"]]
    print(
        "settings that change bytes, or nodes across instruction sets: "
        f"{', '.join(failed) or 'none'}"
    )
    raise SystemExit(bool(failed))


def build_cubes(folder: str) -> None:
    """Build the cubes of all cases; names of entries get their atlas as prefix."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    for number, (names, options) in enumerate(CASES.values()):
        atlases = [(name, uplift.read_atlas(name)) for name in names]
        entries = [
            replace(each, name=f"{name} {each.name}")
            for name, atlas in atlases
            for each in atlas.entries
        ]
        uplift.build(Atlas(tuple(entries)), **options).save(f"{folder}/{number}.uplift")


def run(name: str, variables: dict[str, str], folder: Path) -> Path:
    """Build the cubes in a process with a setting, into a folder of its name."""
    into = folder / name
    into.mkdir()
    command = [*PREFIXES.get(name, ()), sys.executable, "-c", BUILD, str(into)]
    compiled = {
        "JAX_ENABLE_COMPILATION_CACHE": "false"
    }  # no code compiled under another setting
    subprocess.run(command, env=os.environ | compiled | variables, cwd=ROOT, check=True)
    return into


def measure(name: str, variables: dict[str, str], folder: Path) -> Row:
    """Build the cubes under a setting, and compare them with those of the
    default one.
    """
    into = run(name, variables, folder)
    files = [
        (folder / "default" / f"{number}.uplift", into / f"{number}.uplift")
        for number in range(len(CASES))
    ]
    cubes = [
        (uplift.load(first).data, uplift.load(second).data) for first, second in files
    ]
    found = [
        compare_rebuilt(file, *pair)
        for (_, file), pair in zip(files, cubes, strict=True)
    ]
    return {
        "setting": name,
        "cubes": len(files),
        "different": sum(
            first.read_bytes() != second.read_bytes() for first, second in files
        ),
        "different_nodes": sum(
            not np.array_equal(one.lattice.nodes, other.lattice.nodes)
            for one, other in cubes
        ),
        "measures": {
            limit: max(each.measures[limit] for each in found) for limit in LIMITS
        },
    }
