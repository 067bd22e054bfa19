"""The conformance kit: its files are those that are stored, what is right passes, and
every mistake fails.
"""

import re
from dataclasses import replace

import numpy as np
import OpenEXR
import pytest
from numpy.testing import assert_allclose

import uplift
from benchmarks.conformance import KIT, colours, mistakes, write_table
from tests.extras.texture.conftest import planes, write_exr
from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB
from uplift.common.errors import ColourError, OutputError, TextureError
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.report.conformance import MODES, check_renderer
from uplift.extras.report.conformance_chart import COLUMNS, COUNT, ROWS, make_chart
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


def test_the_chart_has_what_lookups_get_wrong(cube):
    chart = make_chart(cube.data)
    assert chart.rgb.shape == (COUNT, 3)
    assert len(set(chart.names)) == COUNT
    assert (chart.rgb == chart.rgb.astype(np.float32)).all()
    assert ((chart.rgb >= 0) & (chart.rgb <= 1)).all()
    assert_allclose(colours(), chart.rgb, rtol=0, atol=1e-7)
    hits = set(cube.data.entry_boxes.locate(chart.rgb)[2].rows.tolist())
    inside = re.compile("(centre|inside the (box|face)) [12]$")
    for row, name in enumerate(chart.names):
        if inside.search(name):
            assert row in hits, name
        if "outside the face" in name:
            entry = cube.atlas_names.index(name.rpartition(",")[0])
            low, high = (face[entry] for face in cube.data.entry_boxes.faces)
            colour = chart.rgb[row]
            is_outside = (colour < low) | (colour > high)
            assert is_outside.any() or {0, 1} & set(colour), name


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


def test_pictures_of_other_sizes_types_and_channels_pass(cube, tmp_path):
    picture = pixels(A)
    xyz = picture @ SRGB.rgb_to_xyz.T.astype(np.float32)
    small = picture[::PATCH, ::PATCH]
    large = picture.repeat(3, axis=0).repeat(3, axis=1)
    half = write_exr(tmp_path / "half.exr", planes(picture.astype(np.float16)))
    named = dict(zip("XYZ", planes(xyz).values(), strict=True))
    alpha = {"A": np.ones(picture.shape[:2], np.float32)}
    for path in (
        write(tmp_path / "small.exr", small),
        write(tmp_path / "large.exr", large),
        half,
        write_exr(tmp_path / "xyz.exr", named),
        write_exr(tmp_path / "alpha.exr", planes(picture) | alpha),
    ):
        assert check_renderer(path, cube).passed, path.name


def test_the_space_that_a_picture_states_counts(cube, tmp_path):
    """Primaries of BT.2020, and the same numbers without a statement."""
    wide = observer.sensor("ITU-R BT.2020")
    rgb = pixels(A) @ (wide.xyz_to_rgb @ SRGB.rgb_to_xyz).T
    primaries = (0.708, 0.292, 0.17, 0.797, 0.131, 0.046, 0.3127, 0.329)
    stated = write(tmp_path / "stated.exr", rgb, chromaticities=primaries)
    assert check_renderer(stated, cube).passed
    assert not check_renderer(write(tmp_path / "silent.exr", rgb), cube).passed


def test_filters_may_blur_the_edges_of_patches(cube, tmp_path):
    picture = pixels(A)
    blurred = picture.copy()
    blurred[1:-1] += (picture[2:] + picture[:-2] - 2 * picture[1:-1]) / 4
    assert check_renderer(write(tmp_path / "a.exr", blurred), cube).passed


