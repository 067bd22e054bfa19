"""Malformed cube files for ``uplift.h``, in a program under AddressSanitizer and UBSan,
and for ``uplift.js`` in node.

``python -m tests.fuzz.header 0 100000`` reads mutants of these numbers, as `make
nightly` does.
"""

import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np

import uplift
from tests.compiling import compile_in
from tests.cube.cube_files import forge
from tests.fuzz.commands import KEPT
from tests.fuzz.fuzzing import Random, Seeds, choose, mutate
from tests.fuzz.readers import CUBES, READERS, change_content
from tests.parts import SANITIZED
from uplift.common.arrays import StrPath
from uplift.cube.data import CubeData
from uplift.cube.file import write
from uplift.extras.export.module import write_module
from uplift.extras.export.runtime import HEADER, write_header

MAIN = r"""
#include <stdio.h>
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"

int main(void)
{
    const float rgb[] = {0.2f, 0.3f, 0.4f, 0, 0, 0, 1, 1, 1, 0.9f, 0, 0.1f, 2, -1, NAN};
    const float at[] = {300, 380, 555.5f, 780, 1000};
    char path[4096];
    while (scanf(" %4095[^\n]", path) == 1) {
        float reflectances[25], coefficients[17], error;
        int result;
        uplift_cube *cube = uplift_open(path, &result);
        for (int k = 0; cube && k < 5; ++k) {
            uplift_coefficients(cube, rgb + 3 * k, coefficients);
            uplift_standard_error(cube, rgb + 3 * k, &error);
            uplift_error_bound(cube, rgb + 3 * k, &error);
        }
        if (cube) uplift_reflectances_n(cube, rgb, 5, at, 5, reflectances);
        for (int k = 0; cube && k < 25; ++k)
            if (!(reflectances[k] >= -1e-3f && reflectances[k] <= 1.001f)) result = 99;
        uplift_close(cube);
        printf("%d\n", result);
        fflush(stdout);
    }
    return 0;
}
"""
MODULE_MAIN = """
import { readFileSync } from "node:fs";
import { CubeError, open } from "./uplift.mjs";

const rgb = [0.2, 0.3, 0.4, 0, 0, 0, 1, 1, 1, 0.9, 0, 0.1];
const at = [300, 380, 555.5, 780, 1000];
const expected = error => {
  if (!(error instanceof CubeError)) throw error;
  return error.result;
};
const attempt = answer => {
  try {
    return answer();
  } catch (error) {
    expected(error);
    return [];
  }
};
for (const path of readFileSync(0, "utf8").trim().split("\\n")) {
  let result = 0;
  const cube = await open(readFileSync(path)).catch(expected);
  if (typeof cube === "number") {
    result = cube;
  } else {
    for (const name of ["coefficients", "standardError", "errorBound"])
      attempt(() => cube[name](rgb));
    const reflectances = attempt(() => cube.reflectances(rgb, at));
    if (!reflectances.every(value => value >= -1e-3 && value <= 1.001)) result = 99;
  }
  console.log(result);
}
"""
BATCH = 200
"""Files of a run of the program."""
SECONDS = 120.0
"""Limit of a run."""
NOT_A_REFLECTANCE = "99"


@cache
def seeds() -> tuple[CubeData, ...]:
    """Return small cubes: moments and sigmoids, of a wide gamut, and of a scene."""
    wide = uplift.build(dim=3, space="ITU-R BT.2020", prior="smooth").data
    low = wide.lattice.mask(np.zeros(1, dtype=int))
    corners = np.flatnonzero(wide.lattice.corner_points(low))
    scene = replace(wide, points=wide.points.restricted_to(corners))
    return (*CUBES, wide, scene)


@cache
def seed_files() -> Seeds:
    """Return the bytes of these cubes."""
    contents = []
    with tempfile.TemporaryDirectory() as folder:
        for number, data in enumerate(seeds()):
            path = Path(folder, f"{number}.uplift")
            write(data, path)
            contents.append(path.read_bytes())
    return tuple(contents)


def generate(random: Random, path: Path) -> None:
    """Write a mutant: of bytes, of the header, or of values under a valid digest."""
    draw = random.random()
    if draw < 0.3:
        content = choose(random, seed_files())
        path.write_bytes(mutate(content, random, (content[8:2000],)))
    elif draw < 0.5:
        READERS["cube, corrupted bytes"].generate(random, path)
    else:
        data = choose(random, seeds())
        forge(data, path, partial(change_content, random))


Command = tuple[StrPath, ...]


def write_reader(folder: Path) -> Command:
    """Write the program for node, and return the command that runs it."""
    write_module(folder / "uplift.mjs", force=True)
    path = folder / "main.mjs"
    path.write_text(MODULE_MAIN)
    return "node", path


def compile_reader(folder: Path) -> Command:
    """Compile the program with both sanitizers."""
    write_header(folder / HEADER, force=True)
    (folder / "main.c").write_text(MAIN)
    options = ("-O0", "-g", *SANITIZED, "-fsanitize=float-cast-overflow")
    return (compile_in(folder, "cc", *options),)


def run(program: Command, numbers: range, folder: Path) -> Counter[str]:
    """Read mutants by their numbers; return how many had which result. Keep those that
    end the program, or have an answer that is not a reflectance, in out/fuzz.
    """
    tally: Counter[str] = Counter()
    for first in range(numbers.start, numbers.stop, BATCH):
        paths = []
        for number in range(first, min(first + BATCH, numbers.stop)):
            path = folder / f"header-{number}.uplift"
            generate(np.random.default_rng([5, number]), path)
            paths.append(path)
        tally += _run_batch(program, paths)
        for path in paths:
            path.unlink()
    return tally


def _run_batch(program: Command, paths: list[Path]) -> Counter[str]:
    tally: Counter[str] = Counter()
    while paths:
        done = subprocess.run(
            program,
            input="".join(f"{path}\n" for path in paths),
            capture_output=True,
            text=True,
            timeout=SECONDS,
        )
        results = done.stdout.split()
        tally += Counter(results)
        for path, result in zip(paths, results, strict=False):
            if result == NOT_A_REFLECTANCE:
                _keep(path)
        paths = paths[len(results) :]
        if done.returncode:
            _keep(paths[0])
            tally["crash"] += 1
            print(paths[0].name, done.stderr[:2000], file=sys.stderr)
            paths = paths[1:]
    return tally


def _keep(path: Path) -> None:
    KEPT.mkdir(parents=True, exist_ok=True)
    shutil.copy(path, KEPT / path.name)


def main(first: int, last: int) -> None:
    """Print the results, and end with 1 after a failure."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        tally = run(compile_reader(folder), range(first, last), folder)
    print(dict(sorted(tally.items())))
    raise SystemExit(bool(tally["crash"] or tally[NOT_A_REFLECTANCE]))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
