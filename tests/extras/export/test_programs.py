"""Exported programs agree with Python, in every language and mode."""

import re
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.compiling import compile_in
from tests.extras.export import run_program
from tests.fuzz.builds import stay
from tests.fuzz.programs import c_reflectances
from tests.helpers import raises, warns
from tests.parts import CC, CLANG, SANITIZED, SANITIZERS, need
from uplift.common.errors import OutputError
from uplift.extras.export.program import LANGUAGES, write_program
from uplift.extras.export.rounding import rounding_error

WAVELENGTHS = [300.0, 455.0, 551.5, 700.0]
EVERY = np.arange(380.0, 781.0)
# tolerance of reflectance in single precision: multipliers of spectra near a box reach
# 4e6
WITHIN = 1e-4
LANGUAGE = {"cpp": "c", "fast": "c"}


def colours(data):
    """Return 10,000 linear RGB: random, on faces and corners of the cube, around
    entries, and on the faces of their boxes.
    """
    rng = np.random.default_rng(10)
    rgb = rng.random((10_000, 3))
    rgb[:1000] = np.round(rgb[:1000])
    rgb[1000:2000, 1] = np.round(rgb[1000:2000, 1])
    entries = data.atlas.rgb
    if len(entries):
        spread = np.repeat([0, 1e-3, 0.02, 0.1], 1000)[:, None]
        rgb[2000:6000] = np.resize(entries, (4000, 3))
        rgb[2000:6000] += spread * rng.normal(size=(4000, 3))
        axes = rng.integers(3, size=1000)
        sides = rng.integers(2, size=1000)
        faces = np.resize(data.entry_boxes.faces[1], (2, 1000, 3))
        faces[0] = np.resize(data.entry_boxes.faces[0], (1000, 3))
        rgb[6000:7000] = np.resize(entries, (1000, 3))
        rgb[6000:7000] += rng.uniform(-0.01, 0.01, (1000, 3))
        rows = np.arange(1000)
        rgb[6000 + rows, axes] = faces[sides, rows, axes]
    return np.clip(rgb, 0, 1).astype(np.float32).astype(float)


OUTSIDE = np.array(
    [[2, -1, 0.5], [np.nan, 0.2, np.inf], [-np.nan, np.nan, 0.9], [-np.inf, 1, -0.0]]
)


@pytest.fixture
def check(tmp_path):
    """Function that compares reflectances of a program with those of Python."""

    def check(cube, style, mode, rgb, form=None, within=WITHIN):
        language = LANGUAGE.get(style, style)
        path = tmp_path / f"cube{LANGUAGES[language].suffix}"
        form = form or LANGUAGES[language].forms[0]
        write_program(cube.data, path, style=language, mode=mode, form=form)
        found = getattr(run_program, style)(path, rgb, WAVELENGTHS, form)
        clipped = np.clip(np.nan_to_num(rgb, posinf=1), 0, 1)
        expected = cube.reflectance(clipped, np.clip(WAVELENGTHS, 380, 780), mode=mode)
        assert_allclose(found, expected, rtol=0, atol=within)

    return check


@pytest.mark.parametrize(
    ("style", "form", "mode", "cube"),
    [
        ("c", "header", "spectra", "plain_cube"),
        ("c", "file", "moments", "warped_cube"),
        ("fast", "header", "spectra", "small_cube"),
        ("fast", "header", "moments", "small_cube"),
        ("cpp", "header", "moments", "sigmoid_cube"),
        ("cuda", "file", "moments", "small_cube"),
        ("glsl", "file", "moments", "small_cube"),
        ("hlsl", "file", "spectra", "sigmoid_cube"),
    ],
)
def test_ten_thousand_colours_equal_those_of_python(
    request, check, style, form, mode, cube
):
    """Colours outside are clipped, and NaN is 0."""
    found = request.getfixturevalue(cube)
    share = 1 if cube == "small_cube" else 5
    rgb = np.concatenate([colours(found.data), OUTSIDE])
    check(found, style, mode, rgb, form, within=share * WITHIN)


