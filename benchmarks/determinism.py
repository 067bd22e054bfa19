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
from operator import itemgetter
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ROOT, Row, record
from uplift.atlas import Atlas
from uplift.extras.report.regression import LIMITS, compare_rebuilt

Variables = dict[str, str]
CASES = {
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
XLA_SSE4 = {"XLA_FLAGS": "--xla_cpu_max_isa=SSE4_2"}
XLA_AVX2 = {"XLA_FLAGS": "--xla_cpu_max_isa=AVX2"}
BLAS_SSE4 = {"OPENBLAS_CORETYPE": "Nehalem"}
BLAS_AVX2 = {"OPENBLAS_CORETYPE": "Haswell"}
WITHOUT_AVX512 = NUMPY_AVX2 | XLA_AVX2 | BLAS_AVX2
"""Environment of a process that computes as on a CPU with AVX2 and without AVX-512."""
SAME = {
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
APART = {
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
        same = [measure(*setting, folder) for setting in SAME.items()]
        apart = [measure(*setting, folder) for setting in APART.items()]
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
        entries = []
        for name in names:
            entries += [
                replace(entry, name=f"{name} {entry.name}")
                for entry in uplift.read_atlas(name)
            ]
        uplift.build(Atlas(tuple(entries)), **options).save(f"{folder}/{number}.uplift")


def run(name: str, variables: Variables, folder: Path) -> Path:
    """Build the cubes in a process with a setting, into a folder of its name."""
    into = folder / name
    into.mkdir()
    command = [*PREFIXES.get(name, ()), sys.executable, "-c", BUILD, str(into)]
    # Code that was compiled under another setting must not be used.
    uncached = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
    subprocess.run(command, env=os.environ | uncached | variables, cwd=ROOT, check=True)
    return into


def measure(name: str, variables: Variables, folder: Path) -> Row:
    """Build the cubes under a setting, and compare them with the default ones."""
    into = run(name, variables, folder)
    different = 0
    different_nodes = 0
    measures = []
    for number in range(len(CASES)):
        file = f"{number}.uplift"
        first = folder / "default" / file
        second = into / file
        different += first.read_bytes() != second.read_bytes()
        cubes = [uplift.load(path).data for path in (first, second)]
        different_nodes += not np.array_equal(*(cube.lattice.nodes for cube in cubes))
        measures.append(compare_rebuilt(second, *cubes).measures)
    return {
        "setting": name,
        "cubes": len(CASES),
        "different": different,
        "different_nodes": different_nodes,
        "measures": {limit: max(map(itemgetter(limit), measures)) for limit in LIMITS},
    }
