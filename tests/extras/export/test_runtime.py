"""``uplift.h`` and ``uplift.js`` read every cube as Python does and refuse other files;
the header is composed of the source of exported programs.
"""

import subprocess
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.compiling import compile_in
from tests.cube.cube_files import forge
from tests.extras.export.run_header import OK, Answers, answers, open_result
from tests.extras.export.run_module import module_answers, module_result
from tests.extras.export.run_program import STRICT
from tests.extras.export.test_programs import OUTSIDE, colours
from tests.extras.looks.test_looks import LOOKS
from tests.helpers import quiet_build
from tests.parts import CC, CLANG, CXX, need
from uplift.extras.export.runtime import write_header
from uplift.lookup.cube import Cube
from uplift.lookup.interpolate import fading_share, is_inexact, node_errors

AT = np.arange(350.0, 831.0, 24)
WITHIN = 1e-4
"""Reflectance, in single precision, as of exported programs."""
INSIDE = -2e-3
"""Distance from the solid up to which moved answers are compared: at colours that no
reflectance has, spectra are steps.
"""
DAMAGED = 6
INVALID = 7
NOT_IN_SCENE = 10
NO_ERRORS = 11
NO_COEFFICIENTS = 12


@pytest.fixture(scope="module")
def cubes(small_cube, small_sigmoid_cube, sigmoid_cube, wide):
    """Cubes by what is rare about them."""
    macbeth = quiet_build("macbeth", dim=5, coefficients=11, prior="smooth")
    return {
        "moments": small_cube,
        "sigmoid": sigmoid_cube,
        "no entries": small_sigmoid_cube,
        "packaged": uplift.load("acescg"),
        "wide": wide["moments"],
        "wide sigmoid": wide["sigmoid"],
        "entries of 17": macbeth,
        "looks": quiet_build("macbeth", dim=4, prior="smooth", looks=LOOKS),
        "colour": quiet_build(dim=4, coefficients=7, warp="colour", prior="smooth"),
        "vision": quiet_build(dim=4, coefficients=5, warp="vision", prior="smooth"),
        "wide scene": of_scene(wide["moments"], 3),
        "scene": of_scene(macbeth, 9),
    }


def of_scene(cube: Cube, count: int) -> Cube:
    """Keep the nodes that a few dark colours need."""
    data = cube.data
    rgb = np.random.default_rng(1).random((count, 3)) ** 2
    points = np.flatnonzero(data.entry_boxes.required_points([rgb]))
    return Cube(replace(data, points=data.points.restricted_to(points)))