@pytest.mark.parametrize(
    ("style", "mode", "model"),
    [
        ("c", "spectra", "moments"),
        ("c", "moments", "sigmoid"),
        ("cuda", "spectra", "moments"),
        ("glsl", "spectra", "moments"),
        ("hlsl", "moments", "moments"),
    ],
)
def test_realisable_colours_around_unrealisable_nodes(wide, check, style, mode, model):
    """They are moved to their colours as in Python: without it, reflectances differ by
    up to 0.9.
    """
    cube = wide[model]
    rgb = colours(cube.data)[:3000]
    rgb = rgb[cube.data.solid.signed_distance(rgb) < -2e-3]
    share = 2 if style in ("c", "cuda") else 50
    check(cube, style, mode, rgb, within=share * WITHIN)


def test_mixtures_that_start_from_flat_spectra(check):
    """White weights are moved to strong colours, where Newton's steps are longer than
    numbers can be (seed 104).
    """
    cube = uplift.build(dim=5, space="ACES2065-1", model="sigmoid")
    rgb = np.float32([[0.75587261, 0.82532507, 0.21911287]]).astype(float)
    check(cube, "c", "moments", rgb, within=2 * WITHIN)


@pytest.mark.parametrize(
    ("name", "mode", "width"),
    [("acescg", "spectra", 4), ("acescg", "moments", 16), ("17", "moments", 16)],
)
def test_all_numbers_of_cuda_are_in_registers(tmp_path, name, mode, width):
    """Of a cube whose answers are moved, and of one of 17 coefficients."""
    if name == "17":
        cube = uplift.build(dim=3, coefficients=17, prior="smooth")
    else:
        cube = uplift.load(name)
    path = tmp_path / "cube.cuh"
    write_program(cube.data, path, style="cuda", mode=mode)
    spilled = re.findall(r"(\d+) bytes spill", run_program.registers(path, width))
    assert spilled
    assert set(spilled) == {"0"}


@pytest.mark.parametrize(
    ("mode", "binding", "macros"),
    [("spectra", 0, []), ("moments", 3, ["#define CUBE_BINDING 3"])],
)
def test_vulkan_compiles_shaders_as_they_are_written(
    small_cube, tmp_path, mode, binding, macros
):
    """With the binding that macros choose."""
    path = tmp_path / "cube.glsl"
    write_program(small_cube.data, path, style="glsl", mode=mode)
    assert f"Binding {binding}" in run_program.compile_vulkan(path, macros)


@pytest.mark.parametrize("mode", ["spectra", "moments"])
def test_what_single_precision_changes_is_a_bound(
    small_cube, sigmoid_cube, warped_cube, wide, mode
):
    """At every wavelength, of colours whose answers are not moved."""
    need(CC)
    for cube in (small_cube, sigmoid_cube, warped_cube, *wide.values()):
        rgb = colours(cube.data)[:4000:2]
        rgb = rgb[stay(cube.data, mode, rgb)]
        found = c_reflectances(cube.data, mode, rgb, EVERY)
        assert np.abs(found - cube.reflectance(rgb, EVERY, mode)).max(
            initial=0
        ) < rounding_error(cube.data, mode)


def test_programs_of_one_cube_share_a_table(small_cube, plain_cube, tmp_path):
    """Another table is refused, and replaced only with force."""
    data = small_cube.data
    _, table = write_program(data, tmp_path / "a.glsl", style="glsl")
    shared = write_program(data, tmp_path / "a.hlsl", style="hlsl")
    assert shared == [tmp_path / "a.hlsl", table]
    before = table.read_bytes()
    with raises(OutputError, "file-exists"):
        write_program(plain_cube.data, tmp_path / "a.cuh", style="cuda")
    assert table.read_bytes() == before
    assert not (tmp_path / "a.cuh").exists()
    with warns("warning"):
        write_program(plain_cube.data, tmp_path / "a.cuh", style="cuda", force=True)
    assert table.read_bytes() != before


