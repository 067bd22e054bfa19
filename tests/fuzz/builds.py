"""Odd builds, and the laws that cubes keep: a linear program judges which colours a reflectance has."""

import json
import shutil
import subprocess
import sys
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner
from scipy.optimize import linprog
from uplift_cli.main import main

import uplift
from tests.fuzz.fuzzing import Random, choose
from uplift.atlas.sources import write_atlas
from uplift.common.errors import UpliftWarning
from uplift.cube import digest
from uplift.io import texture
from uplift.io.export import rounding_error, write_program
from uplift.lookup import MODES

SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB", "ACES2065-1", "Adobe RGB (1998)", "camera")
OBSERVERS = ("CIE 1931 2 Degree Standard Observer", "CIE 1964 10 Degree Standard Observer")
CAMERAS = ("Nikon 5100 (NPL)", "Sigma SDMerill (NPL)")
SHAPES = ("smooth", "equal", "dark", "black", "white", "spiky")
EXACT, SAME, DEEP, SUM = 1e-4, 1e-3, 1e-4, 2e-6
"""Largest error of a realisable colour, and largest difference of reflectances between languages, of colours that far
inside the solid, with the error of RGB as a sum of some hundred products in single precision. Near the boundary of the
solid spectra are steps, which single precision cannot place: an error d of RGB at the distance h moves a step by about
d / h of its width."""
AT = (385.0, 450.0, 525.0, 600.0, 675.0, 775.0)
PROGRAM = """#include <stdio.h>
#include "cube.h"
int main(void)
{
    float rgb[3], at[6] = {%s}, found[6];
    if (cube_load("cube.bin")) return 1;
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {
        cube_reflectances(rgb, at, 6, found);
        fwrite(found, sizeof found, 1, stdout);
    }
    return 0;
}
"""


def odd_options(random: Random, dims: tuple[int, int]) -> dict[str, Any]:
    """Return options of a build, without atlas, library and looks."""
    space, model = choose(random, SPACES), choose(random, ("moments", "moments", "moments", "sigmoid"))
    counts = choose(random, ((3, 3), (4, 9), (5, 17), (9, 9), (9, 13), (17, 17)))  # few, as each is compiled
    options: dict[str, Any] = {"space": space, "dim": int(random.integers(*dims)), "model": model}
    options["illuminant"] = choose(random, ("D65", "D65", "A", "E", "D50", "FL2", "FL11"))
    options["observer"] = choose(random, CAMERAS if space == "camera" else OBSERVERS)
    ranges = ((380, 780, 5), (380, 780, 10), (360, 830, 5), (320, 900, 10))
    sampled = choose(random, ranges[::2] if space == "camera" else ranges)
    options["shortest"], options["longest"], options["step"] = sampled
    options["axis"], options["warp"] = choose(random, ("srgb", "linear")), choose(random, ("none", "vision"))
    options["prior"] = choose(random, ("learnt", "smooth"))
    if model == "moments":
        options |= {"coefficients": counts[0], "entry_coefficients": counts[1]}
    return options


def odd_atlas(random: Random, size: int) -> uplift.Atlas:
    """Return an atlas of 1, 2 or 300 entries of one shape."""
    shape, at = choose(random, SHAPES), np.arange(380.0, 781.0, 10)
    middle, width, level = random.uniform(380, 780, size), random.uniform(5, 200, size), random.uniform(0.02, 0.9, size)
    values = level[:, None] * np.exp(-(((at - middle[:, None]) / width[:, None]) ** 2)) + 0.02
    if shape == "spiky":
        values = random.uniform(0, 1, values.shape).round()
    elif shape != "smooth":
        values = {"equal": values[:1] + 0 * values, "dark": values / 100, "black": 0 * values, "white": 0 * values + 1}[
            shape
        ]
    return uplift.Atlas([uplift.Entry(f"e{k}", at, row) for k, row in enumerate(values)])


def miss(matrix: np.ndarray, rgb: np.ndarray) -> float:
    """Return the least max |linear RGB| from a colour (3,) that reflectances in [0, 1] have, by a linear program."""
    count, off = matrix.shape[1], np.ones((3, 1))
    rows = np.block([[matrix, -off], [-matrix, -off]])
    cost, limits = np.append(np.zeros(count), 1), [(0, 1)] * count + [(0, None)]
    return float(linprog(cost, A_ub=rows, b_ub=np.concatenate([rgb, -rgb]), bounds=limits, method="highs").fun)


def colours(random: Random, cube: uplift.Cube) -> np.ndarray:
    """Return colours (n, 3) in [0, 1]: random, dark, pure, of entries, and near them."""
    rgb = random.uniform(0, 1, (24, 3))
    rgb[8:12] **= 4
    rgb[12:16, int(random.integers(3))] = random.uniform(0, 0.02)
    rgb[16:20] = rgb[16:20].round()
    own = cube.data.atlas.rgb[:4]
    rgb = np.concatenate([rgb, own, np.clip(own + random.normal(0, 0.02, own.shape), 0, 1)])
    return rgb.astype(np.float32).astype(float)


