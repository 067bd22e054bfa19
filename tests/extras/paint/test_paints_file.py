"""Files of paints: what is written is read, and what does not fit raises."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.extras.paint.invented import invented
from tests.helpers import raises
from uplift.common.errors import PaintError
from uplift.extras.paint.paints_file import read_paints, to_toml, write_paints
from uplift.extras.paint.pigments import Pigment

GRID = [400.0 + 20 * step for step in range(16)]
ROW = [0.5] * 16
TEXT = f"""format = "uplift paints 1"
wavelengths = {GRID}
[[paints]]
name = "grey"
absorption = {ROW}
scattering = {ROW}
"""
SECOND = f"""[[paints]]
name = "black"
absorption = {ROW}
scattering = {ROW}
"""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "paints.toml"


@pytest.fixture
def paints():
    """Paints with errors and two prices, whose names need escapes."""
    plain = invented()
    errors = np.random.default_rng(4).random((2, 4, 16))
    return replace(
        plain,
        names=('5" \\brush', "Kobältblau", "[[paints]]", "a = 1 # \t\x85"),
        errors=Pigment(*errors),
        prices=(0.35, np.nan, 12.0, np.nan),
        is_to_scale=False,
    )


def test_paints_round_trip(paints, path):
    write_paints(paints, path)
    stored = read_paints(path)
    assert to_toml(stored) == path.read_text("utf-8")
    assert stored.names == paints.names
    assert stored.surface == paints.surface
    assert stored.is_to_scale == paints.is_to_scale
    assert_array_equal(stored.wavelengths, paints.wavelengths)
    assert_array_equal(stored.prices, paints.prices)
    for ours, theirs in zip(stored.rows(), paints.rows(), strict=True):
        for key in ("absorption", "scattering", "absorption_errors"):
            assert_allclose(ours[key], theirs[key], rtol=5e-9)


def test_a_file_by_hand_needs_little(path):
    path.write_text(f"{TEXT}absorption-errors = {ROW}\n{SECOND}")
    stored = read_paints(path)
    assert stored.names == ("grey", "black")
    assert (stored.surface.outside, stored.surface.inside) == (0, 0)
    assert (stored.errors, stored.prices, stored.is_to_scale) == (None, (), True)


COARSE = [400 + 30 * step for step in range(16)]
SHIFTED = [nm + 20 for nm in GRID]
MALFORMED = {
    "another format": TEXT.replace("paints 1", "paints 2"),
    "no paints": TEXT[: TEXT.index("[[paints]]")],
    "short row": TEXT.replace("absorption = [0.5, ", "absorption = ["),
    "huge": TEXT.replace("absorption = [0.5", "absorption = [1e13"),
    "negative": TEXT.replace("scattering = [0.5", "scattering = [-0.1"),
    "neither absorbs nor scatters": TEXT.replace("[0.5,", "[0.0,"),
    "descending": TEXT.replace(str(GRID), str(GRID[::-1])),
    "uneven": TEXT.replace("700.0", "701.0"),
    "from 420 nm": TEXT.replace(str(GRID), str(SHIFTED)),
    "coarse": TEXT.replace(str(GRID), str(COARSE)),
    "surface of 1": TEXT.replace("[[paints]]", "[surface]\ninside = 1\n[[paints]]"),
    "negative price": TEXT + "price = -1\n",
    "empty name": TEXT.replace("grey", ""),
    "two lines": TEXT.replace("grey", "a\\nb"),
    "two of a name": TEXT + SECOND.replace("black", "grey"),
}


@pytest.mark.parametrize("text", MALFORMED.values(), ids=MALFORMED)
def test_malformed_files_raise(path, text):
    path.write_text(text)
    with raises(PaintError, "invalid-file") as caught:
        read_paints(path)
    assert caught.value.path == path
