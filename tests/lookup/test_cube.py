"""Queries of a cube: shapes, types of input, blocks and threads, 8-bit codes, files by
name, and invalid arguments.
"""

from dataclasses import replace
from functools import partial

import colour
import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift import bulk, load, load_emission, read_atlas
from uplift.atlas.resampling import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000
from uplift.colorimetry.illuminants import Lamp
from uplift.common.errors import ColourError, OptionError, UpliftError
from uplift.extras.photographs.samples import prepare_samples
from uplift.lookup.blocks import BLOCK
from uplift.lookup.cube import DEFAULT, PACKAGED, find_file
from uplift.lookup.interpolate import MODES

RED = (0.6, 0.03, 0.01)
AT = [450.0, 550.0, 650.0]


@pytest.fixture(params=MODES)
def mode(request):
    return request.param


@pytest.mark.parametrize("shape", [(), (5,), (2, 0), (4, 1, 2)])
def test_reflectance_keeps_the_shape_of_the_input(small_cube, mode, shape):
    rgb = np.full((*shape, 3), 0.3)
    assert small_cube.reflectance(rgb, mode=mode).shape == (*shape, 81)
    assert small_cube.reflectance(rgb, [500, 600], mode).shape == (*shape, 2)
    assert small_cube.coefficients(rgb).shape == (*shape, 9)


