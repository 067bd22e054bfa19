"""rgb2spec table: layout, and agreement of its readers."""

from __future__ import annotations

import struct
import subprocess
import sys
from itertools import product

import colour
import numpy as np
import pytest

from tests.helpers import raises
from tests.parts import MITSUBA, need
from uplift.common.errors import OptionError
from uplift.io.export import write_coeff

RES = 5


@pytest.fixture(scope="module")
def table(tmp_path_factory, small_cube):
    """Path of a small table."""
    path = tmp_path_factory.mktemp("coeff") / "data" / "srgb.coeff"
    path.parent.mkdir()
    assert write_coeff(small_cube.data, path, res=RES) < 2e-5
    return path


def spectra(coefficients, wavelengths):
    """Evaluate reflectance (n, N) of coefficients (n, 3) by the formula of the paper."""
    x = coefficients @ np.stack([wavelengths**2, wavelengths, np.ones_like(wavelengths)])
    return 0.5 + x / (2 * np.sqrt(1 + x * x))


def test_every_number_is_at_its_documented_offset(table, sensor):
    """Read numbers one by one, without numpy's shapes."""
    content = table.read_bytes()
    assert content[:4] == b"SPEC"
    assert struct.unpack_from("<I", content, 4) == (RES,)
    scale = struct.unpack_from(f"<{RES}f", content, 8)
    assert (scale[0], scale[-1]) == (0, 1)
    at = 8 + 4 * RES
    for largest, level, second, first in product(range(3), scale, range(RES), range(RES)):
        rgb = np.roll([level, first / (RES - 1) * level, second / (RES - 1) * level], largest)
        coefficients = np.array([struct.unpack_from("<3f", content, at)])
        at += 12
        found = sensor.rgb(spectra(coefficients, sensor.wavelengths))[0]
        np.testing.assert_allclose(found, rgb, rtol=0, atol=2e-5)
    count = len(sensor.wavelengths)
    assert struct.unpack_from("<I", content, at) == (count,)
    wavelengths, *rows = np.frombuffer(content, "<f4", 4 * count, at + 4).reshape(4, -1)
    np.testing.assert_allclose(360 + 470 * wavelengths, sensor.wavelengths, rtol=1e-6)
    np.testing.assert_allclose(rows, sensor.matrix, atol=1e-7)
    rest = np.frombuffer(content, "<f4", offset=at + 4 + 16 * count)
    np.testing.assert_allclose(rest[:9].reshape(3, 3) @ np.ones(3), rest[9:], rtol=1e-6)
    np.testing.assert_allclose(rest[9:], sensor.light.white, rtol=1e-3)


FETCH = """
import sys
import mitsuba as mi
mi.set_variant("scalar_spectral")
mi.file_resolver().prepend(sys.argv[1])
level = float(sys.argv[2])
for rgb in ([1, 0.25, 0.5], [0.75, 1, 0]):
    print(*mi.srgb_model_fetch([level * x for x in rgb]))
"""


def test_colour_science_and_mitsuba_read_it(table, sensor):
    """Mitsuba finds data/srgb.coeff by its file resolver, in the folder prepended here first."""
    need(MITSUBA)
    level = struct.unpack_from(f"<{RES}f", table.read_bytes(), 8)[3]

    def fetch(folder):
        args = [sys.executable, "-c", FETCH, str(folder), str(level)]
        done = subprocess.run(args, capture_output=True, text=True, check=True)
        return np.array([line.split() for line in done.stdout.splitlines()], dtype=float)

    ours, default = fetch(table.parents[1]), fetch(table.parent)
    assert not np.allclose(ours, default, rtol=1e-4)
    reader = colour.recovery.LUT3D_Jakob2019()
    reader.read(table)
    rgb = level * np.array([[1, 0.25, 0.5], [0.75, 1, 0]])
    np.testing.assert_allclose(ours, reader.RGB_to_coefficients(rgb), rtol=1e-4)
    found = sensor.rgb(spectra(ours, sensor.wavelengths))
    np.testing.assert_allclose(found, rgb, rtol=0, atol=1e-4)


@pytest.mark.parametrize("res", [1, 257])
def test_res_out_of_range_raises(small_cube, tmp_path, res):
    with raises(OptionError, "option"):
        write_coeff(small_cube.data, tmp_path / "table.coeff", res=res)
    assert not list(tmp_path.iterdir())
