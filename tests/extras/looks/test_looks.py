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


def coded(sensor, colour):
    """Linear RGB of a colour of a look."""
    if isinstance(colour, str):
        return sensor.decode(list(bytes.fromhex(colour[1:])))
    return colour


def distances(cube, looks):
    """ΔE00 of the answers to the colours of looks from the wishes, computed from the
    definition.
    """
    found = []
    for look in looks:
        answer = cube.reflectance(coded(cube, look.rgb))
        for name, wish in look.lights.items():
            (screen,) = display_sensors([name], cube.observer)
            found.append(delta_e_rgb(screen, screen.rgb(answer), coded(screen, wish)))
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


def test_looks_are_no_evidence_for_errors(cubes):
    plain, looked = cubes
    one, other = (each.data.atlas for each in cubes)
    assert_array_equal(one.measured, other.measured)
    assert_allclose(one.left_out, other.left_out, atol=1e-6)
    count = one.measured_count
    for lights in ((), (light("FL11"),)):
        errors = looked.standard_error(other.rgb, *lights)
        assert errors[:count].max() < 0.5 < errors[count:].min()
    assert len(light_errors(looked.data, light("HP1")).entries) == count + 3
    assert_array_equal(looked.unlike_atlas(other.rgb), plain.unlike_atlas(other.rgb))
    entries = [each.entry for each in query(looked, other.rgb[count:])]
    assert entries == list(other.names[count:])


def test_impossible_look_is_reported_and_recorded():
    with warns("look-impossible", "entry-crowded") as found:
        cube = uplift.build(dim=2, prior="smooth", looks=[RED, IMPOSSIBLE])
    red, dusk = cube.data.provenance["looks"]
    (at_a,) = dusk["lights"]
    assert 0.5 < at_a["possible"] <= at_a["delta_e"] < at_a["possible"] + 0.2
    stored = [row["delta_e"] for row in (*red["lights"], *dusk["lights"])]
    assert_allclose(stored, distances(cube, [RED, IMPOSSIBLE]), atol=1e-5)
    assert stored[0] <= 0.1
    assert "look 'dusk'" in str(found[1])
    assert cube.reflectance(cube.data.atlas.rgb).max() <= 1


def test_look_that_few_coefficients_miss_is_reported():
    few = {"coefficients": 4, "entry_coefficients": 4}
    with warns("look-not-reached"):
        cube = uplift.build(dim=2, prior="smooth", looks=RED, **few)
    (record,) = cube.data.provenance["looks"]
    (lit,) = record["lights"]
    assert lit["possible"] < 0.1 < lit["delta_e"]


def test_cube_with_looks_is_stored_and_rebuilt(cubes, tmp_path):
    path = tmp_path / "looks.uplift"
    cubes[1].save(path)
    stored = uplift.load(path)
    assert stored.data.provenance["looks"] == cubes[1].data.provenance["looks"]
    rebuild(stored, path).save(tmp_path / "again.uplift")
    assert (tmp_path / "again.uplift").read_bytes() == path.read_bytes()


GREY_AT_A = {"A": "#808080"}


@pytest.mark.parametrize(
    ("looks", "options"),
    [
        ([RED, Look("#8a2a20", GREY_AT_A)], {}),
        ([Look("#40a060", GREY_AT_A, name="orange")], {}),
        ([Look("#da7b2a", GREY_AT_A)], {}),
        ([Look("#40a060", {"D65": "#808080"})], {}),
        ([Look("#40a060", {"FL11": "#808080", "fl11": "#808081"})], {}),
        ([Look([0, 1, 0], GREY_AT_A)], {"space": "ITU-R BT.2020"}),
        ([RED], {"model": "sigmoid"}),
        ([RED], {"coefficients": 3, "entry_coefficients": 3}),
    ],
)
def test_looks_that_contradict_or_cannot_be_met_are_refused(looks, options):
    with raises(LookError, "look"):
        quiet_build(MACBETH, dim=2, looks=looks, **options)


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
        (HEAD + "A = [0.1, 0.2, nan]", "colour", "A"),
        (HEAD + 'A = "#808080"\nweight = "1"', "look", "weight"),
    ],
)
def test_invalid_files_are_refused(read_text, tmp_path, text, code, word):
    with raises(LookError, code) as caught:
        read_text(text)
    assert caught.value.path == tmp_path / "looks.toml"
    assert word in str(caught.value)
    assert caught.value.hint
