"""Times of builds, processes, `uplift.bulk` and the exported C header, for
docs/speed.md.

Results are checked before they are timed.
"""

import shlex
import shutil
import subprocess
import sys
import tempfile
from functools import partial
from itertools import product, starmap
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import MACBETH, ROOT, Row, record
from uplift.lab.timing import TimingStats, time_calls, time_process, timing_stats

BIN = Path(sys.executable).parent
UPLIFT = str(BIN / "uplift")
UPLIFT_COMMANDS = ("uplift query '#cc3319' --format json", "uplift --help")
RUNS = 5
FEW_RUNS = 3
"""Runs of large lattices, which take long and vary little."""
MODELS = (("sigmoid", 3), *(("moments", count) for count in (3, 5, 9, 13, 17)))
DIMS = (16, 32, 64, 128)
MODEL_DIM = 64
MIXTURE_DIM = 32
MIXTURES = (24, 396, 10_000)
WAVELENGTHS = np.linspace(400, 700, 16)
BULK = 1_000_000
"""Colours of `uplift.bulk`."""
MAX_ERROR = 1e-6
"""Its largest permitted difference of reflectance."""
CHECKED = 10_000
FLAGS = ("-O3", "-march=x86-64-v3", "-fno-math-errno", "-fno-trapping-math")
MODES = ("spectra", "moments")


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
        models=[time_build(*model, MODEL_DIM, FEW_RUNS) for model in MODELS],
        processes=processes,
        bulk=time_bulk(cube),
    )
    record("performance", "atlases", dim=MIXTURE_DIM, rows=map(time_atlas, MIXTURES))
    if compiler := shutil.which("cc"):
        version = subprocess.check_output([compiler, "--version"], text=True)
        rgb = np.random.default_rng(1).random((400_000, 3))
        timed = partial(time_header, rgb.astype(np.float32))
        cubes = (cube, _build(dim=32, model="sigmoid"))
        record(
            "performance",
            "programs",
            runs=RUNS,
            colours=len(rgb),
            compiler=version.splitlines()[0],
            flags=" ".join(FLAGS),
            rows=starmap(timed, product(MODES, cubes)),
        )


def _build(**options: Any) -> Any:
    import uplift

    return uplift.build(MACBETH, **options)


def time_build(model: str, count: int, dim: int, runs: int) -> Row:
    """Time builds in this process, which has compiled."""
    build = partial(_build, dim=dim, model=model, coefficients=count)
    points = build().data.points
    if unfitted := points.counts()["unfitted"]:
        raise RuntimeError(f"{unfitted} nodes are unfitted: nothing to time")
    wall, cpu = time_calls(build, runs)
    return {
        "model": model,
        "coefficients": count,
        "dim": dim,
        "nodes": dim**3,
        "wall_s": wall,
        "whole_us": cpu.scaled(1e6 / dim**3),
        "worst": points.distance.max(),
    }


def time_atlas(count: int) -> Row:
    """Time a build from arithmetic or geometric means of shipped spectra."""
    import uplift
    from benchmarks.materials import SENSOR, materials
    from uplift.atlas import Atlas, Entry, shipped_atlases

    known = np.concatenate(
        [materials(atlas.path.stem).measured for atlas in shipped_atlases()]
    )
    random = np.random.default_rng(1)
    entries = []
    for number in range(count):
        spectra = known[random.integers(0, len(known), random.integers(2, 4))]
        is_geometric = random.random() < 0.5
        weights = random.dirichlet(np.full(len(spectra), 0.6))
        if is_geometric:
            mixed = np.exp(weights @ np.log(spectra + 1e-3))
        else:
            mixed = weights @ spectra
        entries.append(Entry(str(number), SENSOR.wavelengths, np.clip(mixed, 0, 1)))
    build = partial(uplift.build, Atlas(tuple(entries)), dim=MIXTURE_DIM)
    _, cpu = time_calls(build, 1)
    return {"entries": count, "cpu_s": cpu.median}


