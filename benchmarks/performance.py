"""Times of builds, processes, `uplift.bulk` and the exported C header, for
docs/speed.md.

Results are checked before they are timed.
"""

import shutil
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import MACBETH, ROOT, Row, record
from uplift.lab.timing import time_calls, time_process, timing_stats

UPLIFT = str(Path(sys.executable).parent / "uplift")
RUNS, FEW_RUNS = 5, 3
"""Runs, and those of large lattices, which take long and vary little."""
MODELS = (("sigmoid", 3), *(("moments", count) for count in (3, 5, 9, 13, 17)))
DIMS = (16, 32, 64, 128)
MODEL_DIM = 64
MIXTURE_DIM = 32
MIXTURES = (24, 396, 10_000)
WAVELENGTHS = np.linspace(400, 700, 16)
BULK, MAX_ERROR = 1_000_000, 1e-6
"""Colours of `uplift.bulk`, and its largest permitted difference of reflectance."""
CHECKED = 10_000
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math")
MODES = ("spectra", "moments")
PROGRAM_COLOURS, MAX_DIFFERENCE = 400_000, 1e-3
"""Colours of the C header, and the largest permitted difference of reflectance."""


def main() -> None:
    """Time everything and store."""
    # First: a process started from a large one counts the memory of its parent as its
    # own.
    processes = time_processes()
    cube = _build(dim=32)
    record(
        "performance",
        runs=RUNS,
        dims=[
            time_build("moments", 9, dim, RUNS if dim <= MODEL_DIM else FEW_RUNS)
            for dim in DIMS
        ],
        models=[
            time_build(model, count, MODEL_DIM, FEW_RUNS) for model, count in MODELS
        ],
        processes=processes,
        bulk=time_bulk(cube),
    )
    record(
        "performance",
        "atlases",
        dim=MIXTURE_DIM,
        rows=[time_atlas(count) for count in MIXTURES],
    )
    if compiler := shutil.which("cc"):
        version = subprocess.run(
            [compiler, "--version"], capture_output=True, text=True, check=True
        ).stdout
        colours = (
            np.random.default_rng(1).random((PROGRAM_COLOURS, 3)).astype(np.float32)
        )
        cubes = (cube, _build(dim=32, model="sigmoid"))
        record(
            "performance",
            "programs",
            runs=RUNS,
            colours=len(colours),
            compiler=version.splitlines()[0],
            flags=" ".join(FLAGS),
            rows=[time_header(each, mode, colours) for mode in MODES for each in cubes],
        )


def _build(**options: Any) -> Any:
    import uplift

    return uplift.build(MACBETH, **options)


def time_build(model: str, count: int, dim: int, runs: int) -> Row:
    """Time builds in this process, which has compiled."""
    build = partial(_build, dim=dim, model=model, coefficients=count)
    data = build().data
    unfitted = data.points.counts()["unfitted"]
    worst = float(data.points.distance.max())
    if unfitted:
        raise RuntimeError(f"{unfitted} nodes are unfitted: nothing to time")
    wall, cpu = time_calls(build, runs)
    return {
        "model": model,
        "coefficients": count,
        "dim": dim,
        "nodes": dim**3,
        "wall_s": wall,
        "whole_us": cpu.scaled(1e6 / dim**3),
        "worst": worst,
    }


def time_atlas(count: int) -> Row:
    """Time a build from mixtures of shipped spectra: arithmetic or geometric means of
    two or three.
    """
    import uplift
    from benchmarks.materials import SENSOR, materials
    from uplift.atlas import Atlas, Entry, shipped_atlases

    known = np.concatenate(
        [materials(each.path.stem).measured for each in shipped_atlases()]
    )
    random = np.random.default_rng(1)
    entries = []
    for number in range(count):
        rows = random.integers(0, len(known), random.integers(2, 4))
        logarithmic = random.random() < 0.5
        weights = random.dirichlet(np.full(len(rows), 0.6))
        mixed = (
            np.exp(weights @ np.log(known[rows] + 1e-3))
            if logarithmic
            else weights @ known[rows]
        )
        entries.append(Entry(str(number), SENSOR.wavelengths, np.clip(mixed, 0, 1)))
    _, cpu = time_calls(
        partial(uplift.build, Atlas(tuple(entries)), dim=MIXTURE_DIM), 1
    )
    return {"entries": count, "cpu_s": cpu.median}


