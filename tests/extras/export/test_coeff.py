"""Tables of sigmoid spectra, as Mitsuba, colour-science, pbrt and LuisaRender read
them.
"""

import json
import struct
from dataclasses import replace
from itertools import product

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import output_of, run_python
from tests.parts import CXX, MITSUBA, need
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import (
    DEFAULT_OBSERVER,
    illuminant_spd,
    matching_functions,
    on_range,
)
from uplift.colorimetry.observer import sensor as make_sensor
from uplift.extras.colour.srgb import decode, encode
from uplift.extras.export import coeff
from uplift.extras.export.coeff import write_coeff
from uplift.models.sigmoid import evaluate_unscaled

RES = 5
DARK_RED = [0.00010678071, 0, 0.000010491596]
"""A colour of pbrt's tests: its table gave it reflectances near 1 (mmp/pbrt-v4, issue
82).
"""
STRONG_RED = [0.78594791889190674, 0.10324395447969437, 0.12402211874723434]
"""A colour of Rec. 2020 whose round trip by pbrt's table differed by 0.026 (issue 93).
"""


@pytest.fixture(scope="module")
def sensor(small_cube):
    """The forward model of the readers."""
    return on_range(small_cube.data.sensor, 360, 830, 5)


@pytest.fixture(scope="module")
def table(tmp_path_factory, small_cube):
    """Path of a small table."""
    path = tmp_path_factory.mktemp("coeff") / "data" / "srgb.coeff"
    path.parent.mkdir()
    write_coeff(small_cube.data, path, res=RES)
    return path


def stored(path, res):
    """Read the coefficients (9 res³ / 3, 3) of a table."""
    content = path.read_bytes()
    return np.frombuffer(content, "<f4", 9 * res**3, 8 + 4 * res).reshape(-1, 3)


def test_the_stated_error_is_the_largest_of_interpolated_colours(
    small_cube, sensor, tmp_path
):
    """Of random codes, as colour-science interpolates them."""
    stated = write_coeff(small_cube.data, tmp_path / "a.coeff", res=8)
    reader = colour.recovery.LUT3D_Jakob2019()
    reader.read(str(tmp_path / "a.coeff"))
    rgb = decode(
        np.vstack([np.random.default_rng(1).random((4000, 3)), encode(stated.worst)])
    )
    found = sensor.rgb(
        evaluate_unscaled(reader.RGB_to_coefficients(rgb), sensor.wavelengths)
    )
    errors = delta_e_rgb(sensor, found, rgb)
    assert errors[:-1].max() < stated.largest
    assert_allclose(errors[-1], stated.largest, rtol=0.02)
    assert_allclose(errors[:-1].mean(), stated.mean, rtol=0.1)


def test_the_forward_model_follows_the_coefficients(table, sensor):
    content = table.read_bytes()
    at = 8 + 4 * RES + 36 * RES**3
    count = len(sensor.wavelengths)
    assert struct.unpack_from("<I", content, at) == (count,)
    wavelengths, *rows = np.frombuffer(content, "<f4", 4 * count, at + 4).reshape(4, -1)
    assert_allclose(360 + 470 * wavelengths, sensor.wavelengths, rtol=1e-6)
    assert_allclose(rows, sensor.matrix, atol=1e-7)
    rest = np.frombuffer(content, "<f4", offset=at + 4 + 16 * count)
    assert_allclose(rest[:9].reshape(3, 3) @ np.ones(3), rest[9:], rtol=1e-6)
    assert_allclose(rest[9:], sensor.light.white, rtol=1e-3)


GREYS = [
    0, 0.0129831, 0.0241576, 0.0423114, 0.0561285, 0.0703601, 0.104617, 0.171441,
    0.242281,
    0.814846, 0.913098, 0.930111, 0.955973, 0.973445, 0.982251, 0.991102, 1,
]  # fmt: skip
"""Those of Mitsuba's test_spectra.py, which requires numbers for them."""
FETCH = """
import json, sys
import mitsuba as mi
mi.set_variant("scalar_spectral")
mi.file_resolver().prepend(sys.argv[1])
for rgb in json.loads(sys.argv[2]):
    found = mi.srgb_model_fetch(rgb)
    values = mi.srgb_model_eval(found, mi.Spectrum(360, 510, 670, 830))
    print(*found, mi.srgb_model_mean(found), *values)
"""


def test_colour_science_and_mitsuba_read_it(table, sensor):
    """Mitsuba finds data/srgb.coeff by its file resolver, in the folder prepended here
    first.
    """
    need(MITSUBA)
    level = struct.unpack_from(f"<{RES}f", table.read_bytes(), 8)[3]
    rgb = np.vstack(
        [
            level * np.array([[1, 0.25, 0.5], [0.75, 1, 0]]),
            np.repeat([GREYS], 3, axis=0).T,
        ]
    )

    def fetch(folder):
        printed = run_python(FETCH, folder, json.dumps(rgb.tolist()))
        return np.loadtxt(printed.splitlines())

    ours = fetch(table.parents[1])
    default = fetch(table.parent)
    assert not np.allclose(ours[:2], default[:2], rtol=1e-4)
    greys = ours[2:]
    assert not np.isnan(greys).any()
    assert (np.diff(greys[:, 3]) > 0).all()
    assert_allclose(greys[:, 4:], np.repeat(greys[:, 3:4], 4, axis=1), atol=1e-3)
    reader = colour.recovery.LUT3D_Jakob2019()
    reader.read(table)
    assert_allclose(ours[:2, :3], reader.RGB_to_coefficients(rgb[:2]), rtol=1e-4)
    found = sensor.rgb(evaluate_unscaled(ours[:2, :3], sensor.wavelengths))
    assert_allclose(found, rgb[:2], rtol=0, atol=1e-4)


