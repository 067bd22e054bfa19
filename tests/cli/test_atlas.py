"""``uplift atlas``."""

import csv
import io
from itertools import chain
from pathlib import Path

from numpy.testing import assert_allclose, assert_array_equal

from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer

from .conftest import warning_lines

ATLASES = Path(__file__).parents[2] / "atlases"
MACBETH = str(ATLASES / "macbeth.txt")


def test_table_lists_entries_and_counts_those_out_of_gamut(run, monkeypatch):
    for width in ("80", "200"):
        monkeypatch.setenv("COLUMNS", width)
        text = run("atlas", MACBETH).stdout
        assert all(name in text for name in read_atlas(MACBETH).names)
        words = list(
            chain.from_iterable(
                line.split() for line in text.split("\n") if line.startswith("cyan")
            )
        )
        assert [word for word in words if word != "cyan"] == [
            "380",
            "780",
            "5",
            "-0.0334",
            "0.2488",
            "0.3855",
        ]
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
    assert [answer[key] for key in ("space", "illuminant", "observer")] == [
        "Display P3",
        "A",
        sensor.observer,
    ]
    assert answer["entries"][6].keys() == {
        "name",
        "start",
        "end",
        "step",
        "rgb",
        "in_gamut",
        "warnings",
    }
    assert (answer["sources"][0]["name"], answer["skipped"]) == ("macbeth.txt", [])


def test_skipped_entries_are_listed(run, refuse, home):
    text = Path(MACBETH).read_text("utf-8")
    lamps = text.replace("reflectance spectrum", "emission spectrum")
    (home / "lamps.txt").write_text(lamps, encoding="utf-8")
    assert refuse("atlas lamps.txt").code == "not-reflectance"  # none is left
    _, first, *others = lamps.split("Entry ID")
    first = first.replace("emission spectrum", "reflectance spectrum")
    (home / "lamps.txt").write_text("Entry ID".join(["", first, *others]), "utf-8")
    result = run("atlas lamps.txt")
    assert warning_lines(result)
    assert "1 entry, 0 out of the sRGB gamut, 23 skipped (light skin," in result.stdout


def test_conversion_round_trip(run, refuse, home):
    result = run("atlas -o out.csv", MACBETH)
    assert (result.stdout, result.stderr) == ("", "out.csv: 24 entries\n")
    run("atlas out.csv -o out.txt")
    for one, other in zip(
        read_atlas("out.txt").entries, read_atlas(MACBETH).entries, strict=True
    ):
        assert one.name == other.name
        assert_array_equal(one.values, other.values)
    assert refuse("atlas -o out.csv", MACBETH).code == "file-exists"
    run("atlas -o out.csv --force", MACBETH)


def test_shipped_atlases_are_listed_without_a_file(run, ask):
    atlases = ask("atlas")["atlases"]
    assert [atlas["name"] for atlas in atlases] == sorted(
        path.stem for path in ATLASES.glob("*.txt")
    )
    rows = list(csv.DictReader(io.StringIO(run("atlas --format csv").stdout)))
    text = run("atlas").stdout
    for atlas, row in zip(atlases, rows, strict=True):
        file = read_atlas(atlas["path"])
        assert (atlas["entries"], atlas["digest"]) == (
            len(file),
            file.sources[0].digest,
        )
        assert all(value == str(atlas[key]) for key, value in row.items())
        assert all(value in " ".join(text.split()) for value in row.values())
        assert (
            "https://opensource.org/licenses/BSD-3-Clause" in text
        )  # not broken between lines


GAPS = "name,400,500,600,700\nochre,0.1,,0.5,0.6\number,0.1,0.2,0.3,0.3\n"


def test_missing_values_are_refused_filled_or_skipped_and_a_build_is_repeated(
    run, ask, refuse, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("gaps.csv").write_text(GAPS)
    assert refuse("atlas gaps.csv").code == "missing-value"
    filled = ask("atlas gaps.csv --missing interpolate")
    assert [entry["name"] for entry in filled["entries"]] == ["ochre", "umber"]
    assert filled["sources"][0]["missing"] == "interpolate"
    assert [
        entry["name"] for entry in ask("atlas gaps.csv --missing skip")["skipped"]
    ] == ["ochre"]
    built = run(
        "build --atlas gaps.csv --missing interpolate --dim 3 -o gaps.uplift",
    )
    assert "assumed" in built.stdout  # the scale
    run("check gaps.uplift")


def test_what_a_build_will_clip_is_printed_when_an_atlas_is_written(
    run, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    Path("white.csv").write_text("name,400,500,600,700\nwhite,0.9,1.02,0.9,0.9\n")
    assert "1.02 at 500 nm" in run("atlas white.csv -o white.txt").stderr
