"""Exported mixers: the same numbers as in Python, and defined ones for bad input."""

from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.paint import run_mixer
from tests.helpers import output_of, raises
from tests.parts import NODE, need
from uplift.common.errors import UnknownNameError
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.paint.mixer_programs import write_mixer
from uplift.extras.paint.rgb_mixer import make_mixer

SUFFIXES = {"mixer-c": ".h", "mixer-glsl": ".glsl", "mixer-js": ".mjs"}
DIM = 9


@pytest.fixture(scope="module")
def mixer(small_cube):
    return make_mixer(small_cube, DIM)


@pytest.fixture(scope="module")
def folder(small_cube, tmp_path_factory):
    """Folder of a mixer in all languages."""
    folder = tmp_path_factory.mktemp("mixer")
    for style, suffix in SUFFIXES.items():
        write_mixer(small_cube, folder / f"paint{suffix}", style=style, res=DIM)
    return folder


@pytest.fixture
def pairs(rng):
    """Pairs (484, 2, 3), with corners of the cube."""
    colours = rng.random((484, 2, 3))
    colours[:100] = colours[:100].round()
    return colours.astype(np.float32).astype(float)


@pytest.fixture
def shares(rng):
    shares = rng.random(484)
    shares[::10] = 0
    shares[1::10] = 1
    return shares.astype(np.float32).astype(float)


SANITIZED = partial(run_mixer.c, compiler="sanitized")
FAST = partial(run_mixer.c, compiler="fast")
PROGRAMS = [
    (run_mixer.c, ".h", 5e-6),
    (partial(run_mixer.c, compiler="cpp"), ".h", 5e-6),
    (SANITIZED, ".h", 5e-6),
    (run_mixer.js, ".mjs", 1e-9),
]


@pytest.mark.parametrize(("run", "suffix", "tolerance"), PROGRAMS)
def test_programs_mix_as_python(folder, mixer, pairs, shares, run, suffix, tolerance):
    found = run(folder / f"paint{suffix}", pairs, shares)
    expected = mixer.mix(pairs[:, 0], pairs[:, 1], shares)
    assert_allclose(found[:, 0], expected, atol=tolerance)
    assert_allclose(found[:, 1], expected, atol=tolerance)
    codes = encode(mixer.mix(decode(pairs[:, 0]), decode(pairs[:, 1]), shares))
    assert_allclose(found[:, 2], codes, atol=1e-4)


def test_the_shader_mixes_as_python(folder, mixer, pairs, shares):
    """With a table of half floats; its ends are exact all the same."""
    found = run_mixer.glsl(folder / "paint.glsl", pairs, shares, DIM)
    expected = mixer.mix(pairs[:, 0], pairs[:, 1], shares)
    assert_allclose(encode(found), encode(expected), atol=0.004)
    at_end = shares == shares.round()
    assert_allclose(found[at_end], expected[at_end], atol=1e-5)


def test_bytes_end_at_their_colours(folder, rng):
    codes = rng.integers(0, 256, (400, 2, 3))
    codes[:256, 0] = np.arange(256)[:, None]
    assert_array_equal(run_mixer.ends_of_bytes(folder / "paint.h", codes), codes)


def test_numbers_outside_are_clipped(folder):
    path = folder / "paint.h"
    pairs = np.array([[[-1, 2, 0.5], [0.2, 0.4, 0.6]]] * 3)
    shares = np.array([0.5, -3, 1e30])
    clipped = SANITIZED(path, np.clip(pairs, 0, 1), np.clip(shares, 0, 1))
    assert_array_equal(SANITIZED(path, pairs, shares)[:, [0, 2]], clipped[:, [0, 2]])


@pytest.mark.parametrize("run", [SANITIZED, FAST])
def test_what_is_not_a_number_is_0(folder, run):
    path = folder / "paint.h"
    bad = np.array([[[np.nan] * 3] * 2, [[np.inf, 0.5, -np.inf]] * 2])
    found = run(path, bad, np.array([np.nan, 0.5]))
    zero = run(path, np.nan_to_num(bad, posinf=1, neginf=0), np.array([0, 0.5]))
    assert_array_equal(found[:, 0], zero[:, 0])
    assert_array_equal(found[0, 1], 0)  # no positive part


@pytest.mark.parametrize(
    "call",
    [
        "mix([NaN, 0, 0], [0, 0, 0], 0)",
        "mix([0, 0, 0], [1, 1, 1], 50)",
        "mixSrgb([0, 33, 133], [252, 211, 0], 0.5)",
        "mixAll([[1, 1]], [1])",
    ],
)
def test_numbers_outside_are_refused_in_javascript(folder, call):
    need(NODE)
    (folder / "outside.mjs").write_text(
        "import { mix, mixAll, mixSrgb } from './paint.mjs';\n"
        f"let name = null;\ntry {{ {call}; }} catch (error) {{ name = error.name; }}\n"
        "console.log(name);\n"
    )
    assert output_of("node", folder / "outside.mjs") == "RangeError\n"


def test_other_styles_are_refused(small_cube, tmp_path):
    with raises(UnknownNameError, "unknown-name"):
        write_mixer(small_cube, tmp_path / "a.h", style="mixer-rust")