TURNED = [
    (lambda rgb: rgb[::-1], "the picture is upside down"),
    (lambda rgb: rgb[:, ::-1], "the picture is mirrored"),
    (lambda rgb: rgb[::-1, ::-1], "the picture is turned by 180°"),
    (lambda rgb: 0.5 * rgb, "all is 0.5 times as bright"),
    (lambda rgb: np.where(np.arange(160)[:, None] < 8, 0, rgb), ""),
    (lambda rgb: np.clip(rgb, 0, 0.5), ""),
    (lambda rgb: rgb[..., ::-1], ""),
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


def test_the_worst_patch_is_named(cube, tmp_path, spectra):
    changed = spectra.copy()
    changed[314] *= 0.9
    found = check_renderer(write_table(tmp_path / "a.csv", changed), cube)
    assert not found.passed
    assert found.to_json(1)["worst"][0]["patch"] == 314


@pytest.mark.parametrize(
    ("size", "value"),
    [((160, 100), 0), ((100, 161), 0), ((24, 40), 0), ((100, 160), np.nan)],
)
def test_unusable_pictures_raise(cube, tmp_path, size, value):
    path = write(tmp_path / "a.exr", np.full((*size, 3), value))
    with raises(TextureError, "texture"):
        check_renderer(path, cube)


def test_files_that_are_no_pictures_raise(cube, tmp_path, repository):
    path = tmp_path / "a.exr"
    for data, code in (
        (b"no picture", "texture"),
        (A.read_bytes()[:-500], "file-unreadable"),
        ((repository / "uplift/samples/files/wood.png").read_bytes(), "texture"),
    ):
        path.write_bytes(data)
        with raises(TextureError, code):
            check_renderer(path, cube)
    with raises(TextureError, "file-not-found"):
        check_renderer(tmp_path / "none.exr", cube)


def test_other_columns_of_spectra_are_ignored(cube, tmp_path):
    header, *rows = (KIT / "spectra.csv").read_text().splitlines()
    lines = [f"{header},405,1e3,note", *(f"{row},0.5,,x" for row in rows)]
    (tmp_path / "a.csv").write_text("\n".join(lines))
    assert check_renderer(tmp_path / "a.csv", cube).passed


def test_unusable_spectra_raise(cube, tmp_path):
    text = (KIT / "spectra.csv").read_text()
    lines = text.splitlines()
    path = tmp_path / "a.csv"
    for changed in (
        "",
        "\n".join(lines[:-1]),
        "\n".join([lines[0], *lines[:0:-1]]),
        text.replace(",700\n", ",701\n"),
        text.replace("grey 0,0.0", "grey 0,nan"),
    ):
        path.write_text(changed)
        with raises(ColourError, "colour"):
            check_renderer(path, cube)


def test_cubes_of_wide_spaces_have_a_kit(tmp_path):
    """It has cells whose spectra are moved."""
    wide = uplift.load("acescg")
    write_kit(wide, tmp_path)
    assert check_renderer(tmp_path / "reference-A.exr", wide).passed
    assert check_renderer(tmp_path / "spectra.csv", wide).passed
    with raises(OutputError, "file-exists"):
        write_kit(wide, tmp_path)


def test_cubes_without_xyz_or_colours_raise(cube, tmp_path):
    corners = cube.data.lattice.corners(np.full((1, 3), 0.3))[0][0]
    points = cube.data.points.restricted_to(corners)
    sparse = Cube(replace(cube.data, points=points))
    with raises(ColourError, "colour-not-in-scene"):
        write_kit(sparse, tmp_path / "kit")
    sensor = cube.data.sensor
    camera = replace(sensor, sensitivities=sensor.cmfs)
    with raises(ColourError, "camera-without-xyz"):
        check_renderer(A, Cube(replace(cube.data, sensor=camera)))
    assert not (tmp_path / "kit").exists()


def test_scenes_have_the_size_and_the_files_of_the_kit():
    width = COLUMNS * PATCH
    height = ROWS * PATCH
    pbrt = (KIT / "scene.pbrt").read_text()
    assert f'"integer xresolution" {width} "integer yresolution" {height}' in pbrt
    xml = (KIT / "scene.xml").read_text()
    for name, value in (("width", width), ("height", height), ("light", "A")):
        assert f'<default name="{name}" value="{value}"/>' in xml
    for text in (pbrt, xml.replace("$light", "A")):
        named = re.findall(r'"(\w+\.(?:exr|spd|uplift))"', text)
        assert {"chart.exr", "A.spd"} <= set(named)
        assert set(named) <= {*kit_names(), "out.exr"}