def time_processes() -> list[Row]:
    """Time commands as a user starts them: wall seconds and peak memory in MB."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for dim in DIMS:
            command = [
                UPLIFT,
                "build",
                "--atlas",
                str(MACBETH),
                "--dim",
                str(dim),
                "-o",
                f"{folder}/{dim}.uplift",
            ]
            command += ["--force", "-q"]
            if dim == 32:
                uncached = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
                what = f"uplift build --dim {dim}, compilation cache disabled"
                rows.insert(0, (what, *time_process(command, RUNS, uncached)))
            runs = RUNS if dim < max(DIMS) else 1
            caches = [
                {"JAX_COMPILATION_CACHE_DIR": f"{folder}/cache-{dim}-{run}"}
                for run in range(runs)
            ]
            walls, peaks = zip(
                *(time_process(command, 1, cache) for cache in caches), strict=True
            )
            rows.append(
                (
                    f"uplift build --dim {dim}, first run",
                    timing_stats([wall.median for wall in walls]),
                    max(peaks),
                )
            )
            what = f"uplift build --dim {dim}, compiled before"
            rows.append((what, *time_process(command, runs, caches[0])))
    starts = {
        "python -c 'import numpy'": [sys.executable, "-c", "import numpy"],
        "uplift query '#cc3319' --format json": [
            UPLIFT,
            "query",
            "#cc3319",
            "--format",
            "json",
        ],
        "uplift --help": [UPLIFT, "--help"],
    }
    rows += [
        (what, *time_process(command, 2 * RUNS)) for what, command in starts.items()
    ]
    return [
        {"what": what, "wall": wall, "megabytes": megabytes}
        for what, wall, megabytes in rows
    ]


def time_bulk(cube: Any) -> list[Row]:
    """Time spectra of random colours by JAX, on one thread and on two."""
    from uplift.lookup import bulk

    rgb = np.random.default_rng(1).random((BULK, 3))
    expected = cube.reflectance(rgb, WAVELENGTHS)
    rows = []
    for threads in (1, 2):
        sample = bulk.spectra(cube, WAVELENGTHS, threads=threads)
        error = float(np.abs(sample(rgb) - expected).max())
        if not error <= MAX_ERROR:
            raise RuntimeError(f"error {error} exceeds {MAX_ERROR}: nothing to time")
        wall, cpu = time_calls(partial(sample, rgb), RUNS)
        rates = {
            "million_per_s": BULK / wall.median / 1e6,
            "cpu_us": 1e6 * cpu.median / BULK,
        }
        rows.append(
            {
                "threads": threads,
                "colours": BULK,
                "wall_s": wall,
                **rates,
                "error": error,
            }
        )
    return rows


def time_header(cube: Any, mode: str, colours: Any) -> Row:
    """Compile the C header, check its reflectances, and return its rates on one core,
    in million colours per second.
    """
    from uplift.colorimetry import delta_e_rgb

    data = cube.data
    found, rates = run_header(cube, mode, colours, RUNS)
    checked = colours[:CHECKED].astype(float)
    worst = float(
        np.abs(found - cube.reflectance(checked, cube.wavelengths, mode=mode)).max()
    )
    if not worst <= MAX_DIFFERENCE:
        raise RuntimeError(f"{mode}: reflectances differ by {worst}: nothing to time")
    errors = delta_e_rgb(data.sensor, data.sensor.rgb(found), checked)
    rates = [len(colours) / seconds / 1e6 for seconds in rates]
    return {
        "model": data.model.name,
        "coefficients": data.model.count,
        "mode": mode,
        **dict(zip(("lookup", "many", "evaluation", "shared"), rates, strict=True)),
        "worst": worst,
        "mean_delta_e": float(errors.mean()),
        "max_delta_e": float(errors.max()),
    }


def run_header(
    cube: Any, mode: str, colours: Any, runs: int
) -> tuple[Any, list[float]]:
    """Return reflectances (CHECKED, N) of the first colours by the C header, and the
    CPU seconds of its functions.
    """
    from uplift.extras.export import write_program

    source = ROOT / "benchmarks" / "rates.c"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(cube.data, folder / "cube.h", mode=mode)
        colours.tofile(folder / "rgb")
        cube.wavelengths.astype(np.float32).tofile(folder / "at")
        subprocess.run(
            ["cc", *FLAGS, "-I.", str(source), "-o", "rates", "-lm"],
            cwd=folder,
            check=True,
        )
        command = ["./rates", "rgb", "at", str(runs), "found"]
        done = subprocess.run(
            command, cwd=folder, check=True, capture_output=True, text=True
        )
        found = (
            np.fromfile(folder / "found", np.float32).reshape(CHECKED, -1).astype(float)
        )
    return found, [float(word) for word in done.stdout.split()[:-1]]