def check(
    cube: Cube,
    read: Callable[..., Answers] = answers,
    options: tuple[str, ...] = (),
    within: float = WITHIN,
) -> None:
    """Compare the answers to a thousand colours with those of Python."""
    data = cube.data
    rgb = colours(data)[::10]
    found = read(cube, rgb, AT, *options)
    covered = cube.covers(rgb)
    assert (found.results[~covered] == NOT_IN_SCENE).sum(axis=1).min(initial=4) >= 3
    assert not found.reflectances[~covered].any()
    assert (found.results[covered, 0] == OK).all()
    rgb = rgb[covered]
    inside = data.solid.signed_distance(rgb) < INSIDE
    compared = inside | ~is_inexact(data, rgb)
    expected = cube.reflectance(rgb[compared], AT)
    reflectances = found.reflectances[covered][compared]
    assert_allclose(reflectances, expected, rtol=0, atol=within)
    # Coefficients that Python moves to exact colours are refused.
    stays = fading_share(data, rgb) == 0
    results = found.results[covered, 3]
    assert (results[stays] == OK).all()
    assert (results[fading_share(data, rgb) > 1e-6] == NO_COEFFICIENTS).all()
    coefficients = found.coefficients[covered][stays]
    expected = cube.coefficients(rgb[stays])
    assert_allclose(coefficients, expected, rtol=1e-5, atol=2e-4)
    if data.points.standard_error is None:
        assert (found.results[covered, 1:3] == NO_ERRORS).all()
        return
    # These limit errors by the possible ones, which programs do not know.
    expected = node_errors(data, rgb)
    assert_allclose(found.errors[covered], expected, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize(
    "name",
    [
        "moments",
        "sigmoid",
        "no entries",
        "packaged",
        "colour",
        "wide",
        "wide sigmoid",
        "entries of 17",
        "looks",
        "vision",
        "wide scene",
        "scene",
    ],
)
def test_the_header_answers_as_python(cubes, name):
    check(cubes[name], within=2 * WITHIN)


@pytest.mark.parametrize("name", ["no entries", "wide sigmoid", "wide scene"])
def test_the_module_answers_as_python(cubes, name):
    """It is compiled from the header."""
    check(cubes[name], module_answers, within=2 * WITHIN)


@pytest.mark.parametrize(
    "options",
    [("-DUPLIFT_NO_MMAP", "-DUPLIFT_WIDTH=4"), ("-DUPLIFT_NO_FILES",)],
    ids=["read", "in memory"],
)
def test_files_that_are_not_mapped(small_cube, options):
    check(small_cube, options=options)


@pytest.mark.parametrize(
    "compiler",
    [
        ("cc", "-std=c99", "-O3"),
        ("c++", "-std=c++11", "-x", "c++", "-Wold-style-cast"),
        ("clang", "-std=c99"),
    ],
    ids=lambda command: command[0],
)
def test_compilers_are_silent(tmp_path, compiler):
    need({"cc": CC, "c++": CXX, "clang": CLANG}[compiler[0]])
    write_header(tmp_path / "uplift.h")
    main = '#define UPLIFT_IMPLEMENTATION\n#include "uplift.h"\n#include "uplift.h"\n'
    (tmp_path / "main.c").write_text(main)
    compile_in(tmp_path, compiler[0], *STRICT, *compiler[1:], "-c", output="main.o")


def times(name, factor):
    """Multiply a tensor by a factor."""

    def change(tensors, metadata):
        tensors[name] = tensors[name] * factor

    return change


def version(tensors, metadata):
    metadata["version"] = 9


def feature(tensors, metadata):
    metadata["features"].append("later")


def no_spectrum(tensors, metadata):
    tensors["coefficients"] = tensors["coefficients"] + 2


@pytest.mark.parametrize(
    ("name", "change", "result"),
    [
        ("moments", version, 4),
        ("moments", feature, 5),
        ("moments", times("coefficients", np.nan), INVALID),
        ("moments", times("nodes", -1), INVALID),
        ("moments", no_spectrum, INVALID),
        # Of another unit, where colours are moved.
        ("wide", times("sensor.wavelengths", 1e3), INVALID),
        ("wide", times("sensor.wavelengths", 1.25), INVALID),
    ],
)
def test_forged_files_are_refused(cubes, tmp_path, name, change, result):
    path = forge(cubes[name].data, tmp_path / "a.uplift", change)
    assert open_result(path) == result


def test_numbers_are_checked_where_compilers_assume_no_nan(small_cube, tmp_path):
    """Of colours, and of files."""
    rgb = np.clip(np.nan_to_num(OUTSIDE, posinf=1), 0, 1)
    found = answers(small_cube, OUTSIDE, AT, "-O2", "-ffast-math")
    expected = small_cube.reflectance(rgb, AT)
    assert_allclose(found.reflectances, expected, rtol=0, atol=WITHIN)
    assert_allclose(found.errors[:, 0], small_cube.standard_error(rgb), atol=1e-5)
    path = forge(small_cube.data, tmp_path / "a.uplift", times("coefficients", np.nan))
    assert open_result(path, "-O2", "-ffast-math") == INVALID


@pytest.mark.parametrize("open_file", [open_result, module_result])
def test_damaged_files_are_refused(repository, tmp_path, open_file):
    content = (repository / "cubes" / "moments-8.uplift").read_bytes()
    path = tmp_path / "a.uplift"
    flipped = content[:-9] + bytes([content[-9] ^ 1]) + content[-8:]
    for damaged, result in (
        (content, OK),
        (flipped, DAMAGED),
        (content[:-1], 3),
        (content[:5], 3),
        (b"", 3),
        (b"{}" * 100, 3),
    ):
        path.write_bytes(damaged)
        assert open_file(path) == result


THREADS = r"""
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#define UPLIFT_IMPLEMENTATION
#include "uplift.h"
enum { COLOURS = 4000, SIZE = 8, COUNT = 4 };
static uplift_cube *cube;
static float rgb[3 * COLOURS], at[SIZE], found[COUNT + 1][COLOURS * SIZE];

static void *answer(void *place)
{
    for (int i = 0; i < COLOURS; ++i)
        uplift_reflectances(cube, rgb + 3 * i, at, SIZE, (float *)place + i * SIZE);
    return NULL;
}

int main(int count, char **words)
{
    int error;
    pthread_t threads[COUNT];
    if (count < 2 || !(cube = uplift_open(words[1], &error))) return 2;
    for (int i = 0; i < 3 * COLOURS; ++i) rgb[i] = (float)(rand() % 1000) / 999.0f;
    for (int k = 0; k < SIZE; ++k) at[k] = 400.0f + 40.0f * (float)k;
    answer(found[COUNT]);
    for (int i = 0; i < COUNT; ++i)
        if (pthread_create(threads + i, NULL, answer, found[i])) return 3;
    for (int i = 0; i < COUNT; ++i) pthread_join(threads[i], NULL);
    for (int i = 0; i < COUNT; ++i)
        if (memcmp(found[i], found[COUNT], sizeof found[i])) return 4;
    uplift_close(cube);
    return 0;
}
"""


def test_threads_share_an_open_cube(repository, tmp_path):
    need(CC)
    write_header(tmp_path / "uplift.h")
    (tmp_path / "main.c").write_text(THREADS)
    program = compile_in(tmp_path, "cc", "-O1", "-pthread")
    cube = repository / "cubes" / "moments-8-macbeth.uplift"
    subprocess.run([program, cube], check=True, timeout=60)