MANY = r"""
#include <stdio.h>
#include "cube.h"

int main(void)
{
    float rgb[63], at[21], found[441];
    for (int k = 0; k < 63; ++k) rgb[k] = (float)(k * 7 % 33) / 32.0f;
    for (int k = 0; k < 21; ++k) at[k] = 400 + 15.0f * (float)k;
    cube_reflectances_n(rgb, 21, at, 21, found);
    fwrite(found, sizeof found, 1, stdout);
    for (int k = 0; k < 21; ++k) cube_reflectances(rgb + 3 * k, at, 21, found + 21 * k);
    fwrite(found, sizeof found, 1, stdout);
#if !CUBE_SPECTRA
    float coefficients[21 * CUBE_COUNT], multipliers[21 * CUBE_COUNT];
    for (int k = 0; k < 21; ++k)
        cube_coefficients(rgb + 3 * k, coefficients + CUBE_COUNT * k);
    if (cube_multipliers_n(coefficients, 21, multipliers)) return 1;
    for (int k = 0; k < 21; ++k)
        cube_evaluate(multipliers + CUBE_COUNT * k, at, 21, found + 21 * k);
    fwrite(found, sizeof found, 1, stdout);
    coefficients[0] = coefficients[10 * CUBE_COUNT] = 2;
    if (cube_multipliers_n(coefficients, 21, multipliers) != 2) return 2;
    return cube_multipliers(coefficients, multipliers);
#endif
    return 0;
}
"""
ROW = (np.arange(63, dtype=np.float32) * 7 % 33 / 32).reshape(21, 3)


def run_c(code, folder, *options, compiler="cc"):
    need({"cc": CC, "clang": CLANG}[compiler])
    (folder / "main.c").write_text(code)
    program = compile_in(folder, compiler, *run_program.STRICT, *options)
    return subprocess.run([program], cwd=folder, capture_output=True, check=True).stdout


@pytest.mark.parametrize(("mode", "count"), [("spectra", 2), ("moments", 3)])
def test_many_colours_at_any_number_of_wavelengths_and_stored_multipliers(
    small_cube, tmp_path, mode, count
):
    write_program(small_cube.data, tmp_path / "cube.h", mode=mode)
    need(SANITIZERS)
    found = np.frombuffer(run_c(MANY, tmp_path, *SANITIZED), np.float32).reshape(
        count, 21, 21
    )
    expected = small_cube.reflectance(ROW, 400 + 15.0 * np.arange(21), mode=mode)
    assert_allclose(found, [expected] * count, rtol=0, atol=WITHIN)


def test_clang_is_silent_at_every_level(sigmoid_cube, tmp_path):
    """It reports loops that a pragma requests to vectorise and that it does not."""
    write_program(sigmoid_cube.data, tmp_path / "cube.h")
    for level in ("-O0", "-O1", "-Oz", "-O3"):
        assert len(run_c(MANY, tmp_path, level, compiler="clang")) == 2 * 21 * 21 * 4


def test_names_in_a_cube_cannot_end_a_comment(small_cube, check):
    sensor = replace(
        small_cube.data.sensor, space="*/ #error äöü\n /*", illuminant="*//* ${table}"
    )
    check(
        replace(small_cube, data=replace(small_cube.data, sensor=sensor)),
        "c",
        "spectra",
        np.full((1, 3), 0.5),
    )


LOADING = r"""
#include "cube.h"

int main(void)
{
    const char *problem = cube_load("cube.bin");
    if (problem) puts(problem);
    return !problem != !!cube_table;
}
"""


def test_a_header_loads_only_the_table_of_its_cube(small_cube, tmp_path):
    _, table = write_program(small_cube.data, tmp_path / "cube.h", form="file")
    numbers = table.read_bytes()
    assert not run_c(LOADING, tmp_path)
    flipped = numbers[:100] + bytes([numbers[100] ^ 1]) + numbers[101:]
    for damaged in (flipped, numbers[:-4], bytes(4) + numbers):
        table.write_bytes(damaged)
        assert run_c(LOADING, tmp_path)
    table.unlink()
    assert run_c(LOADING, tmp_path)
