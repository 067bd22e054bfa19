"""Reproducibility of builds, for docs/stability.md.

Threads, cores and devices must not change a byte. Instruction sets must not change
where the nodes lie. They may change spectra; the largest difference is what `uplift
check` has to allow between machines (`uplift.extras.report.regression`).
"""

import os
import shlex
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import uplift
from benchmarks import ROOT, Row
from uplift.extras.report.regression import compare_rebuilt

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
NUMPY_SSE4 = "env NPY_DISABLE_CPU_FEATURES='X86_V3 X86_V4 AVX512_ICL AVX512_SPR'"
"""numpy at its baseline. A feature is disabled by its own name only, those above it
must be named too.
"""
NUMPY_AVX2 = "env NPY_DISABLE_CPU_FEATURES='X86_V4 AVX512_ICL AVX512_SPR'"
XLA_SSE4 = "env XLA_FLAGS=--xla_cpu_max_isa=SSE4_2"
XLA_AVX2 = "env XLA_FLAGS=--xla_cpu_max_isa=AVX2"
BLAS_SSE4 = "env OPENBLAS_CORETYPE=Nehalem"
THREADS = {
    "again": "",
    "one core": "taskset -c 0",
    "1 thread of BLAS": "env OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1",
    "8 threads of BLAS": "env OPENBLAS_NUM_THREADS=8",
    "1 thread of XLA": "env NPROC=1",
    "16 threads of XLA": "env NPROC=16",
    "3 devices": "env XLA_FLAGS=--xla_force_host_platform_device_count=3",
}
"""Commands that set what must not change a byte."""
INSTRUCTIONS = {
    "numpy without AVX2": NUMPY_SSE4,
    "XLA with SSE 4.2": XLA_SSE4,
    "BLAS for Sandy Bridge (AVX)": "env OPENBLAS_CORETYPE=Sandybridge",
    "BLAS for Nehalem (SSE 4.2)": BLAS_SSE4,
    "all three without AVX-512": (
        f"{NUMPY_AVX2} {XLA_AVX2} env OPENBLAS_CORETYPE=Haswell"
    ),
    "all three without AVX": f"{NUMPY_SSE4} {XLA_SSE4} {BLAS_SSE4}",
}
"""Commands that set what must not change where the nodes lie."""
BUILD = (
    "import sys; from benchmarks.determinism import build_cubes; "
    "build_cubes(sys.argv[1])"
)


def build_cubes(folder: str) -> None:
    """Build the cubes of all cases."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    for name, (atlases, options) in CASES.items():
        cube = uplift.build(uplift.read_atlas(*atlases), **options)
        cube.save(f"{folder}/{name}.uplift")


def build_under(setting: str, command: str, folder: Path) -> Path:
    """Build the cubes in a process with a setting; return their folder."""
    into = folder / setting
    into.mkdir()
    words = [*shlex.split(command), sys.executable, "-c", BUILD, str(into)]
    # Code that was compiled under another setting must not be used.
    uncached = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
    subprocess.run(words, env=os.environ | uncached, cwd=ROOT, check=True)
    return into


def compare_settings(settings: dict[str, str]) -> list[Row]:
    """Compare the cubes of every setting with the default ones."""
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        default = build_under("default", "", folder)
        for setting, command in settings.items():
            other = build_under(setting, command, folder)
            for cube in CASES:
                head = {"setting": setting, "cube": cube}
                files = [into / f"{cube}.uplift" for into in (default, other)]
                rows.append(head | compare_files(*files))
    return rows


def compare_files(first: Path, second: Path) -> Row:
    """Compare bytes, nodes, and what `uplift check` limits."""
    cubes = [uplift.load(path).data for path in (first, second)]
    nodes = [cube.lattice.nodes for cube in cubes]
    return {
        "different": first.read_bytes() != second.read_bytes(),
        "different_nodes": not np.array_equal(*nodes),
        **compare_rebuilt(second, *cubes).measures,
    }


QUESTIONS = {
    "threads": lambda: compare_settings(THREADS),
    "instructions": lambda: compare_settings(INSTRUCTIONS),
}
