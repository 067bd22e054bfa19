"""What scene descriptions may say, and what comes of it."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from uplift.common.errors import OptionError
from uplift.io.mitsuba import register
from uplift.lookup import load

COLOUR = [0.5, 0.25, 0.1]
WAVELENGTHS = np.arange(362.5, 830, 50)


@pytest.mark.parametrize("given", [COLOUR, tuple(COLOUR), np.array(COLOUR), "0.5, 0.25, 0.1", "0.5 0.25 0.1"])
def test_a_colour_is_answered_as_the_cube_answers_it(mi, stored, spectrum, small_cube, given):
    texture = mi.load_dict({"type": "uplift", "cube": stored, "rgb": given})
    expected = small_cube.reflectance(COLOUR, WAVELENGTHS)
    np.testing.assert_allclose(spectrum(texture, (0, 0), WAVELENGTHS), expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("tag", ["rgb", "string"])
def test_scenes_may_be_written_as_xml(mi, stored, tag):
    colour = f'<{tag} name="rgb" value="0.5, 0.25, 0.1"/>'
    texture = (
        f'<texture type="uplift" name="reflectance"><string name="cube" value="{stored}"/>{colour}</texture>'
    )
    scene = mi.load_string(f'<scene version="3.0.0"><bsdf type="diffuse">{texture}</bsdf></scene>')
    assert "RegularSpectrum" in str(scene)


def test_the_default_cube_needs_no_name(mi, spectrum):
    texture = mi.load_dict({"type": "uplift", "rgb": COLOUR})
    expected = load().reflectance(COLOUR, WAVELENGTHS)
    np.testing.assert_allclose(spectrum(texture, (0, 0), WAVELENGTHS), expected, rtol=0, atol=1e-4)


def test_cubes_are_sought_as_mitsuba_seeks_files(mi, repository):
    mi.file_resolver().prepend(str(repository / "cubes"))
    assert mi.load_dict({"type": "uplift", "cube": "moments-8.uplift", "rgb": COLOUR})


def test_a_cube_that_changed_is_read_again(mi, tmp_path, spectrum, plain_cube, small_sigmoid_cube):
    found = []
    for cube in (plain_cube, small_sigmoid_cube):
        cube.save(tmp_path / "cube.uplift", force=True)
        texture = mi.load_dict({"type": "uplift", "cube": str(tmp_path / "cube.uplift"), "rgb": COLOUR})
        found.append(spectrum(texture, (0, 0), [500])[0])
        assert found[-1] == pytest.approx(cube.reflectance(COLOUR, [500])[0], abs=1e-4)
    assert abs(found[0] - found[1]) > 1e-3


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({}, "takes one of rgb, filename, bitmap, not 0"),
        ({"rgb": COLOUR, "filename": "image.png"}, "takes one of rgb, filename, bitmap, not 2"),
        ({"rgb": "red"}, "rgb is three numbers, not 'red'"),
        ({"rgb": "0.5 0.5"}, "rgb is three numbers"),
        ({"rgb": [0.5, 0.5, 2.0]}, r"lies outside \[0, 1\]"),
        ({"rgb": COLOUR, "cube": "missing.uplift"}, "missing.uplift: no such file"),
        ({"rgb": COLOUR, "wrap": "clamp"}, "unreferenced"),
        ({"filename": "missing.png"}, "No such file"),
    ],
)
def test_mistakes_are_named(mi, wrong, told):
    with pytest.raises(RuntimeError, match=told):
        mi.load_dict({"type": "uplift", **wrong})


def test_a_variant_without_spectra_is_refused(mi):
    mi.set_variant("scalar_rgb")
    try:
        with pytest.raises(OptionError, match="scalar_rgb has no plain spectra; set scalar_spectral"):
            register()
    finally:
        mi.set_variant("scalar_spectral")


def test_without_mitsuba_it_says_where_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    with pytest.raises(OptionError, match="not installed; 'pip install mitsuba' brings it"):
        register()
