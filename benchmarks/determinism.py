"""Reproducibility of builds, for docs/stability.md.

Threads, cores, devices and batch sizes must not change a byte. Instruction sets must not change the nodes of the
lattice. They may change spectra; the largest difference is what `uplift check` has to allow between machines
(`uplift.report.regression`).
"""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import groupby
from pathlib import Path
from typing import Any

import click
import numpy as np

import uplift
from benchmarks import ATLASES, ROOT, record
from uplift.atlas import Atlas
from uplift.report.regression import LIMITS, compare_rebuilt

Row = dict[str, Any]
CASES: dict[str, dict[str, object]] = {
    "moments, Macbeth, 16³": {"atlas": ("macbeth",), "dim": 16},
    "sigmoid, Macbeth, 16³": {"atlas": ("macbeth",), "dim": 16, "model": "sigmoid"},
    "17 coefficients, four atlases, 12³": {
        "atlas": ("babelcolor", "cie2017", "pmc", "vs"),
        "dim": 12,
        "coefficients": 17,
    },
    "ProPhoto RGB, Macbeth, 12³": {"atlas": ("macbeth",), "dim": 12, "space": "ProPhoto RGB"},
}


@dataclass(frozen=True)
class Setting:
    """Environment variables of a process, a command prefix, and rows of a batch."""

    name: str
    environment: dict[str, str] = field(default_factory=dict)
    prefix: tuple[str, ...] = ()
    batch: tuple[int, ...] = ()