WAVELENGTHS = np.arange(360.0, 831.0)


def spectra_of(data, rgb):
    """Spectra of RGB (n, 3) by a full table, of which only the directions around them
    are fitted.
    """
    res = coeff.RES
    largest = rgb.argmax(axis=1)
    rows = np.arange(len(rgb))
    at = [
        np.minimum(
            (rgb[rows, (largest + k) % 3] / rgb.max(axis=1) * (res - 1)).astype(int),
            res - 2,
        )
        for k in (2, 1)
    ]
    used = np.zeros((3, res, res), dtype=bool)
    for dy, dx in product((0, 1), repeat=2):
        used[largest, at[0] + dy, at[1] + dx] = True
    scale = coeff._scale(res)
    table = np.full((res, 3, res, res, 3), np.nan, np.float32)
    fitted_to = on_range(data.sensor, coeff.START, coeff.END, coeff.STEP)
    table[:, used] = coeff._fit(
        data, fitted_to, scale, coeff._directions(res)[used.ravel()]
    )
    return evaluate_unscaled(
        coeff._interpolated(scale, table.swapaxes(0, 1), rgb), WAVELENGTHS
    )


def pbrt_rgb(space, light, spectra):
    """Linear RGB as pbrt computes them: sums at 1 nm, and a matrix from the primaries
    and the white of the light.
    """
    weights = (
        matching_functions(DEFAULT_OBSERVER, 360, 830, 1)
        * illuminant_spd(light, 360, 830, 1)[:, None]
    )
    xyz = spectra @ weights / weights[:, 1].sum()
    white = weights.sum(axis=0)
    matrix = colour.normalised_primary_matrix(
        colour.RGB_COLOURSPACES[space].primaries, white[:2] / white.sum()
    )
    return np.linalg.solve(matrix, xyz.T).T


@pytest.mark.parametrize(
    ("space", "light", "low", "high", "also"),
    [
        ("sRGB", "D65", 0, 1, [0.9, 0.5, 0.5]),
        ("Display P3", "D65", 0.1, 0.8, [0.7, 0.7, 0.1]),
        ("ITU-R BT.2020", "D65", 0.1, 0.8, STRONG_RED),
        ("ACES2065-1", "D60", 0.3, 0.7, [0.3, 0.3, 0.7]),
    ],
)
def test_round_trips_of_pbrt(small_cube, space, light, low, high, also):
    """The cases of pbrt's color_test.cpp, with its tolerance: random colours within
    these bounds.
    """
    data = replace(small_cube.data, sensor=make_sensor(space, light))
    rgb = np.vstack([np.random.default_rng(4).uniform(low, high, (32, 3)), also])
    assert np.abs(pbrt_rgb(space, light, spectra_of(data, rgb)) - rgb).max() < 0.01


def test_dark_colours_are_dark_at_every_wavelength(small_cube):
    spectra = spectra_of(small_cube.data, np.array([DARK_RED]))
    assert spectra.max() < 0.05
    assert_allclose(pbrt_rgb("sRGB", "D65", spectra), [DARK_RED], atol=1e-4)


PRINT = """
#include <cstdio>
namespace {space} {{
extern const float {name}ToSpectrumTable_Data[3][{res}][{res}][{res}][{width}];
}}
int main() {{
    for (auto& largest : {space}::{name}ToSpectrumTable_Data)
        for (auto& level : largest) for (auto& second : level)
            for (auto& first : second) for (float number : first)
                std::printf("%.9g\\n", number);
}}
"""


@pytest.mark.parametrize(
    ("layout", "namespace", "name", "width", "space", "light"),
    [
        ("pbrt", "pbrt", "ACES2065_1", 3, "ACES2065-1", "D60"),
        ("luisa", "luisa::render", "sRGB", 4, "sRGB", "D65"),
    ],
)
def test_sources_compile_to_the_numbers_of_the_table(
    small_cube, tmp_path, layout, namespace, name, width, space, light
):
    need(CXX)
    data = replace(small_cube.data, sensor=make_sensor(space, light))
    res = 3
    write_coeff(data, tmp_path / "table.coeff", res=res)
    write_coeff(data, tmp_path / "table.cpp", layout=layout, res=res)
    (tmp_path / "main.cpp").write_text(
        PRINT.format(space=namespace, name=name, width=width, res=res)
    )
    command = "c++ -std=c++17 -Wall -Werror table.cpp main.cpp -o main"
    output_of(*command.split(), cwd=tmp_path)
    printed = output_of(tmp_path / "main").split()
    values = np.array(printed, dtype=np.float32).reshape(-1, width)
    assert_array_equal(values[:, :3], stored(tmp_path / "table.coeff", res))
    assert not values[:, 3:].any()
