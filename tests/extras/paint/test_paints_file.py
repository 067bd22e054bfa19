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
    assert stored.names == paints.names
    assert stored.surface == paints.surface
    assert stored.is_to_scale == paints.is_to_scale
    assert_array_equal(stored.wavelengths, paints.wavelengths)
    assert_array_equal(stored.prices, paints.prices)
    for ours, theirs in (
        (stored.pigments, paints.pigments),
        (stored.errors, paints.errors),
    ):
        assert_allclose(ours.absorption, theirs.absorption, rtol=5e-9)
        assert_allclose(ours.scattering, theirs.scattering, rtol=5e-9)
    assert to_toml(stored) == path.read_text("utf-8")


def test_a_file_by_hand_needs_little(path):
    path.write_text(f"{TEXT}absorption-errors = {ROW}\n{SECOND}")
    stored = read_paints(path)
    assert stored.names == ("grey", "black")
    assert (stored.surface.outside, stored.surface.inside) == (0, 0)
    assert (stored.errors, stored.prices, stored.is_to_scale) == (None, (), True)


def changed(old, new):
    assert old in TEXT
    return TEXT.replace(old, new, 1)


def row(name, values):
    return changed(f"{name} = {ROW}", f"{name} = {values}")


MALFORMED = {
    "another format": changed("paints 1", "paints 2"),
    "no format": changed('format = "uplift paints 1"\n', ""),
    "unknown key of a paint": TEXT + "scatter = 1\n",
    "no paints": TEXT[: TEXT.index("[[paints]]")],
    "short row": row("absorption", ROW[:-1]),
    "short errors": TEXT + f"absorption-errors = {ROW[:-1]}\n",
    "huge": row("absorption", [1e13, *ROW[1:]]),
    "negative": row("scattering", [-0.1, *ROW[1:]]),
    "neither absorbs nor scatters": TEXT.replace("[0.5,", "[0.0,"),
    "descending": changed(str(GRID), str(GRID[::-1])),
    "uneven": changed(str(GRID), str([*GRID[:-1], 701.0])),
    "from 420 nm": changed(str(GRID), str([nm + 20 for nm in GRID])),
    "coarse": changed(str(GRID), str([400 + 30 * step for step in range(16)])),
    "surface of 1": changed("[[paints]]", "[surface]\ninside = 1.0\n[[paints]]"),
    "negative price": TEXT + "price = -1\n",
    "empty name": changed('"grey"', '""'),
    "two lines": changed('"grey"', '"a\\nb"'),
    "two of a name": TEXT + SECOND.replace("black", "grey"),
}


@pytest.mark.parametrize("text", MALFORMED.values(), ids=MALFORMED)
def test_malformed_files_raise(path, text):
    path.write_text(text)
    with raises(PaintError, "invalid-file") as caught:
        read_paints(path)
    assert caught.value.path == path
