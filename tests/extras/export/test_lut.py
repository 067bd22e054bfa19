"""Relighting as a look-up table, as OpenColorIO reads and applies it."""

import numpy as np
import PyOpenColorIO
import pytest
from numpy.testing import assert_allclose

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import sensor
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export.lut import write_lut

LIGHT = "HP1"
NODES = np.random.default_rng(1).integers(0, 9, (60, 3)) / 8
OTHERS = np.random.default_rng(2).random((1 << 14, 3))


def apply(path, colours):
    """Apply a file to colours (n, 3) with a library that knows nothing of uplift."""
    transform = PyOpenColorIO.FileTransform(
        str(path), interpolation=PyOpenColorIO.INTERP_TETRAHEDRAL
    )
    pixels = colours.astype(np.float32)
    PyOpenColorIO.Config.CreateRaw().getProcessor(
        transform
    ).getDefaultCPUProcessor().applyRGB(pixels)
    return pixels.astype(float)


def expected(cube, linear, light=LIGHT):
    """Linear RGB of the spectra of linear RGB, with the white of the light as white."""
    screen = sensor("sRGB", light)
    return cube.reflectance(linear, screen.wavelengths) @ screen.matrix.T


def test_a_table_of_codes_holds_the_relit_colours(small_cube, tmp_path):
    write_lut(small_cube, LIGHT, tmp_path / "relight.cube", res=9)
    right = expected(small_cube, decode(NODES))
    inside = (right >= 0) & (right <= 1)
    assert inside.mean() > 0.85
    assert_allclose(
        apply(tmp_path / "relight.cube", NODES)[inside],
        encode(right)[inside],
        atol=1e-6,
    )


@pytest.mark.parametrize(
    ("name", "light", "res"),
    [("small_cube", LIGHT, 33), ("small_sigmoid_cube", "FL11", 17)],
)
def test_a_clf_file_takes_linear_colours_and_states_its_largest_error(
    request, tmp_path, name, light, res
):
    """Independent colours do not exceed it, and the colour with the largest error has
    it.
    """
    cube = request.getfixturevalue(name)
    error = write_lut(cube, light, tmp_path / "relight.clf", res=res)
    pairs = OTHERS[
        :, [0, 1, 1]
    ]  # of two equal components, where the error of tetrahedra is large
    linear = np.concatenate([decode(OTHERS), decode(pairs), [error.worst]])
    found = apply(tmp_path / "relight.clf", linear)
    right = expected(cube, linear, light)
    measured = delta_e_rgb(sensor("sRGB", light), found, right)
    assert_allclose(measured[: len(OTHERS)].mean(), error.mean, rtol=0.1)
    assert measured[:-1].max() < error.largest
    assert_allclose(measured[-1], error.largest, rtol=0.02)


def test_greys_stay_grey_only_if_the_light_is_adapted(small_cube, tmp_path):
    white = np.ones((1, 3))
    write_lut(small_cube, LIGHT, tmp_path / "adapted.clf", res=3)
    assert_allclose(apply(tmp_path / "adapted.clf", white), 1, atol=1e-4)
    write_lut(small_cube, LIGHT, tmp_path / "tinted.clf", res=3, adapt=False)
    own = small_cube.data.sensor
    tint = own.xyz_to_rgb @ sensor("sRGB", LIGHT).light.white
    assert_allclose(
        apply(tmp_path / "tinted.clf", white)[0], tint, rtol=1e-4, atol=1e-6
    )
