"""C header: compiled programs agree with Python."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from tests.helpers import warns, with_points
from uplift.io.export import c_header, write_c
from uplift.io.export.c_header import _identifier
from uplift.lookup import Cube, load
from uplift.lookup.nodes import around
from uplift.models import reflectance

WAVELENGTHS = [300.0, 455.0, 551.5, 700.0, 900.0]
WITHIN = 1e-6
"""Tolerance of reflectance: Python interpolates in the stored precision, C in double."""
C = ("cc", "-std=c99")
CPP = ("c++", "-std=c++11", "-x", "c++")

PROGRAM = r"""
#include <stdio.h>
#include "cube.h"

int main(void)
{
    double rgb[3], coefficients[CUBE_COEFFICIENTS], multipliers[CUBE_COEFFICIENTS];
    while (fread(rgb, sizeof rgb, 1, stdin) == 1) {
        double wavelengths[] = {300.0, 455.0, 551.5, 700.0, 900.0}, found[5];
        int k, valid;
        cube_fetch(rgb, coefficients);
        valid = cube_multipliers(coefficients, multipliers);
        for (k = 0; k < 5; ++k) found[k] = valid ? cube_evaluate(multipliers, wavelengths[k]) : -1;
        fwrite(found, sizeof found, 1, stdout);
    }
    return 0;
}
"""


@pytest.fixture
def evaluate_in_c(tmp_path):
    """Function that compiles a cube's header and evaluates reflectances (n, 5) of linear RGB (n, 3)."""

    def evaluate(data, rgb, compiler=C):
        if shutil.which(compiler[0]) is None:
            pytest.skip(f"needs a compiler, {compiler[0]}")
        write_c(data, tmp_path / "cube.h", force=True)
        (tmp_path / "main.c").write_text(PROGRAM)
        strict = ("-Wall", "-Wextra", "-Wpedantic", "-Werror", "-O1")
        subprocess.run([*compiler, *strict, "main.c", "-o", "main", "-lm"], cwd=tmp_path, check=True)
        done = subprocess.run([tmp_path / "main"], input=rgb.tobytes(), capture_output=True, check=True)
        return np.frombuffer(done.stdout).reshape(-1, len(WAVELENGTHS))

    return evaluate


def colours(data):
    """Return 10,000 linear RGB: random, on faces and corners of the cube, at entries and around them."""
    rng = np.random.default_rng(10)
    rgb = rng.random((10_000, 3))
    rgb[:1000] = np.round(rgb[:1000])
    rgb[1000:2000, 1] = np.round(rgb[1000:2000, 1])
    if len(data.atlas.rgb):
        around = np.tile(data.atlas.rgb, (200, 1))[:4000]
        spread = np.repeat([0, 1e-3, 0.02, 0.1], len(around) // 4 + 1)[: len(around), None]
        rgb[2000 : 2000 + len(around)] = np.clip(around + spread * rng.normal(size=around.shape), 0, 1)
    return rgb


def of_coefficients(cube, rgb):
    """Reflectances (n, 5) of interpolated coefficients, of nodes and entries alike, in Python."""
    return reflectance(cube.data.model, cube.coefficients(rgb), WAVELENGTHS)


SHIPPED = ("moments-8-macbeth", "moments-8", "sigmoid-8-macbeth")


def in_double(data):
    """Return the cube with float64 coefficients, which Python interpolates in double, as C does."""
    return with_points(data, coefficients=data.points.coefficients.astype(float))


@pytest.mark.parametrize("name", SHIPPED)
def test_ten_thousand_colours_equal_those_of_python_in_double_precision(repository, evaluate_in_c, name):
    data = load(repository / "cubes" / f"{name}.uplift").data
    rgb = colours(data)
    expected = of_coefficients(Cube(in_double(data)), rgb)
    np.testing.assert_allclose(evaluate_in_c(data, rgb), expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in SHIPPED if name.startswith("moments")])
def test_python_in_single_precision_differs_by_less_than_1e_6_for_moments(repository, evaluate_in_c, name):
    cube = load(repository / "cubes" / f"{name}.uplift")
    rgb = colours(cube.data)
    expected = of_coefficients(cube, rgb)
    np.testing.assert_allclose(evaluate_in_c(cube.data, rgb), expected, rtol=0, atol=WITHIN)