def broken_laws(seed: int, folder: Path, dims: tuple[int, int] = (2, 13)) -> Iterator[str]:
    """Build a cube by a seed, and yield the laws that it breaks."""
    random = np.random.default_rng(seed)
    options = odd_options(random, dims)
    size = choose(random, (0, 0, 1, 2, 300 if dims[1] > 8 else 30))
    atlas = library = None
    if size:
        atlas = folder / "atlas.csv"
        write_atlas(odd_atlas(random, size), atlas)
    if options["prior"] == "learnt" and options.get("coefficients", 3) > 3 and random.random() < 0.15:
        library = folder / "library.csv"
        write_atlas(odd_atlas(random, 12), library)
    looks = None
    if options.get("entry_coefficients", 3) > 3 and options["space"] != "camera" and random.random() < 0.15:
        light = "A" if options["illuminant"] != "A" else "D65"
        looks = uplift.Look(tuple(random.uniform(0.2, 0.6, 3)), {light: tuple(random.uniform(0.2, 0.6, 3))})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        cube = uplift.build(atlas, library=library, looks=looks, **options)
        cube.save(folder / "cube.uplift")
        if seed % 3 == 0:
            yield from _file_laws(cube, folder)
        yield from _colour_laws(cube, colours(random, cube), folder)


def _file_laws(cube: uplift.Cube, folder: Path) -> Iterator[str]:
    loaded = uplift.load(folder / "cube.uplift")
    if digest(loaded.data) != digest(cube.data):
        yield "the file has another digest"
    result = CliRunner().invoke(main, ["check", str(folder / "cube.uplift"), "--format", "json"])
    if result.exit_code:
        yield f"check: exit code {result.exit_code}: {result.exception!r} {result.stderr[-200:]}"


def _colour_laws(cube: uplift.Cube, rgb: np.ndarray, folder: Path) -> Iterator[str]:
    sensor, at = cube.data.sensor, np.array(AT)
    off = np.array([miss(sensor.matrix, colour) for colour in rgb])
    for mode in MODES:
        spectra = cube.reflectance(rgb, mode=mode)
        if not (np.isfinite(spectra).all() and spectra.min() >= 0 and spectra.max() <= 1):
            yield f"{mode}: reflectances outside [0, 1]"
    error = np.abs(sensor.rgb(cube.reflectance(rgb)) - rgb).max(axis=1)
    for worst in np.flatnonzero((off < 1e-9) & (error > EXACT)):
        yield f"realisable colour {rgb[worst].tolist()} missed by {error[worst]:.1e}"
    (folder / "colours.csv").write_text("\n".join(",".join(map(repr, row)) for row in rgb.tolist()))
    args = ["query", "--cube", str(folder / "cube.uplift"), "--input", str(folder / "colours.csv"), "--format", "json"]
    answers = json.loads(CliRunner().invoke(main, [*args, "--wavelengths", ",".join(map(str, AT))]).stdout)
    expected = cube.reflectance(rgb, at)
    for answer, missed, row in zip(answers, off, expected, strict=True):
        if answer.get("realisable", True) != (missed < 1e-6) and not 1e-9 < missed < 1e-6:
            yield f"realisable is {answer.get('realisable')}, {missed:.1e} from the nearest: {answer['rgb']}"
        if np.abs(np.array(answer["reflectance"]) - row).max() > 1e-6:
            yield "the command line has other reflectances"
    depth = -cube.data.solid.signed_distance(rgb)
    for mode in ("spectra", "moments") if shutil.which("cc") else ():
        found = _by_program(cube, mode, rgb, folder)
        if not (np.isfinite(found).all() and found.min() >= 0 and found.max() <= 1):
            yield f"C, {mode}: reflectances outside [0, 1]: {found.min()} {found.max()}"
        difference = np.abs(found - cube.reflectance(rgb, at, mode)).max(axis=1) * (depth > DEEP)
        allowed = np.maximum(max(SAME, 2 * rounding_error(cube.data, mode)), SUM / np.maximum(depth, DEEP))
        for worst in np.flatnonzero(difference > allowed):
            yield f"C, {mode}: differs by {difference[worst]:.1e}: {rgb[worst].tolist()}"
    stored = texture.prepare(cube, texture.Spectrum(AT)).sample(rgb.astype(np.float32))
    if np.abs(stored - expected).max() > 1e-5:
        yield f"textures of spectra differ by {np.abs(stored - expected).max():.1e}"


def _by_program(cube: uplift.Cube, mode: str, rgb: np.ndarray, folder: Path) -> np.ndarray:
    """Return reflectances (n, 6) of the program in C."""
    write_program(cube.data, folder / "cube.h", mode=mode, form="file", force=True)
    (folder / "main.c").write_text(PROGRAM % ", ".join(map(str, AT)))
    subprocess.run(["cc", "-std=c99", "-O0", "main.c", "-o", "main", "-lm"], cwd=folder, check=True)
    done = subprocess.run(
        [folder / "main"], cwd=folder, input=rgb.astype(np.float32).tobytes(), capture_output=True, check=True
    )
    return np.frombuffer(done.stdout, np.float32).reshape(-1, len(AT))


def broken(seed: int, dims: tuple[int, int] = (2, 13)) -> list[str]:
    """Return the laws that the build of a seed breaks."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            return [f"build {seed}: {law}" for law in broken_laws(seed, Path(folder), dims)]
        except Exception as problem:  # one build must not end a night
            refused = getattr(problem, "code", "") == "atlas-out-of-gamut"  # spikes may all be outside the space
            return [] if refused else [f"build {seed}: {problem!r}"]


if __name__ == "__main__":
    first, last = map(int, sys.argv[1:])
    failures = 0
    for seed in range(first, last):
        found = broken(seed, (2, 41) if seed % 20 == 0 else (2, 7))
        failures += len(found)
        print(*found, sep="\n", end="\n" * bool(found))
    print(f"{failures} laws broken by {last - first} builds")
    sys.exit(bool(failures))
