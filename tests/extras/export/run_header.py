"""Compile ``uplift.h``, and run it with cube files: one program per set of options."""

import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from tests.compiling import compile_in
from tests.parts import CC, SANITIZED, SANITIZERS, need
from uplift.common.arrays import StrPath
from uplift.extras.export.runtime import HEADER, write_header
from uplift.lookup.cube import Cube

OK = 0
MAIN = r"""
#include <stdio.h>
#include <stdlib.h>
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"

static uplift_cube *open_file(const char *path, int *error)
{
#ifdef UPLIFT_NO_FILES
    static unsigned char bytes[1 << 22];
    FILE *file = fopen(path, "rb");
    size_t length = file ? fread(bytes, 1, sizeof bytes, file) : 0;
    if (file) fclose(file);
    return uplift_open_memory(bytes, length, error);
#else
    return uplift_open(path, error);
#endif
}

int main(int count, char **words)
{
    int error, size = atoi(words[2]), n = atoi(words[3]), results[4];
    uplift_cube *cube = open_file(words[1], &error);
    if (!cube || count != 4) return error;
    size_t width = (size_t)size, colours = (size_t)n;
    float *at = (float *)malloc(width * sizeof(float));
    float *rgb = (float *)malloc(3 * colours * sizeof(float));
    float *found = (float *)malloc(colours * width * sizeof(float));
    float coefficients[17] = {0}, errors[2];
    if (fread(at, sizeof(float), width, stdin) != width) return 98;
    if (fread(rgb, 3 * sizeof(float), colours, stdin) != colours) return 98;
    uplift_reflectances_n(cube, rgb, n, at, size, found);
    for (int i = 0; i < n; ++i) {
        float *own = found + i * size;
        results[0] = uplift_reflectances(cube, rgb + 3 * i, at, size, own);
        results[1] = uplift_standard_error(cube, rgb + 3 * i, errors);
        results[2] = uplift_error_bound(cube, rgb + 3 * i, errors + 1);
        results[3] = uplift_coefficients(cube, rgb + 3 * i, coefficients);
        fwrite(results, sizeof results, 1, stdout);
        fwrite(errors, sizeof errors, 1, stdout);
        fwrite(coefficients, sizeof coefficients, 1, stdout);
        fwrite(own, sizeof(float), width, stdout);
    }
    free(at);
    free(rgb);
    free(found);
    uplift_close(cube);
    return 0;
}
"""
FOLDER = tempfile.TemporaryDirectory(prefix="uplift-header-")


@dataclass(frozen=True)
class Answers:
    """What a reader returns for n colours at N wavelengths."""

    results: np.ndarray
    """(n, 4) of reflectances, standard errors, error bounds, coefficients."""
    errors: np.ndarray
    """(n, 2) standard errors and error bounds."""
    coefficients: np.ndarray
    """(n, C)"""
    reflectances: np.ndarray
    """(n, N)"""


def answers(cube: Cube, rgb: np.ndarray, at: np.ndarray, *options: str) -> Answers:
    """Save a cube and read it by the header, compiled with options instead of the
    sanitizers.
    """
    return run([program(*options)], cube, rgb, at)


def run(
    command: Sequence[StrPath], cube: Cube, rgb: np.ndarray, at: np.ndarray
) -> Answers:
    """Return the answers of a program: its arguments are a file and the numbers of
    wavelengths and of colours, which it reads.
    """
    path = Path(FOLDER.name, "cube.uplift")
    cube.save(path, force=True)
    given = np.concatenate([at, rgb.ravel()]).astype(np.float32).tobytes()
    sizes = (str(len(at)), str(len(rgb)))
    words = [*command, path, *sizes]
    done = subprocess.run(words, input=given, capture_output=True, check=True)
    fields = [
        ("results", np.int32, 4),
        ("errors", np.float32, 2),
        ("coefficients", np.float32, 17),
        ("reflectances", np.float32, len(at)),
    ]
    rows = np.frombuffer(done.stdout, fields)
    coefficients = rows["coefficients"][:, : cube.coefficient_count]
    return Answers(rows["results"], rows["errors"], coefficients, rows["reflectances"])


def open_result(path: Path, *options: str) -> int:
    """Return the result of opening a file."""
    words = [program(*options), path, "0", "0"]
    done = subprocess.run(words, stdin=subprocess.DEVNULL)
    return done.returncode


@cache
def program(*options: str) -> Path:
    """Compile the program, once for a set of options, by default both sanitizers."""
    need(CC, SANITIZERS)
    options = options or SANITIZED
    folder = Path(tempfile.mkdtemp(dir=FOLDER.name))
    write_header(folder / HEADER)
    (folder / "main.c").write_text(MAIN)
    return compile_in(folder, "cc", "-O0", *options)