def test_python_in_single_precision_differs_by_its_rounding_for_sigmoids(repository, evaluate_in_c):
    """The three terms of the quadratic cancel where coefficients are large, so the bound scales with their sizes.

    A sum of eight products in float32 has a relative error of at most nine units of rounding of the sum of their
    magnitudes. The slope of the sigmoid carries the error of the quadratic over to the reflectance.
    """
    cube = load(repository / "cubes" / "sigmoid-8-macbeth.uplift")
    data, rgb = cube.data, colours(cube.data)
    basis, nodes = data.model.basis(WAVELENGTHS), around(data, rgb)
    mix = nodes.weighted_sum(data.points.coefficients.astype(float), data.atlas.coefficients)
    size = nodes.weighted_sum(np.abs(data.points.coefficients).astype(float), np.abs(data.atlas.coefficients))
    rounding = 9 * 2.0**-24 * (size @ np.abs(basis).T) * data.model.slope(mix @ basis.T)
    off = np.abs(evaluate_in_c(data, rgb) - of_coefficients(cube, rgb))
    assert (off <= rounding + 1e-12).all()
    assert rounding.max() < 2e-5


def test_other_modes_and_cubes_differ_measurably(small_cube, plain_cube, evaluate_in_c):
    rgb = colours(small_cube.data)
    found = evaluate_in_c(small_cube.data, rgb)
    assert np.abs(found - small_cube.reflectance(rgb, WAVELENGTHS)).max() > 1e-3
    assert np.abs(found - of_coefficients(plain_cube, rgb)).max() > 1e-3


def test_the_header_compiles_as_cpp(small_cube, evaluate_in_c):
    rgb = colours(small_cube.data)[:5000]
    expected = of_coefficients(small_cube, rgb)
    np.testing.assert_allclose(evaluate_in_c(small_cube.data, rgb, CPP), expected, rtol=0, atol=WITHIN)


def test_double_precision_coefficients_are_exact(small_cube, evaluate_in_c):
    cube = Cube(with_points(small_cube.data, coefficients=small_cube.data.points.coefficients.astype(float)))
    rgb = colours(cube.data)[:3000]
    expected = of_coefficients(cube, rgb)
    np.testing.assert_allclose(evaluate_in_c(cube.data, rgb), expected, rtol=0, atol=1e-9)


def test_other_phases_and_counts(evaluate_in_c, warped_cube):
    rgb = colours(warped_cube.data)
    expected = of_coefficients(warped_cube, rgb)
    np.testing.assert_allclose(evaluate_in_c(warped_cube.data, rgb), expected, rtol=0, atol=WITHIN)


def test_colours_outside_are_clipped_and_nan_is_0(small_cube, evaluate_in_c):
    odd = np.array([[2, -1, 0.5], [np.nan, 0.2, np.inf]])
    plain = np.array([[1, 0, 0.5], [0, 0.2, 1]])
    expected = of_coefficients(small_cube, plain)
    np.testing.assert_allclose(evaluate_in_c(small_cube.data, odd), expected, rtol=0, atol=WITHIN)


def test_names_in_a_cube_cannot_end_a_comment(small_cube, evaluate_in_c):
    sensor = replace(small_cube.data.sensor, space="*/ #error äöü\n /*", illuminant="*//*")
    found = evaluate_in_c(replace(small_cube.data, sensor=sensor), np.full((1, 3), 0.5))
    np.testing.assert_allclose(found, of_coefficients(small_cube, [[0.5] * 3]), atol=WITHIN)


@pytest.mark.parametrize(
    ("stem", "name"),
    [("macbeth-32", "macbeth_32"), ("32", "cube_32"), ("a.b c", "a_b_c"), ("größe", "gr_e"), ("", "cube")],
)
def test_identifiers_derive_from_the_file_name(stem, name):
    assert _identifier(stem) == name


def test_a_large_header_triggers_a_warning(tmp_path, plain_cube, monkeypatch):
    monkeypatch.setattr(c_header, "LARGE", 1000)
    with warns("large-header"):
        write_c(plain_cube.data, tmp_path / "cube.h")
