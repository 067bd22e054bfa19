"""Looks of files and builds: met exactly, recorded, rebuilt; refused where they
contradict or cannot be met.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import MACBETH
from tests.helpers import query, quiet_build, raises, warns
from uplift import Look, LookError, read_looks
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import display_sensors, light
from uplift.extras.report.rebuild import rebuild
from uplift.lookup.errors_under_lights import light_errors

RED = Look("#8a2a20", {"FL11": "#70392a"}, name="brick")
LOOKS = (
    RED,
    Look("#40a060", {"FL11": "#50a050"}),
    Look([0.5, 0.3, 0.2], {"A": [0.52, 0.295, 0.19]}, 0.5),
)
IMPOSSIBLE = Look("#4060a0", {"A": "#5060a0"}, name="dusk")


@pytest.fixture(scope="module")
def cubes():
    """The ColorChecker without and with looks."""
    return quiet_build(MACBETH, dim=8), quiet_build(MACBETH, dim=8, looks=LOOKS)


@pytest.fixture(scope="module")
def bare():
    """Looks without an atlas."""
    return quiet_build(dim=4, prior="smooth", looks=[*LOOKS, IMPOSSIBLE])


def distances(cube, looks):
    """ΔE00 of the answers to the colours of looks from the wishes, computed from the
    definition.
    """
    found = []
    for look in looks:
        rgb = (
            cube.decode(list(bytes.fromhex(look.rgb[1:])))
            if isinstance(look.rgb, str)
            else look.rgb
        )
        for name, wish in look.lights.items():
            (screen,) = display_sensors([name], cube.observer)
            codes = (
                screen.decode(list(bytes.fromhex(wish[1:])))
                if isinstance(wish, str)
                else wish
            )
            found.append(delta_e_rgb(screen, screen.rgb(cube.reflectance(rgb)), codes))
    return np.array(found)


def test_looks_are_met_and_other_entries_unchanged(cubes):
    plain, looked = cubes
    assert distances(looked, LOOKS[:2]).max() <= 0.1
    assert distances(plain, LOOKS[:2]).min() > 2
    atlas = plain.data.atlas
    assert looked.data.atlas.names == (
        *atlas.names,
        "brick",
        "look #40a060",
        "look 0.5 0.3 0.2",
    )
    for mode in ("spectra", "refined", "moments"):
        assert_allclose(
            looked.reflectance(atlas.rgb, mode=mode),
            plain.reflectance(atlas.rgb, mode=mode),
            rtol=0,
            atol=1e-9,
        )
    rgb = looked.data.atlas.rgb
    assert_allclose(looked.data.sensor.rgb(looked.reflectance(rgb)), rgb, atol=1e-5)


def test_looks_work_without_an_atlas(bare):
    assert distances(bare, LOOKS[:2]).max() <= 0.1
    assert bare.data.families is not None
    assert (bare.data.atlas.measured_count, bare.data.atlas.looks) == (0, 4)


def test_looks_are_no_evidence_for_errors(cubes):
    plain, looked = cubes
    one, other = (each.data.atlas for each in cubes)
    assert_array_equal(one.measured, other.measured)
    assert_allclose(one.left_out, other.left_out, atol=1e-6)
    rgb = looked.data.atlas.rgb
    count = plain.data.atlas.measured_count
    for kind in (None, light("FL11")):
        errors = (
            looked.standard_error(rgb)
            if kind is None
            else looked.standard_error(rgb, kind)
        )
        assert errors[:count].max() < 0.5 < errors[count:].min()
    assert len(light_errors(looked.data, light("HP1")).entries) == count + 3
    assert_array_equal(looked.unlike_atlas(rgb), plain.unlike_atlas(rgb))
    assert [each.entry for each in query(looked, rgb[count:])] == list(
        looked.data.atlas.names[count:]
    )


def test_impossible_look_is_reported_and_recorded():
    with warns("look-impossible") as found:
        cube = uplift.build(dim=2, prior="smooth", looks=IMPOSSIBLE)
    (record,) = cube.data.provenance["looks"]
    (at_a,) = record["lights"]
    assert 0.5 < at_a["possible"] <= at_a["delta_e"] < at_a["possible"] + 0.2
    assert_allclose(at_a["delta_e"], distances(cube, [IMPOSSIBLE])[0], atol=1e-5)
    assert "dusk" in str(found[0])
    assert cube.reflectance(cube.data.atlas.rgb).max() <= 1


def test_look_that_few_coefficients_miss_is_reported(small_cube):
    screens = display_sensors(["FL11", "A"], small_cube.observer)
    entry = small_cube.data.atlas.spectra.reflectance(
        np.array([3]), small_cube.data.sensor.wavelengths
    )[0]
    look = Look(
        small_cube.data.atlas.rgb[3].tolist(),
        {each.illuminant: each.rgb(entry).tolist() for each in screens},
    )
    with warns("look-not-reached"):
        cube = uplift.build(
            dim=2, prior="smooth", coefficients=4, entry_coefficients=4, looks=look
        )
    (record,) = cube.data.provenance["looks"]
    assert max(each["delta_e"] for each in record["lights"]) > 0.1
    assert max(each["possible"] for each in record["lights"]) < 0.1


def test_cube_with_looks_is_stored_and_rebuilt(cubes, tmp_path):
    path = tmp_path / "looks.uplift"
    cubes[1].save(path)
    stored = uplift.load(path)
    assert stored.data.provenance["looks"] == cubes[1].data.provenance["looks"]
    rebuild(stored, path).save(tmp_path / "again.uplift")
    assert (tmp_path / "again.uplift").read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("#8a2a2", {"A": "#808080"}), "colour"),
        (([0.1, 0.2, float("nan")], {"A": "#808080"}), "colour"),
        (("#8a2a20", {"A": "#808080"}, "1"), "look"),
    ],
)
def test_invalid_looks_are_refused(arguments, code):
    with raises(LookError, code):
        Look(*arguments)


@pytest.mark.parametrize(
    ("looks", "code"),
    [
        ([RED, Look("#8a2a20", {"A": "#808080"})], "look"),
        ([Look("#40a060", {"A": "#808080"}, name="orange")], "look"),
        ([Look("#da7b2a", {"A": "#808080"})], "look"),
        ([Look("#40a060", {"D65": "#808080"})], "look"),
        ([Look("#40a060", {"FL11": "#808080", "fl11": "#808081"})], "look"),
    ],
)
def test_contradicting_looks_are_refused(looks, code):
    with raises(LookError, code):
        quiet_build(MACBETH, dim=2, prior="smooth", looks=looks)


def test_look_that_no_reflectance_has_by_day_is_refused():
    with raises(LookError, "look"):
        uplift.build(
            dim=2, space="ITU-R BT.2020", looks=Look([0, 1, 0], {"A": "#808080"})
        )


@pytest.mark.parametrize(
    "options", [{"model": "sigmoid"}, {"coefficients": 3, "entry_coefficients": 3}]
)
def test_models_without_freedom_are_refused(options):
    with raises(LookError, "look"):
        uplift.build(dim=2, looks=RED, **options)


def test_half_a_look_is_half_way(cubes):
    plain, looked = cubes
    (screen,) = display_sensors(["A"], plain.observer)
    rgb = LOOKS[2].rgb
    wish = np.array(LOOKS[2].lights["A"])
    expected = screen.rgb(plain.reflectance(rgb))
    halfway = (wish + expected) / 2
    assert delta_e_rgb(screen, screen.rgb(looked.reflectance(rgb)), halfway) < 0.5
    assert delta_e_rgb(screen, wish, expected) > 1


COMPLETE = """# Two looks
[[look]]
rgb = "#8a2a20"
FL11 = "#70392a"
A = [0.27, 0.02, 0.01]
weight = 0.5
name = "brick"

