"""``uplift.js``: its compiled code is that of its source, and its functions check their
arguments. test_runtime.py compares its answers with Python.
"""

import base64
import json
import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.browser import browser
from tests.helpers import output_of, raises
from tests.parts import CHROMIUM, NODE, WASM, need
from tools.compile_module import compile_module
from uplift.common.errors import OutputError
from uplift.extras.export.module import (
    COMPILED,
    compose_module,
    source_digest,
    write_module,
)

COLOURS = [0.8, 0.2, 0.1, 0.1, 0.2, 0.8]
AT = [400, 500, 600, 700]
LARGEST = 50_000
"""Bytes of the module, which pages load."""


def compiler_of(code: bytes) -> bytes:
    """Return the compiler that a compiled module states."""
    (name,) = re.findall(rb"[0-9a-f]{64} (clang [^\0]*)", code)
    return name


def test_the_stored_code_is_that_of_its_source():
    """`make module` compiles it again."""
    assert source_digest().encode() in COMPILED.read_bytes()


def test_the_stored_code_is_what_its_compiler_makes():
    need(WASM)
    code = compile_module()
    stored = COMPILED.read_bytes()
    if compiler_of(code) != compiler_of(stored):
        pytest.skip(f"compiled by another version: {compiler_of(stored).decode()}")
    assert code == stored


def test_it_is_small_and_not_written_over_another_file(tmp_path):
    path = tmp_path / "uplift.js"
    write_module(path)
    text = path.read_text("ascii")
    assert text == compose_module()
    assert len(text) < LARGEST
    assert text.count("http") == 0
    with raises(OutputError, "file-exists"):
        write_module(path)


@pytest.fixture
def evaluate(tmp_path, repository):
    """Function that evaluates an expression in node, with a cube, and returns what it
    is as JSON.
    """

    def evaluate(expression: str):
        need(NODE)
        write_module(tmp_path / "uplift.mjs", force=True)
        (tmp_path / "main.mjs").write_text(
            f"""import {{ readFileSync }} from "node:fs";
            import * as uplift from "./uplift.mjs";
            const path = {json.dumps(path.as_posix())};
            const file = readFileSync(path);
            const cube = await uplift.open(file);
            console.log(JSON.stringify(await ({expression})));"""
        )
        return json.loads(output_of("node", tmp_path / "main.mjs"))

    path = repository / "cubes" / "moments-8-macbeth.uplift"
    return evaluate


def test_many_colours_have_the_answers_of_each(evaluate):
    equal = evaluate(
        """(() => {
        const rgb = Float32Array.from({ length: 3 * 30000 }, (_, k) => k * 0.37 % 1);
        const at = [410, 520, 630];
        const answers = [cube.reflectances(rgb, at), cube.coefficients(rgb)];
        return [0, 1, 5000, 12345, 29999].map(k => {
          const one = rgb.subarray(3 * k, 3 * k + 3);
          const each = [cube.reflectances(one, at), cube.coefficients(one)];
          return each.every((row, i) => row.every((value, j) =>
            value === answers[i][k * row.length + j]));
        });
        })()"""
    )
    assert equal == [True] * 5
    sizes = "[cube.reflectances([], [550]), cube.reflectances([1, 1, 1], [])]"
    assert evaluate(f"{sizes}.map(row => row.length)") == [0, 0]


def test_other_arguments_are_refused(evaluate):
    names = evaluate(
        """[
        () => cube.reflectances([1, 1], [550]),
        () => cube.reflectances(1, [550]),
        () => cube.reflectances([1, 1, 1], 550),
        () => cube.reflectances([1, 1, 1]),
        () => cube.standardError(),
        () => cube.reflectances(new Uint8ClampedArray([1, 0, 1]), [550]),
        () => cube.coefficients([1.00001, 0, 0]),
        () => cube.errorBound([-0.1, NaN, 0]),
        () => cube.reflectances([1, 1, null], [550]),
        () => cube.reflectances([1, 1, 1], [0.45, 0.55]),
        () => cube.reflectances([1, 1, 1], [550e-9]),
        ].map(call => { try { call(); } catch (error) { return error.name; } })"""
    )
    assert names == ["RangeError"] * 11


def test_what_a_cube_is_opened_from(evaluate):
    """Bytes, what has them, an address or, in node, a file."""
    rows = evaluate(
        """Promise.all([
        file,
        new Uint8Array([0, ...file, 0]).subarray(1, file.length + 1),
        Uint8Array.from(file).buffer,
        "data:;base64," + file.toString("base64"),
        new Blob([file]), new Response(file), Promise.resolve(file),
        path, new URL("file:" + path), "file:" + path,
        ].map(async source => (await uplift.open(source)).standardError([0, 1, 0])[0]))
        """
    )
    assert len(set(rows)) == 1
    results = evaluate(
        """Promise.all([
        new ArrayBuffer(0), file.subarray(0, 99), file.map(byte => byte ^ 1),
        "data:;base64,AAAA", "absent.uplift", "file:///absent.uplift",
        new Response("", { status: 404 }), "http://127.0.0.1:1", undefined, {}
        ].map(source => uplift.open(source).catch(error => error)))
        .then(errors => errors.map(error => [error.name, error.result]))"""
    )
    damaged, unread, other = (
        [["CubeError", 3]],
        [["CubeError", 1]],
        [["TypeError", None]],
    )
    assert results == damaged * 4 + unread * 4 + other * 2


def test_in_a_browser(repository, small_cube):
    need(CHROMIUM)
    content = (repository / "cubes" / "moments-8-macbeth.uplift").read_bytes()
    addresses = [
        f"data:{kind};base64,{base64.b64encode(text).decode()}"
        for kind, text in (
            ("text/javascript", compose_module().encode()),
            ("", content),
        )
    ]
    module, cube = map(json.dumps, addresses)
    with browser() as tab:
        found = tab.evaluate(
            f"""import({module})
            .then(uplift => uplift.open({cube}))
            .then(cube => [...cube.reflectances({COLOURS}, {AT})])"""
        )
        assert tab.errors == []
    rgb = np.reshape(COLOURS, (2, 3))
    expected = small_cube.reflectance(rgb, np.array(AT, float), mode="spectra")
    assert_allclose(np.reshape(found, (2, 4)), expected, atol=2e-5)
