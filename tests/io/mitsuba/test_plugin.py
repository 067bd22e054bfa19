"""Scene descriptions: properties, defaults and errors."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from tests.helpers import raises
from uplift.common.errors import OptionError
from uplift.io.mitsuba import register
from uplift.lookup import load

COLOUR = [0.5, 0.25, 0.1]
WAVELENGTHS = np.arange(362.5, 830, 50)


@pytest.mark.parametrize("rgb", [COLOUR, np.array(COLOUR), "0.5, 0.25, 0.1", "0.5 0.25 0.1"])
@pytest.mark.parametrize("is_default", [True, False])
def test_a_colour_has_the_spectrum_of_the_cube(mi, cube_path, spectrum, small_cube, rgb, is_default):
    texture = mi.load_dict({"type": "uplift", "rgb": rgb, **({} if is_default else {"cube": cube_path})})
    expected = (load() if is_default else small_cube).reflectance(COLOUR, WAVELENGTHS)
    np.testing.assert_allclose(spectrum(texture, (0, 0), WAVELENGTHS), expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("tag", ["rgb", "string"])
def test_scenes_can_be_xml_and_cubes_are_found_by_the_file_resolver(mi, repository, tag):
    mi.file_resolver().prepend(str(repository / "cubes"))
    colour = f'<{tag} name="rgb" value="0.5, 0.25, 0.1"/><string name="cube" value="moments-8.uplift"/>'
    texture = f'<texture type="uplift" name="reflectance">{colour}</texture>'
    scene = mi.load_string(f'<scene version="3.0.0"><bsdf type="diffuse">{texture}</bsdf></scene>')
    assert "RegularSpectrum" in str(scene)


def test_a_modified_cube_is_read_again(mi, tmp_path, spectrum, plain_cube, small_sigmoid_cube):
    found = []
    for cube in (plain_cube, small_sigmoid_cube):
        cube.save(tmp_path / "cube.uplift", force=True)
        texture = mi.load_dict({"type": "uplift", "cube": str(tmp_path / "cube.uplift"), "rgb": COLOUR})
        found.append(spectrum(texture, (0, 0), [500])[0])
        assert found[-1] == pytest.approx(cube.reflectance(COLOUR, [500])[0], abs=1e-4)
    assert abs(found[0] - found[1]) > 1e-3


@pytest.mark.parametrize(
    ("properties", "message"),
    [
        ({}, "must have one of rgb, filename, bitmap, got 0"),
        ({"rgb": COLOUR, "filename": "image.png"}, "must have one of rgb, filename, bitmap, got 2"),
        ({"rgb": "red"}, "rgb must be three numbers, got 'red'"),
        ({"rgb": "0.5 0.5"}, "rgb must be three numbers"),
        ({"rgb": [0.5, 0.5, 2.0]}, r"lies outside \[0, 1\]"),
        ({"rgb": COLOUR, "cube": "missing.uplift"}, "missing.uplift: "),
        ({"rgb": COLOUR, "wrap": "clamp"}, "unreferenced"),
        ({"filename": "missing.png"}, "No such file"),
    ],
)
def test_invalid_properties_raise(mi, properties, message):
    with pytest.raises(RuntimeError, match=message):
        mi.load_dict({"type": "uplift", **properties})


def test_a_variant_without_spectra_raises(mi):
    mi.set_variant("scalar_rgb")
    try:
        with raises(OptionError, "unsupported-variant"):
            register()
    finally:
        mi.set_variant("scalar_spectral")


def test_missing_mitsuba_raises(monkeypatch):
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    with raises(OptionError, "mitsuba-not-installed"):
        register()