[[look]]
rgb = [0.1, 0.2, 0.3]
LED-B3 = "#5c7a94"
"FL3.1" = "#5c7a94"
"""


@pytest.fixture
def read_text(tmp_path):
    def read_text(text):
        (tmp_path / "looks.toml").write_text(text, encoding="utf-8")
        return read_looks(tmp_path / "looks.toml")

    return read_text


def test_complete_file(read_text):
    first, second = read_text(COMPLETE)
    assert first == Look(
        "#8a2a20", {"FL11": "#70392a", "A": [0.27, 0.02, 0.01]}, 0.5, "brick"
    )
    assert (second.name, second.weight) == ("look 0.1 0.2 0.3", 1.0)
    assert list(second.lights) == ["LED-B3", "FL3.1"]


HEAD = '[[look]]\nrgb = "#8a2a20"\n'


@pytest.mark.parametrize(
    ("text", "code", "word"),
    [
        ("", "invalid-file", "look"),
        ("[[looks]]\nrgb = '#8a2a20'", "invalid-file", "[[look]]"),
        ("[[look]]\nA = '#808080'", "invalid-file", "look[0].rgb"),
        (HEAD + 'A = "#80808"', "colour", "A"),
        (HEAD + 'FL3.1 = "#808080"', "colour", "FL3"),
        (
            HEAD + 'A = "#808080"\n\n[[look]]\nrgb = [2, 0, 0]\nA = "#808080"',
            "look",
            "rgb",
        ),
        (HEAD + "A = #808080", "invalid-file", "line 3"),
    ],
)
def test_invalid_files_are_refused(read_text, tmp_path, text, code, word):
    with raises(LookError, code) as caught:
        read_text(text)
    assert caught.value.path == tmp_path / "looks.toml"
    assert word in str(caught.value)
    assert caught.value.hint