DEFAULT = Setting("default")
SAME = (
    Setting("again"),
    Setting("one core", prefix=("taskset", "-c", "0")),
    Setting("1 thread of BLAS", {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}),
    Setting("2 threads of BLAS", {"OPENBLAS_NUM_THREADS": "2", "OMP_NUM_THREADS": "2"}),
    Setting("8 threads of BLAS", {"OPENBLAS_NUM_THREADS": "8"}),
    Setting("1 thread of XLA", {"NPROC": "1"}),
    Setting("16 threads of XLA", {"NPROC": "16"}),
    Setting("no threads in a product of XLA", {"XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false"}),
    Setting("3 devices", {"XLA_FLAGS": "--xla_force_host_platform_device_count=3"}),
    Setting("batches of 1024 and 64", batch=(1024, 64)),
    Setting("batches of 4000 and 100", batch=(4000, 100)),
)
NUMPY_SSE4 = {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR"}
"""numpy at its baseline. A feature is disabled by its own name only, those above it must be named too."""
NUMPY_AVX2 = {"NPY_DISABLE_CPU_FEATURES": "X86_V4 AVX512_ICL AVX512_SPR"}
WITHOUT_AVX512 = NUMPY_AVX2 | {"XLA_FLAGS": "--xla_cpu_max_isa=AVX2", "OPENBLAS_CORETYPE": "Haswell"}
"""Environment of a process that computes as on a CPU with AVX2 and without AVX-512."""
APART = (
    Setting("numpy without AVX-512", NUMPY_AVX2),
    Setting("numpy without AVX2", NUMPY_SSE4),
    Setting("XLA with AVX2", {"XLA_FLAGS": "--xla_cpu_max_isa=AVX2"}),
    Setting("XLA with AVX", {"XLA_FLAGS": "--xla_cpu_max_isa=AVX"}),
    Setting("XLA with SSE 4.2", {"XLA_FLAGS": "--xla_cpu_max_isa=SSE4_2"}),
    Setting("BLAS for Haswell (AVX2)", {"OPENBLAS_CORETYPE": "Haswell"}),
    Setting("BLAS for Sandy Bridge (AVX)", {"OPENBLAS_CORETYPE": "Sandybridge"}),
    Setting("BLAS for Nehalem (SSE 4.2)", {"OPENBLAS_CORETYPE": "Nehalem"}),
    Setting("all three without AVX-512", WITHOUT_AVX512),
    Setting(
        "all three without AVX",
        NUMPY_SSE4 | {"XLA_FLAGS": "--xla_cpu_max_isa=SSE4_2", "OPENBLAS_CORETYPE": "Nehalem"},
    ),
)


@click.command()
@click.option("--into", metavar="FOLDER", help="Build the cubes into a folder, and compare nothing.")
@click.option("--batch", nargs=2, type=int, help="Rows of a large and of a small batch.")
def main(into: str | None, batch: tuple[int, int] | None) -> None:
    """Build under all settings and compare."""
    if into is not None:
        _build(Path(into), batch)
        return
    with tempfile.TemporaryDirectory() as folder:
        base = _run(DEFAULT, Path(folder) / "base")
        same = [row for setting in SAME for row in _rows(setting, base, Path(folder) / setting.name)]
        apart = [row for setting in APART for row in _rows(setting, base, Path(folder) / setting.name)]
    worst = {name: max(row["measures"][name] for row in apart) for name in LIMITS}
    record(
        "determinism",
        "stability-determinism",
        cubes=list(CASES),
        same=[
            {"setting": name, "cubes": len(rows), "different": sum(not row["same_bytes"] for row in rows)}
            for name, rows in _by_setting(same)
        ],
        apart=[
            {
                "setting": name,
                "different_nodes": sum(not row["nodes_same"] for row in rows),
                "measures": {one: max(row["measures"][one] for row in rows) for one in LIMITS},
                "status_changes": sum(not row["status_same"] for row in rows),
            }
            for name, rows in _by_setting(apart)
        ],
        limits=dict(LIMITS),
    )
    different = [row for row in same if not row["same_bytes"]] + [row for row in apart if not row["nodes_same"]]
    click.echo(
        f"{len(same)} builds must have the same bytes, {len(apart)} others the same nodes; failures: {different}"
    )
    click.echo(f"across instruction sets at most {worst}")
    raise SystemExit(bool(different))


def _by_setting(rows: list[Row]) -> Iterator[tuple[str, list[Row]]]:
    for name, group in groupby(rows, key=lambda row: row["setting"]):
        yield name, list(group)


def _build(folder: Path, batch: tuple[int, int] | None) -> None:
    from uplift.fit import batch as batches

    warnings.simplefilter("ignore", uplift.UpliftWarning)
    if batch:
        batches.CPU_BATCH_ROWS = batch
    for number, options in enumerate(CASES.values()):
        chosen = {key: value for key, value in options.items() if key != "atlas"}
        cube = uplift.build(_atlas(options["atlas"]), **chosen)
        cube.save(folder / f"{number}.uplift")


def _atlas(names: object) -> Atlas:
    """Merge atlases; entry names get the atlas as prefix."""
    entries = []
    for name in names:
        entries += [
            dataclasses.replace(entry, name=f"{name} {entry.name}")
            for entry in uplift.read_atlas(ATLASES / f"{name}.txt").entries
        ]
    return Atlas(tuple(entries))


def _run(setting: Setting, folder: Path) -> Path:
    folder.mkdir()
    command = [*setting.prefix, sys.executable, "-m", "benchmarks.determinism", "--into", str(folder)]
    if setting.batch:
        command += ["--batch", *map(str, setting.batch)]
    compiled = {"JAX_ENABLE_COMPILATION_CACHE": "false"}  # no code compiled under another setting
    subprocess.run(command, env=os.environ | compiled | setting.environment, cwd=ROOT, check=True)
    return folder


def _rows(setting: Setting, base: Path, folder: Path) -> list[Row]:
    _run(setting, folder)
    rows = []
    for number, case in enumerate(CASES):
        one, other = base / f"{number}.uplift", folder / f"{number}.uplift"
        first, second = uplift.load(one).data, uplift.load(other).data
        comparison = compare_rebuilt(other, first, second)
        rows.append(
            {
                "setting": setting.name,
                "cube": case,
                "same_bytes": one.read_bytes() == other.read_bytes(),
                "nodes_same": np.array_equal(first.lattice.nodes, second.lattice.nodes),
                "measures": comparison.measures,
                "status_same": comparison.stored_counts == comparison.rebuilt_counts,
            }
        )
    return rows


if __name__ == "__main__":
    main()
