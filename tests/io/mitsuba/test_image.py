"""Images as textures: position, filtering and decoding of texels, in scalar and JIT variants."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

IMAGE = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
POSITIONS = [(0.1, 0.2), (0.83, 0.4), (0.999, 0.001), (0.5, 0.5), (1.3, -0.7), (-0.2, 1.9)]
WITHIN = 1e-5
"""Tolerance of linear RGB in single precision."""


@pytest.fixture
def texture(mi, cube_path):
    """Function that makes a texture, by default of `IMAGE`."""

    def texture(image=IMAGE, **options):
        return mi.load_dict({"type": "uplift", "cube": cube_path, "bitmap": mi.Bitmap(image), **options})

    return texture


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"filter_type": "nearest"},
        {"wrap_mode": "mirror"},
        {"wrap_mode": "clamp"},
        {"filter_type": "nearest", "wrap_mode": "clamp"},
    ],
)
def test_filtering_agrees_with_mitsuba_s_bitmap(mi, texture, spectrum, sensor, options):
    import drjit

    ours, reference = (
        texture(**options),
        mi.load_dict({"type": "bitmap", "bitmap": mi.Bitmap(IMAGE), "raw": True, **options}),
    )
    si = drjit.zeros(mi.SurfaceInteraction3f)
    for uv in POSITIONS:
        si.uv = mi.Point2f(*uv)
        found = sensor.rgb(spectrum(ours, uv, sensor.wavelengths))
        np.testing.assert_allclose(found, np.array(reference.eval_3(si)), rtol=0, atol=WITHIN)


@pytest.mark.parametrize("matrix", ["ScalarTransform3f", "ScalarTransform4f"])
def test_uv_are_transformed(mi, texture, spectrum, matrix):
    scale = [2, 3] if matrix == "ScalarTransform3f" else [2, 3, 1]
    moved = texture(to_uv=getattr(mi, matrix)().scale(scale))
    assert spectrum(moved, (0.1, 0.2), [500]) == pytest.approx(
        spectrum(texture(), (0.2, 0.6), [500]), abs=1e-6
    )


def test_filtering_blends_spectra_not_multipliers(texture, spectrum, small_cube):
    """Halfway between a dark and a light texel."""
    image = np.array([[[0.01, 0.01, 0.2], [0.9, 0.9, 0.1]]], dtype=np.float32)
    assert not small_cube.data.entry_boxes.find(image[0].astype(float)).rows.size
    ends = small_cube.reflectance(image[0], [500, 600], mode="refined")
    found = spectrum(texture(image, wrap_mode="clamp"), (0.5, 0.5), [500, 600])
    np.testing.assert_allclose(found, ends.mean(axis=0), atol=1e-5)


def test_a_texel_of_an_entry_s_colour_has_the_entry_s_spectrum(texture, spectrum, small_cube):
    """The other texels of the image keep theirs, though they have more multipliers than without the entry."""
    atlas = small_cube.data.atlas
    image = np.array([[atlas.rgb[3], [0.01, 0.01, 0.2]]], dtype=np.float32)
    found = texture(image, filter_type="nearest")
    entry = small_cube.data.entry_spectra.reflectance(np.array([3]), np.array([450.0, 650.0]))[0]
    np.testing.assert_allclose(spectrum(found, (0.25, 0.5), [450, 650]), entry, atol=1e-5)
    other = small_cube.reflectance(image[0, 1], [450, 650], mode="refined")
    np.testing.assert_allclose(spectrum(found, (0.75, 0.5), [450, 650]), other, atol=1e-5)


def test_only_encoded_files_are_decoded(mi, texture, spectrum, small_cube, tmp_path, cube_path):
    codes = np.array([[[200, 30, 90]]], dtype=np.uint8)
    linear = small_cube.decode(codes).astype(np.float32)
    mi.Bitmap(codes).write(str(tmp_path / "image.png"))
    mi.Bitmap(linear).write(str(tmp_path / "image.exr"))
    expected = small_cube.reflectance(linear[0, 0], [450, 650], mode="refined")
    for name in ("image.png", "image.exr"):
        found = mi.load_dict({"type": "uplift", "cube": cube_path, "filename": str(tmp_path / name)})
        np.testing.assert_allclose(spectrum(found, (0.5, 0.5), [450, 650]), expected, atol=1e-5)


def test_interface_of_textures(texture, small_cube):
    found = texture()
    assert found.is_spatially_varying()
    assert tuple(found.resolution()) == (4, 3)
    expected = small_cube.reflectance(IMAGE, mode="refined")
    assert found.mean() == pytest.approx(expected.mean(), abs=0.02)
    assert "4 × 3, moments, 17 multipliers, repeat" in str(found)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"wrap_mode": "round"}, "unknown wrap_mode 'round'; use one of repeat, mirror, clamp"),
        ({"filter_type": "cubic"}, "unknown filter_type 'cubic'"),
        ({"image": 2 * IMAGE}, r"lies outside \[0, 1\]"),
        ({"image": IMAGE * np.nan}, r"lies outside \[0, 1\]"),
    ],
)
def test_invalid_properties_raise(texture, options, message):
    with pytest.raises(RuntimeError, match=message):
        texture(**options)


JIT = """
import sys
import drjit, mitsuba as mi, numpy as np
from uplift.io.mitsuba import register
mi.set_variant("llvm_ad_spectral")
register()
image = np.random.default_rng(8).random((3, 4, 3), dtype=np.float32)
texture = mi.load_dict({"type": "uplift", "cube": sys.argv[1], "bitmap": mi.Bitmap(image)})
si = drjit.zeros(mi.SurfaceInteraction3f, 6)
si.uv = mi.Point2f([0.1, 0.83, 0.999, 0.5, 1.3, -0.2], [0.2, 0.4, 0.001, 0.5, -0.7, 1.9])
si.wavelengths = mi.Spectrum(400, 500, 600, 700)
print(*np.array(texture.eval(si)).T.ravel())
"""


def test_a_wavefront_agrees_with_single_rays(texture, spectrum, cube_path):
    """Runs in a subprocess, because an LLVM too old for Mitsuba ends the process."""
    done = subprocess.run([sys.executable, "-c", JIT, cube_path], capture_output=True, text=True)
    if done.returncode and "LLVM" in done.stderr:
        pytest.skip("Mitsuba finds no usable LLVM")
    assert not done.returncode, done.stderr
    found = np.array(done.stdout.split(), dtype=float).reshape(6, 4)
    one_by_one = [spectrum(texture(), uv, [400, 500, 600, 700]) for uv in POSITIONS]
    np.testing.assert_allclose(found, one_by_one, atol=1e-5)
