"""The conformance kit: its files are those that are stored, what is right passes, and
every mistake fails.
"""

from dataclasses import replace

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.conformance import KIT, colours, mistakes, write_table
from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import near_black, raises, with_absent_points
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB
from uplift.common.errors import ColourError, TextureError
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.report.conformance import MODES, check_renderer
from uplift.extras.report.conformance_chart import COUNT, make_chart
from uplift.extras.report.conformance_kit import (
    CUBE,
    DIGITS,
    PATCH,
    kit_names,
    write_kit,
)
from uplift.lookup.cube import Cube

A = KIT / "reference-A.exr"


@pytest.fixture(scope="module")
def cube():
    """The stored cube of the kit."""
    return uplift.load(KIT / CUBE)


@pytest.fixture(scope="module")
def spectra():
    """The right answers (1000, 31)."""
    return table(KIT / "spectra.csv")[1]


def pixels(path):
    """Pixels (100, 160, 3) of a picture of the kit."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        channels = file.channels()
        return np.stack([channels[name].pixels for name in "RGB"], axis=-1)


def table(path):
    """Header, names and colours as text, and reflectances (1000, 31)."""
    header, *lines = path.read_text().splitlines()
    rows = [line.rsplit(",", 31) for line in lines]
    names = [row[0] for row in rows]
    return (header, names), np.array([row[1:] for row in rows], dtype=float)


def write(path, rgb, **header):
    """Write a picture of RGB (height, width, 3)."""
    return write_exr(path, planes(rgb.astype(np.float32)), **header)


def test_the_stored_kit_is_what_its_cube_gives(cube, tmp_path):
    """Up to the last digits, which depend on the processor."""
    write_kit(cube, tmp_path)
    assert {path.name for path in KIT.iterdir()} == set(kit_names())
    for path in KIT.iterdir():
        again = tmp_path / path.name
        if path.suffix == ".exr":
            assert_allclose(pixels(again), pixels(path), rtol=0, atol=1e-5)
        elif path.name == "spectra.csv":
            names, numbers = table(again)
            stored_names, stored_numbers = table(path)
            assert names == stored_names
            within = 2 * 10**-DIGITS
            assert_allclose(numbers, stored_numbers, rtol=0, atol=within)
        elif path.suffix != ".uplift":
            assert again.read_text() == path.read_text()
    assert sum(path.stat().st_size for path in KIT.iterdir()) < 1e6


def test_the_chart_has_different_colours_of_single_precision(cube):
    chart = make_chart(cube.data)
    assert chart.rgb.shape == (COUNT, 3)
    assert len(set(chart.names)) == COUNT
    assert (chart.rgb == np.clip(chart.rgb, 0, 1).astype(np.float32)).all()
    assert_allclose(colours(), chart.rgb, rtol=0, atol=1e-7)


@pytest.mark.parametrize("name", REGRESSION_LIGHTS)
def test_reference_pictures_follow_from_the_files_of_the_kit(cube, name):
    """Σ ρ(λ) L(λ) x̄(λ) Δλ, with the spectra of a pixel and the file of the light."""
    at, power = np.loadtxt(KIT / f"{name}.spd").T
    observed = observer.matching_functions()
    matrix = np.linalg.inv(SRGB.rgb_to_xyz)
    picture = pixels(KIT / f"reference-{name}.exr")
    chart = pixels(KIT / "chart.exr")
    for row, column in ((0, 0), (3, 57), (50, 81), (99, 159)):
        reflectance = cube.reflectance(chart[row, column].astype(float), at)
        xyz = np.zeros(3)
        for k in range(len(at)):
            xyz += reflectance[k] * power[k] * observed[k] * 5
        rgb = matrix @ xyz / 106.856895
        assert_allclose(picture[row, column], rgb, rtol=0, atol=1e-5)


@pytest.mark.parametrize("name", REGRESSION_LIGHTS)
def test_references_pass_under_their_light_and_no_other(cube, name):
    path = KIT / f"reference-{name}.exr"
    for light in REGRESSION_LIGHTS:
        found = check_renderer(path, cube, light)
        assert found.passed == (light == name)
        expected = "" if light == name else f"the light is {name}"
        assert found.explanation == expected


@pytest.mark.parametrize("mode", MODES)
def test_spectra_of_every_mode_pass(cube, tmp_path, mode):
    at = np.arange(400, 701, 10)
    answers = cube.reflectance(colours(), at, mode).astype(np.float16)
    found = check_renderer(write_table(tmp_path / "a.csv", answers), cube)
    assert (found.passed, found.mode) == (True, mode)


WIDE = observer.sensor("ITU-R BT.2020")
TO_WIDE = (WIDE.xyz_to_rgb @ SRGB.rgb_to_xyz).T
PRIMARIES = (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)


def blurred(rgb):
    """As the filter of a renderer blurs the edges of patches."""
    rgb = rgb.copy()
    rgb[1:-1] += (rgb[2:] + rgb[:-2] - 2 * rgb[1:-1]) / 4
    return rgb


@pytest.mark.parametrize(
    ("change", "header", "passes"),
    [
        (lambda rgb: rgb[::PATCH, ::PATCH], {}, True),
        (lambda rgb: rgb.repeat(3, axis=0).repeat(3, axis=1), {}, True),
        (blurred, {}, True),
        (lambda rgb: rgb @ TO_WIDE, {"chromaticities": PRIMARIES}, True),
        (lambda rgb: rgb @ TO_WIDE, {}, False),
    ],
)
def test_pictures_of_other_sizes_and_stated_spaces_pass(
    cube, tmp_path, change, header, passes
):
    path = write(tmp_path / "a.exr", change(pixels(A)), **header)
    assert check_renderer(path, cube).passed == passes


TURNED = [
    (lambda rgb: rgb[::-1], "the picture is upside down"),
    (lambda rgb: rgb[::-1, ::-1], "the picture is turned by 180°"),
    (lambda rgb: 0.5 * rgb, "all is 0.5 times as bright"),
    (lambda rgb: np.where(np.arange(160)[:, None] < 8, 0, rgb), ""),
    (lambda rgb: np.clip(rgb, 0, 0.5), ""),
]


@pytest.mark.parametrize(("change", "explanation"), TURNED)
def test_changed_pictures_fail_and_are_explained(cube, tmp_path, change, explanation):
    found = check_renderer(write(tmp_path / "a.exr", change(pixels(A))), cube)
    assert (found.passed, found.explanation) == (False, explanation)


def test_every_mistake_of_a_lookup_fails():
    found = {row["lookup"]: row for row in mistakes()}
    assert [name for name, row in found.items() if row["verdict"] != "failed"] == []
    explained = {
        "RGB times the RGB of the light": "RGB is multiplied by the RGB of the light",
        "the nearest node": "nodes are not interpolated",
        "no boxes of entries": "the boxes of entries are ignored",
    }
    for name, explanation in explained.items():
        assert found[name]["explanation"] == explanation


def test_the_worst_patch_is_named_and_other_columns_are_ignored(
    cube, tmp_path, spectra
):
    changed = spectra.copy()
    changed[314] *= 0.9
    # Other columns are ignored.
    path = write_table(tmp_path / "a.csv", changed)
    header, *rows = path.read_text().splitlines()
    path.write_text("\n".join([f"{header},405,note", *(f"{row},,x" for row in rows)]))
    found = check_renderer(path, cube)
    assert not found.passed
    assert found.to_json(1)["worst"][0]["patch"] == 314


TEXT = (KIT / "spectra.csv").read_text()
SAMPLE = KIT.parents[1] / "uplift" / "samples" / "files" / "wood.png"


@pytest.mark.parametrize(
    ("content", "error", "code"),
    [
        (np.zeros((160, 100, 3)), TextureError, "texture"),
        (np.zeros((100, 161, 3)), TextureError, "texture"),
        (np.full((100, 160, 3), np.nan), TextureError, "texture"),
        (b"no picture", TextureError, "texture"),
        (SAMPLE.read_bytes(), TextureError, "texture"),
        (A.read_bytes()[:-500], TextureError, "file-unreadable"),
        (None, TextureError, "file-not-found"),
        ("", ColourError, "colour"),
        (TEXT[: TEXT.rindex("\n", 0, -1)], ColourError, "colour"),
        (TEXT.replace(",700\n", ",701\n"), ColourError, "colour"),
        (TEXT.replace("grey 0,0.0", "grey 0,0.5"), ColourError, "colour"),
        (TEXT.replace("grey 0,0.0", "grey 0,nan"), ColourError, "colour"),
    ],
)
def test_unusable_pictures_and_spectra_raise(cube, tmp_path, content, error, code):
    path = tmp_path / ("a.csv" if isinstance(content, str) else "a.exr")
    if isinstance(content, np.ndarray):
        write(path, content)
    elif content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with raises(error, code):
        check_renderer(path, cube)


def test_cubes_without_xyz_or_colours_raise(cube, tmp_path):
    present = near_black(cube.data)
    sparse = Cube(with_absent_points(cube.data, present))
    with raises(ColourError, "colour-not-in-scene"):
        write_kit(sparse, tmp_path / "kit")
    assert not (tmp_path / "kit").exists()
    sensor = replace(cube.data.sensor, sensitivities=cube.data.sensor.cmfs)
    with raises(ColourError, "camera-without-xyz"):
        check_renderer(A, Cube(replace(cube.data, sensor=sensor)))


def test_cubes_of_wide_spaces_have_a_kit(tmp_path):
    """It has cells whose spectra are moved."""
    wide = uplift.load("acescg")
    write_kit(wide, tmp_path)
    assert check_renderer(tmp_path / "reference-A.exr", wide).passed
    assert check_renderer(tmp_path / "spectra.csv", wide).passed