def time_processes() -> list[Row]:
    """Time commands as a user starts them: wall seconds and peak memory in MB."""
    rows = []

    def add(what: str, wall: TimingStats, megabytes: float) -> None:
        rows.append({"what": what, "wall": wall, "megabytes": megabytes})

    with tempfile.TemporaryDirectory() as folder:
        build = [UPLIFT, "build", "--force", "-q", "--atlas", str(MACBETH)]
        build += ["-o", f"{folder}/cube.uplift", "--dim"]
        uncached = {"JAX_ENABLE_COMPILATION_CACHE": "false"}
        times = time_process([*build, "32"], RUNS, uncached)
        add("uplift build --dim 32, compilation cache disabled", *times)
        for dim in DIMS:
            command = [*build, str(dim)]
            walls = []
            peaks = []
            for run in range(RUNS if dim < max(DIMS) else 1):
                cache = {"JAX_COMPILATION_CACHE_DIR": f"{folder}/cache-{dim}-{run}"}
                wall, peak = time_process(command, 1, cache)
                walls.append(wall.median)
                peaks.append(peak)
            what = f"uplift build --dim {dim}"
            add(f"{what}, first run", timing_stats(walls), max(peaks))
            times = time_process(command, len(walls), cache)
            add(f"{what}, compiled before", *times)
    for line in ("python -c 'import numpy'", *UPLIFT_COMMANDS):
        program, *arguments = shlex.split(line)
        command = [f"{BIN}/{program}", *arguments]
        add(line, *time_process(command, 2 * RUNS))
    return rows


def time_bulk(cube: Any) -> list[Row]:
    """Time spectra of random colours by JAX, on one thread and on two."""
    from uplift.lookup import bulk

    rgb = np.random.default_rng(1).random((BULK, 3))
    expected = cube.reflectance(rgb, WAVELENGTHS)
    rows = []
    for threads in (1, 2):
        sample = bulk.spectra(cube, WAVELENGTHS, threads=threads)
        error = np.abs(sample(rgb) - expected).max()
        if not error <= MAX_ERROR:
            raise RuntimeError(f"error {error} exceeds {MAX_ERROR}: nothing to time")
        wall, cpu = time_calls(partial(sample, rgb), RUNS)
        rows.append(
            {
                "threads": threads,
                "colours": BULK,
                "wall_s": wall,
                "million_per_s": BULK / wall.median / 1e6,
                "cpu_us": 1e6 * cpu.median / BULK,
                "error": error,
            }
        )
    return rows


def time_header(colours: Any, mode: str, cube: Any) -> Row:
    """Compile the C header, check its reflectances, and return its rates on one core,
    in million colours per second.
    """
    from uplift.colorimetry import delta_e_rgb

    data = cube.data
    spectra, times = run_header(cube, mode, colours, RUNS)
    checked = colours[:CHECKED].astype(float)
    expected = cube.reflectance(checked, cube.wavelengths, mode=mode)
    worst = np.abs(spectra - expected).max()
    if not worst <= 1e-3:
        raise RuntimeError(f"{mode}: reflectances differ by {worst}: nothing to time")
    errors = delta_e_rgb(data.sensor, data.sensor.rgb(spectra), checked)
    rates = [len(colours) / seconds / 1e6 for seconds in times]
    return {
        "model": data.model.name,
        "coefficients": data.model.count,
        "mode": mode,
        **dict(zip(("lookup", "many", "evaluation", "shared"), rates, strict=True)),
        "worst": worst,
        "mean_delta_e": errors.mean(),
        "max_delta_e": errors.max(),
    }


def run_header(
    cube: Any, mode: str, colours: Any, runs: int
) -> tuple[Any, list[float]]:
    """Return reflectances (CHECKED, N) of the first colours by the C header, and CPU
    seconds.
    """
    from uplift.extras.export import write_program

    source = ROOT / "benchmarks" / "rates.c"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_program(cube.data, folder / "cube.h", mode=mode)
        colours.tofile(folder / "rgb")
        cube.wavelengths.astype(np.float32).tofile(folder / "at")
        compiler = ["cc", *FLAGS, "-I.", str(source), "-o", "rates", "-lm"]
        subprocess.run(compiler, cwd=folder, check=True)
        command = ["./rates", "rgb", "at", str(runs), "spectra"]
        printed = subprocess.check_output(command, cwd=folder, text=True)
        spectra = np.fromfile(folder / "spectra", np.float32).astype(float)
    return spectra.reshape(CHECKED, -1), list(map(float, printed.split()[:-1]))