def test_rounding_moves_no_colour_out_of_gamut_and_no_input(small_cube, mode):
    inside = np.array([(1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (1.0, 0.5, 0.0)])
    for off in (9e-7, -9e-7):
        rgb = inside + off
        before = rgb.copy()
        found = small_cube.reflectance(rgb, mode=mode)
        assert_array_equal(rgb, before)
        expected = small_cube.reflectance(np.clip(rgb, 0, 1), mode=mode)
        assert_array_equal(found, expected)
    for value in (1.0000011, -1.1e-6):
        with raises(ColourError, "rgb-out-of-gamut") as caught:
            small_cube.reflectance([value, 0, 0], mode=mode)
        assert f"{value:.7g}" in caught.value.problem


def test_answers_do_not_depend_on_threads_and_tables_and_hardly_on_precision(
    small_cube, mode, monkeypatch
):
    colours = np.random.default_rng(0).random((2 * BLOCK + 5, 3))
    rgb = np.concatenate([colours, small_cube.data.atlas.rgb])
    expected = small_cube.reflectance(rgb, AT, mode)
    assert_array_equal(small_cube.reflectance(rgb, AT, mode, threads=3), expected)
    for count in (3, len(rgb)):
        single = small_cube.reflectance(rgb[:count], AT, mode, dtype=np.float32)
        assert single.dtype == np.float32
        assert ((single >= 0) & (single <= 1)).all()
        assert_allclose(single, expected[:count], rtol=0, atol=1e-6)
    monkeypatch.setattr("uplift.lookup.cube.MAX_TABLE_BYTES", 0)
    found = small_cube.reflectance(rgb, AT, mode)
    assert_allclose(found, expected, rtol=0, atol=1e-14)


NAN = np.nan
COLOURS = [
    *((NAN, 0, 0), (-0.001, 0, 0), 0.5, (0.5, 0.5), (0.5,) * 4, [], "red", None),
    [[0.5, 0.5, 0.5], [0.5, 0.5]],
    np.zeros((3, 2)),
]


@pytest.mark.parametrize("rgb", COLOURS, ids=str)
def test_invalid_colours_are_refused(small_cube, rgb):
    for function in (
        small_cube.reflectance,
        small_cube.coefficients,
        small_cube.covers,
        small_cube.standard_error,
        bulk.spectra(small_cube, AT),
    ):
        with raises(ColourError) as caught:
            function(rgb)
        assert "\n" not in str(caught.value)


WAVELENGTHS = [[], [500, NAN], [99.9], [5001], "red", [[400, 500], [600, 700]], {}]


@pytest.mark.parametrize(
    ("name", "value", "code"),
    [
        *(("mode", value, "unknown-name") for value in ("Spectra", None)),
        *(("wavelengths", value, "option") for value in WAVELENGTHS),
        *(("dtype", value, "option") for value in (np.float16, int, object, 3)),
        *(("threads", value, "option") for value in (0, 1.0, "2", None, True)),
        *(("count", value, "option") for value in (0, 10, 17.5, "nine", True)),
    ],
)
def test_invalid_arguments_are_refused(small_cube, name, value, code):
    function = small_cube.coefficients if name == "count" else small_cube.reflectance
    with raises(UpliftError, code):
        function(RED, **{name: value})


MASKED = np.ma.array([0.2, 0.3, 0.4], mask=[0, 1, 0])


@pytest.mark.parametrize(
    "use",
    [
        lambda cube: cube.reflectance(MASKED),
        lambda cube: cube.coefficients([MASKED, MASKED]),
        lambda cube: cube.reflectance(RED, 1000 * MASKED),
        lambda cube: cube.decode(MASKED),
        lambda cube: bulk.spectra(cube)(MASKED),
        lambda cube: bulk.evaluate(bulk.traceable(cube), MASKED),
        lambda cube: cube.data.sensor.rgb(np.ma.masked_less(np.arange(81), 9)),
        lambda cube: delta_e_2000(MASKED, MASKED),
    ],
)
def test_masked_values_are_refused(small_cube, use):
    with raises(UpliftError, "masked-values"):
        use(small_cube)
    assert small_cube.reflectance(np.ma.array([0.2, 0.3, 0.4])).shape == (81,)


@pytest.mark.parametrize(
    "use",
    [
        lambda cube, rgb: cube.reflectance([rgb[0], 0, 0]),
        lambda cube, rgb: cube.reflectance(RED, 1000 * rgb),
        lambda cube, rgb: bulk.spectra(cube)(rgb),
    ],
)
def test_what_jax_traces_is_refused_with_what_it_can_trace(small_cube, use):
    for transform in (jax.jit, jax.jacfwd):
        with raises(UpliftError, "traced-values") as caught:
            transform(partial(use, small_cube))(np.float32(RED))
        assert "bulk.traceable" in caught.value.hint


def test_arrays_of_codes_are_refused(small_cube):
    """Also those that would lie in [0, 1]."""
    for codes in ([255, 3, 0], [1, 0, 1]):
        with raises(ColourError, "rgb-like-codes"):
            small_cube.reflectance(np.uint8(codes))


@pytest.mark.parametrize(
    "use",
    [
        lambda nm: observer.light("D65", start=nm[0], end=nm[-1], step=nm[1] - nm[0]),
        lambda nm: replace(observer.sensor(), wavelengths=nm),
        lambda nm: Lamp("lamp", nm, np.ones(len(nm))),
        lambda nm: on_grid(read_atlas("macbeth"), nm),
        lambda nm: bulk.traceable(load(), nm),
        lambda nm: load_emission().spectrum(RED, nm),
        lambda nm: prepare_samples(load())(RED, 1, seed=1, wavelengths=nm),
    ],
)
def test_wavelengths_in_other_units_are_refused_everywhere(use):
    for unit in (1e-3, 1e-9, 10):
        with raises(OptionError, "option"):
            use(unit * np.linspace(550, 750, 41))


def test_codes_decode_as_srgb_and_encoding_is_inverse(small_cube):
    codes = np.arange(256)
    expected = colour.cctf_decoding(codes / 255, "sRGB")
    assert_allclose(small_cube.decode(codes), expected, rtol=0, atol=1e-15)
    codes = np.linspace(0, 255, 1021)[:, None]
    again = small_cube.encode(small_cube.decode(codes))
    assert_allclose(again, codes, rtol=0, atol=1e-10)


@pytest.mark.parametrize("codes", [-1, [0, 255.001, 3], NAN, "red", [[1], [2, 3]]])
def test_codes_out_of_range_are_refused(small_cube, codes):
    with raises(ColourError, "invalid-codes"):
        small_cube.decode(codes)


def test_names_stand_for_packaged_files_unless_a_file_has_the_name(
    tmp_path, monkeypatch
):
    for name, path in PACKAGED.items():
        assert find_file(name) == find_file(name.upper()) == path
    for name in ("missing", "srgb.uplift", b"other"):
        assert find_file(name) is name
    monkeypatch.chdir(tmp_path)
    (tmp_path / "srgb").touch()
    assert find_file("srgb") == "srgb"
    assert find_file("sRGB") == DEFAULT
