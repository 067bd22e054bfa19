"""The kernel: the same functions run in Python, and their translation."""

from __future__ import annotations

import ast
import math

import numpy as np
import pytest

from tests.io.export.test_programs import WAVELENGTHS, WITHIN, colours
from uplift.io.export.kernel import (
    answer_moments,
    answer_spectra,
    entries,
    intrinsics,
    lanes,
    lattice,
    moments,
    nodes_at_once,
    nodes_in_turn,
    spectra,
)
from uplift.io.export.kernel.language import GLSL, WGSL, C
from uplift.io.export.kernel.table import make_table
from uplift.io.export.kernel.translate import functions, translate


def run_in_python(data, mode, answers):
    """Return a namespace with the functions of the kernel."""
    table = make_table(data, mode)
    numbers, stride = table.numbers.tolist(), table.constants["STRIDE"]

    def load_row(index, row):
        row[:] = numbers[index * stride : (index + 1) * stride]

    names = {**vars(intrinsics), **table.constants, "WIDTH": 4, "LANES": 2, "number": numbers.__getitem__}
    names |= {
        "tag": lambda index: numbers[index * stride + data.model.count],
        "load_row": load_row,
        "warp": float,
    }
    for function in functions(moments, spectra, lattice, entries, *answers):
        function.returns, function.args = None, _without_types(function.args)
        exec(compile(ast.Module([_without_aliases(function)], []), "kernel", "exec"), names)
    return names


def _without_types(arguments):
    for each in arguments.args:
        each.annotation = None
    return arguments


def _without_aliases(function):
    for node in ast.walk(function):
        if isinstance(node, ast.AnnAssign):
            node.annotation = ast.copy_location(ast.Constant(None), node.annotation)
    return function


@pytest.mark.parametrize(
    ("mode", "answers"),
    [
        ("spectra", [nodes_in_turn, answer_spectra]),
        ("spectra", [nodes_at_once, answer_spectra]),
        ("moments", [nodes_in_turn, answer_moments]),
        ("moments", [nodes_at_once, answer_moments]),
    ],
)
def test_the_kernel_in_python_equals_the_lookup(small_cube, mode, answers):
    names = run_in_python(small_cube.data, mode, answers)
    rgb = colours(small_cube.data)[::97]
    found = []
    for colour in rgb.tolist():
        place, total = [0.0] * 4, [0.0] * 4
        entry = names["locate"](colour, place)
        names["answer"](place, entry, WAVELENGTHS, total)
        found.append(total)
    expected = small_cube.reflectance(rgb, WAVELENGTHS, mode=mode)
    np.testing.assert_allclose(found, expected, rtol=0, atol=WITHIN)


def test_polynomials_of_sine_and_arc_tangent(small_cube):
    names = run_in_python(small_cube.data, "spectra", [])
    for x in np.linspace(-0.5, 0.5, 1001).tolist():
        assert moments.sine_of_turn(x) == pytest.approx(math.sin(math.pi * x), rel=1e-7, abs=1e-12)
    for x in np.tan(np.linspace(-1.57, 1.57, 1001)).tolist():
        assert names["deviation"](1.0, x) == pytest.approx(math.atan(x) / math.pi, abs=6e-7)


def test_colours_side_by_side_equal_those_one_by_one(small_cube):
    data = small_cube.data
    names, count = run_in_python(data, "moments", [lanes]), data.model.count
    given = data.points.coefficients[[3, 200]].tolist()
    expected = [[0.0] * count for _ in given]
    assert all(map(names["dual"], given, expected))
    side_by_side = [number for pair in zip(*given, strict=True) for number in pair]
    found, valid = [0.0] * (2 * count), [0.0, 0.0]
    names["duals"](side_by_side, found, valid)
    assert valid == [1, 1]
    assert [found[0::2], found[1::2]] == expected
    reference = data.model.from_storage(np.array(given))
    np.testing.assert_allclose(expected, reference, rtol=1e-6, atol=1e-6 * np.abs(reference).max())


@pytest.mark.parametrize("first", [-0.1, 0.99, math.nan])
def test_numbers_of_no_spectrum_are_invalid(small_cube, first):
    names, count = run_in_python(small_cube.data, "moments", []), small_cube.data.model.count
    multipliers = [1.0] * count
    assert not names["multipliers_of"]([first] + [0.3] * (count - 1), multipliers)
    assert multipliers == [0.0] * count


SOURCE = '''
def mix(a: Float, values: Coefficients) -> Float:
    """Mix."""
    x: Coefficients = zeros(COUNT)
    for k in unroll(0, COUNT):
        x[k] = a * (values[k] - -2.0) if a > 0.5 else 1.0 - (a - 3.0)
        if k % 2 == 1:
            values[k] = float(k // 2)
    return x[0] / (x[1] * 2.0)
'''


def translated(language):
    (function,) = ast.parse(SOURCE).body
    return translate([function], language, "t", {"COUNT": 2})


def test_loops_are_written_out_and_brackets_kept():
    text = translated(C)
    assert "float t_mix(float a, float values[T_COUNT])" in text
    assert "x[0] = a > 0.5f ? a * (values[0] - -2.0f) : 1.0f - (a - 3.0f);" in text
    assert text.count("(float)(0)") == 1
    assert "return x[0] / (x[1] * 2.0f);" in text


def test_languages_differ_in_declarations():
    assert "inout float values[2]" in translated(GLSL)
    text = translated(WGSL)
    assert "fn t_mix(a: f32, values: ptr<function, array<f32, 2>>) -> f32" in text
    assert "select(1.0 - (a - 3.0), a * ((*values)[1] - -2.0), a > 0.5)" in text


def test_other_statements_are_rejected():
    (function,) = ast.parse("def f(a: Float) -> Float:\n    with a: pass\n").body
    with pytest.raises(NotImplementedError):
        translate([function], C, "t", {})
