"""``uplift atlas``."""

import csv
import io
from pathlib import Path

from numpy.testing import assert_allclose, assert_array_equal

from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer

from .conftest import warning_lines

ATLASES = Path(__file__).parents[2] / "atlases"
MACBETH = str(ATLASES / "macbeth.txt")


def test_table_lists_entries_and_counts_those_out_of_gamut(run):
    text = run("atlas", MACBETH).stdout
    (cyan,) = [line for line in text.splitlines() if line.startswith("cyan")]
    assert cyan.split()[1:] == ["380", "780", "5", "-0.0334", "0.2488", "0.3855"]
    assert text.endswith(
        "24 entries, 1 out of the sRGB gamut (cyan), 0 skipped; Display P3 holds all "
        "24\n"
    )
    assert "54 entries, 2 out" in run("atlas", MACBETH, ATLASES / "pmc.txt").stdout


def test_json_has_the_colours_under_the_sensor(ask):
    answer = ask("atlas --illuminant A --space 'Display P3'", MACBETH)
    sensor = observer.sensor("Display P3", "A")
    expected = sensor.rgb(on_grid(read_atlas(MACBETH), sensor.wavelengths))
    assert_allclose(
        [entry["rgb"] for entry in answer["entries"]], expected, rtol=0, atol=1e-15
    )
    assert answer["sources"][0]["name"] == "macbeth.txt"


def test_skipped_entries_are_listed(run, refuse, home):
    text = Path(MACBETH).read_text("utf-8")
    lamps = text.replace("reflectance spectrum", "emission spectrum")
    (home / "lamps.txt").write_text(lamps, encoding="utf-8")
    assert refuse("atlas lamps.txt").code == "not-reflectance"  # none is left
    lamps = lamps.replace("emission spectrum", "reflectance spectrum", 1)
    (home / "lamps.txt").write_text(lamps, encoding="utf-8")
    result = run("atlas lamps.txt")
    assert warning_lines(result)
    assert "1 entry, 0 out of the sRGB gamut, 23 skipped (light skin," in result.stdout


def test_conversion_round_trip(run):
    run("atlas -o out.csv", MACBETH)
    run("atlas out.csv -o out.txt")
    for one, other in zip(
        read_atlas("out.txt").entries, read_atlas(MACBETH).entries, strict=True
    ):
        assert one.name == other.name
        assert_array_equal(one.values, other.values)


def test_shipped_atlases_are_listed_without_a_file(run, ask):
    atlases = ask("atlas")["atlases"]
    stems = {path.stem for path in ATLASES.glob("*.txt")}
    assert {atlas["name"] for atlas in atlases} == stems
    rows = csv.DictReader(io.StringIO(run("atlas --format csv").stdout))
    text = " ".join(run("atlas").stdout.split())
    for atlas, row in zip(atlases, rows, strict=True):
        assert atlas["entries"] == len(read_atlas(atlas["path"]))
        for key, value in row.items():
            assert value == str(atlas[key])
            assert value in text


GAPS = "name,400,500,600,700\nochre,0.1,,0.5,0.6\number,0.1,0.2,0.3,0.3\n"


def test_missing_values_are_refused_filled_or_skipped_and_a_build_is_repeated(
    run, ask, refuse, home
):
    (home / "gaps.csv").write_text(GAPS)
    assert refuse("atlas gaps.csv").code == "missing-value"
    filled = ask("atlas gaps.csv --missing interpolate")
    assert [entry["name"] for entry in filled["entries"]] == ["ochre", "umber"]
    assert filled["sources"][0]["missing"] == "interpolate"
    (skipped,) = ask("atlas gaps.csv --missing skip")["skipped"]
    assert skipped["name"] == "ochre"
    words = "build --atlas gaps.csv --missing interpolate --dim 3 -o gaps.uplift"
    assert "assumed" in run(words).stdout  # the scale
    run("check gaps.uplift")


def test_what_a_build_will_clip_is_printed_when_an_atlas_is_written(run, home):
    (home / "white.csv").write_text("name,400,500,600,700\nwhite,0.9,1.02,0.9,0.9\n")
    assert "1.02 at 500 nm" in run("atlas white.csv -o white.txt").stderr
