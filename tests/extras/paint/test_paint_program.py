"""Exported paints: the numbers of Python in C, C++ and shaders, and tables of two."""

from dataclasses import replace

import numpy as np
import PyOpenColorIO
import pytest
from numpy.testing import assert_allclose

from tests.extras.export.run_program import compile_hlsl
from tests.extras.paint import run_paints
from tests.extras.paint.invented import invented
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.paint.paint_exports import (
    HIDDEN,
    LUT_SIZE,
    export_lut,
    hiding_thickness,
)
from uplift.extras.paint.paint_program import write_program

SUFFIXES = {"c": ".h", "glsl": ".glsl", "hlsl": ".hlsl"}


@pytest.fixture(scope="module")
def paints():
    return invented()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tubes")


@pytest.fixture(scope="module")
def samples(paints, folder):
    """What programs in all languages contain."""
    written = [
        write_program(paints, folder / f"tubes{suffix}", style=style)
        for style, suffix in SUFFIXES.items()
    ]
    return written[0]


@pytest.fixture
def rows(rng):
    """Parts, thickness over ten decades and ground (300, 6)."""
    parts = rng.dirichlet(np.full(4, 0.4), 300) * rng.uniform(0.1, 50, (300, 1))
    parts[:4] = np.eye(4)
    thickness = 10 ** rng.uniform(-5, 5, 300)
    thickness[:10] = 0
    ground = rng.uniform(0.04, 1, 300)
    every = np.column_stack([parts, thickness, ground])
    return every.astype(np.float32).astype(float)


@pytest.mark.parametrize("name", ["c", "cpp", "sanitized"])
def test_programs_mix_as_python(samples, folder, rows, name):
    found = run_paints.c(folder / "tubes.h", rows, name)
    few = samples.paints
    count = len(few.wavelengths)
    opaque = few.reflectance(rows[:, :4])
    layers = [few.reflectance(row[:4], row[4], row[5]) for row in rows]
    assert_allclose(found[:, :count], opaque, atol=1e-5)
    assert_allclose(found[:, count : 2 * count], layers, atol=1e-4)
    assert_allclose(found[:, 2 * count :], opaque @ samples.weights.T, atol=1e-5)


def test_few_wavelengths_have_the_colours_of_all(paints, samples):
    """The stated errors are those of mixtures that nothing was fitted to."""
    parts = np.random.default_rng(77).dirichlet(np.full(4, 0.5), 300)
    sensor = paints.sensor
    exact = np.clip(sensor.rgb(paints.reflectance(parts)), 0, 1)
    near = np.clip(samples.paints.reflectance(parts) @ samples.weights.T, 0, 1)
    errors = delta_e_rgb(sensor, exact, near)
    assert errors.mean() < 1.5 * samples.opaque_errors.mean() < 0.45
    assert errors.max() < 2 * samples.opaque_errors.max()
    assert samples.layer_errors.mean() < 0.3


def test_hlsl_compiles(samples, folder):
    compiled = compile_hlsl(folder / "tubes.hlsl", run_paints.PIXEL)
    assert compiled.stat().st_size > 1000


def test_the_shader_mixes_as_python(samples, folder, rng):
    films = np.column_stack([10 ** rng.uniform(-3, 3, 60), rng.uniform(0.05, 1, 60)])
    films = films.astype(np.float32).astype(float)
    found = run_paints.glsl(folder / "tubes.glsl", films)
    parts = [2.0, 1.0, 0.0, 0.5]
    layers = np.array([samples.paints.reflectance(parts, *film) for film in films])
    assert_allclose(found[:, :3], layers @ samples.weights.T, atol=1e-4)
    assert_allclose(found[:, 3], layers[:, 3], atol=1e-4)


def test_names_cannot_end_a_comment(paints, tmp_path):
    named = replace(paints, names=("*/ #error", "${title}", "weiß\n", "up_mix"))
    write_program(named, tmp_path / "tubes.h")
    text = (tmp_path / "tubes.h").read_text("ascii")
    assert text.count("*/") == text.count("/*")
    run_paints.c(tmp_path / "tubes.h", np.ones((1, 6)))


NODES = np.random.default_rng(1).integers(0, LUT_SIZE, (60, 3)) / (LUT_SIZE - 1)


def test_a_table_of_two_paints_as_opencolorio_reads_it(tmp_path):
    """At its nodes: share, root of the thickness and grey ground."""
    two = invented(np.arange(400.0, 701, 10), ["yellow", "blue"])
    line = export_lut(two, tmp_path / "two.cube", "cube", force=False)
    thickest = max(hiding_thickness(two, row) for row in np.eye(2))
    assert f"{thickest:.3g}" in line
    transform = PyOpenColorIO.FileTransform(str(tmp_path / "two.cube"))
    processor = PyOpenColorIO.Config.CreateRaw().getProcessor(transform)
    pixels = NODES.astype(np.float32)
    processor.getDefaultCPUProcessor().applyRGB(pixels)
    films = [
        two.reflectance([1 - share, share], thickest * depth**2, decode(code))
        for share, depth, code in NODES
    ]
    assert_allclose(pixels, encode(two.sensor.rgb(np.array(films))), atol=1e-5)


def test_layers_hide_at_their_thickness(paints):
    sensor = paints.sensor
    row = np.eye(4)[3]
    thickness = hiding_thickness(paints, row)
    errors = []
    for depth in (thickness, thickness / 1.06):
        films = [paints.reflectance(row, depth, ground) for ground in (0.0, 1.0)]
        errors.append(delta_e_rgb(sensor, *np.clip(sensor.rgb(films), 0, 1)))
    assert errors[0] <= HIDDEN < errors[1]
