"""``uplift query``."""

from __future__ import annotations

import csv
import io
import json
import math
import subprocess
import sys

import colour
import matplotlib.image
import numpy as np
import pytest

import uplift

RED = [0.6038273388553378, 0.033104766570885055, 0.009721217320237849]
"""Linear sRGB of #cc3319."""


@pytest.fixture
def ask(run):
    """The JSON that a query answers."""
    return lambda *args, **options: json.loads(run("query", *args, "--format", "json", **options).stdout)


@pytest.fixture
def table(home):
    """A file of colours."""

    def table(text):
        path = home / "colours.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return table


@pytest.mark.parametrize(
    ("words", "rgb"),
    [
        (["#cc3319"], RED),
        (["cc3319"], RED),
        (["#CC3319"], RED),
        (["204", "51", "25", "--encoded"], RED),
        (["204,51,25", "--encoded"], RED),
        (["#cc3319", "--encoded"], RED),
        (["#c31"], [RED[0], RED[1], 0.005605391624202723]),
        (["0.8", "0.2", "0.1"], [0.8, 0.2, 0.1]),
        (["0.8,0.2,0.1"], [0.8, 0.2, 0.1]),
        (["0.8, 0.2, 0.1"], [0.8, 0.2, 0.1]),
        (["0.8 0.2 0.1"], [0.8, 0.2, 0.1]),
        (["1", "0", "1e-1"], [1, 0, 0.1]),
        (["-0.0", "0.2", "0.1"], [0, 0.2, 0.1]),
        (["--", "-0.0", "0.2", "0.1"], None),
        (["123456"], [0.006048833022857055, 0.03433980680868217, 0.09305896284668747]),
    ],
)
def test_ways_to_write_a_colour(run, words, rgb):
    if "--" in words:
        result = run("query", "--format", "json", *words)
        assert json.loads(result.stdout)["rgb"] == [0, 0.2, 0.1]
        return
    answer = json.loads(run("query", *words, "--format", "json").stdout)
    np.testing.assert_allclose(answer["rgb"], rgb, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (["#cc331"], "'#cc331' is no colour"),
        (["c31"], "'c31' is no colour"),
        (["red"], "'red' is no colour"),
        (["0.1", "0.2"], "'0.1 0.2' is no colour"),
        (["0.1", "0.2", "0.3", "0.4"], "'0.1 0.2 0.3 0.4' is no colour"),
        (["0.1", "0.2", "x"], "'0.1 0.2 x' is no colour"),
        (["#cc3319", "#ffffff"], "'#cc3319 #ffffff' is no colour"),
        (["#cc3319", "0.5"], "'#cc3319 0.5' is no colour"),
        (["", ""], "'' is no colour"),
        (["0.1", "1.2", "0.3"], "linear RGB (0.1, 1.2, 0.3) lies outside [0, 1]"),
        (["-0.1", "0.2", "0.3"], "linear RGB (-0.1, 0.2, 0.3) lies outside [0, 1]"),
        (["0.3", "-.1", "0.3", "--mode", "moments"], "linear RGB (0.3, -0.1, 0.3) lies outside [0, 1]"),
        (["-0.1,0.2,0.3"], "linear RGB (-0.1, 0.2, 0.3) lies outside [0, 1]"),
        (["nan", "0.2", "0.3"], "linear RGB (nan, 0.2, 0.3) lies outside [0, 1]"),
        (["inf", "0.2", "0.3"], "linear RGB (inf, 0.2, 0.3) lies outside [0, 1]"),
        (["204", "51", "25"], "linear RGB (204, 51, 25) lies outside [0, 1]"),
        (["--encoded", "256", "0", "0"], "8-bit codes run from 0 to 255"),
        (["--encoded", "-1", "0", "0"], "8-bit codes run from 0 to 255"),
        (["--encoded", "nan", "0", "0"], "8-bit codes run from 0 to 255"),
    ],
)
def test_what_is_no_colour_is_refused(refuse, words, problem):
    assert refuse("query", *words).startswith(f"{problem}; ")


@pytest.mark.parametrize(
    ("way", "rgb"),
    [
        ("clip", [1, 0.3, 0]),
        ("scale", [1, 0.26667, 0]),
        ("desaturate", [1, 0.3916, 0.1704]),
        ("desaturate-oklab", [1, 0.4215, 0.1069]),
    ],
)
def test_colours_outside_are_moved_and_told(run, ask, way, rgb):
    words = ("1.4", "0.3", "-0.1", "--out-of-gamut", way)
    result = run("query", *words)
    assert result.stderr == (
        f"warning: 1 of 1 colours lie outside [0, 1]: moved inside ({way}), a component by up to 0.4\n"
    )
    assert result.stdout.startswith("asked       1.400000 0.300000 -0.100000  outside [0, 1], moved by ΔE00 ")
    answer = ask(*words)
    np.testing.assert_allclose(answer["rgb"], rgb, rtol=0, atol=1e-3)
    assert answer["asked"] == [1.4, 0.3, -0.1]
    assert answer["round_trip"]["delta_e_2000"] < 0.01


def test_colours_outside_in_files_are_moved_and_told(run, ask, table):
    path = table("0.8,0.2,0.1\n1.5,0.5,0.25\n#cc3319\n")
    words = ("--input", path, "--out-of-gamut", "scale")
    assert "warning: 1 of 3 colours lie outside" in run("query", *words).stderr
    answers = ask(*words)
    np.testing.assert_allclose(
        [answer["rgb"] for answer in answers], [[0.8, 0.2, 0.1], [1, 1 / 3, 1 / 6], RED]
    )
    np.testing.assert_allclose(
        [answer["asked"] for answer in answers], [[0.8, 0.2, 0.1], [1.5, 0.5, 0.25], RED]
    )


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("0,0,0\n0,0,inf\n", ":2: (0, 0, inf) is not finite"),
        ("nan,0,0\n", ":1: (nan, 0, 0) is not finite"),
    ],
)
def test_what_cannot_be_moved_is_named(refuse, table, text, problem):
    path = table(text)
    assert refuse("query", "--input", path, "--out-of-gamut", "clip").startswith(f"{path}{problem}; ")
    assert refuse("query", "nan", "0", "0", "--out-of-gamut", "scale").startswith(
        "linear RGB (nan, 0, 0) is not finite; "
    )


P3 = "0.68,0.32 0.265,0.69 0.15,0.06 0.3127,0.329"


@pytest.mark.parametrize("name", ["P3-D65", P3])
def test_colours_of_another_display(ask, name):
    theirs = colour.matrix_RGB_to_RGB("P3-D65", "sRGB")
    asked = ask("0.5", "0.6", "0.3", "--primaries", name)["asked"]
    np.testing.assert_allclose(asked, theirs @ [0.5, 0.6, 0.3], rtol=0, atol=3e-4)
    green = ask("0", "1", "0", "--primaries", name, "--out-of-gamut", "clip")
    np.testing.assert_allclose(green["asked"], theirs[:, 1], rtol=0, atol=3e-4)
    assert green["rgb"] == [0, 1, 0]


def test_what_lies_outside_another_display_may_lie_inside(ask, table):
    """The numbers of a file are judged where they are asked."""
    asked = ask("--input", table("-0.1,0.5,0.4"), "--primaries", "0.4,0.34 0.31,0.4 0.25,0.2 0.3127,0.329")
    assert 0 <= min(asked[0]["rgb"]) <= max(asked[0]["rgb"]) <= 1


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("P9", "unknown RGB space 'P9'; did you mean"),
        ("1,2", "primaries and white are eight numbers, got 2; "),
        ("1,2,", "primaries '1,2,' are not clear; "),
        (
            "1,0 2,0 3,0 0.3,0.3",
            "primaries must span a triangle with the white inside, got (1,0 2,0 3,0 0.3,0.3); ",
        ),
    ],
)
def test_what_is_no_display_is_refused(refuse, name, problem):
    assert refuse("query", "0.5", "0.6", "0.3", "--primaries", name).startswith(problem)


def test_codes_outside_have_no_colour_to_move(refuse):
    assert refuse("query", "--encoded", "256", "0", "0", "--out-of-gamut", "clip").startswith(
        "8-bit codes run"
    )


def test_a_file_and_a_colour_are_too_much(run, table):
    assert "Give one colour" in run("query", "#fff", "--input", table("0,0,0"), code=2).stderr


@pytest.mark.parametrize(
    "text",
    [
        "0.8,0.2,0.1\n0.1,0.1,0.1\n",
        "0.8,0.2,0.1\n0.1,0.1,0.1",
        "r,g,b\n0.8,0.2,0.1\n0.1,0.1,0.1\n",
        '"r","g","b"\n"0.8","0.2","0.1"\n"0.1","0.1","0.1"\n',
        "\ufeffr,g,b\n0.8,0.2,0.1\n0.1,0.1,0.1\n",
        "\ufeff0.8,0.2,0.1\n0.1,0.1,0.1\n",
        "0.8,0.2,0.1\r\n0.1,0.1,0.1\r\n",
        "0.8 0.2 0.1\n\n0.1\t0.1\t0.1\n\n",
        "0.8;0.2;0.1\n 0.1; 0.1; 0.1\n",
        "r,g,b,name\n0.8,0.2,0.1,brick\n0.1,0.1,0.1,coal\n",
    ],
)
def test_files_of_colours(ask, table, text):
    for source in (["--input", table(text)], ["-"], ["--input", "-"]):
        answers = ask(*source, input=text.encode())
        np.testing.assert_array_equal([answer["rgb"] for answer in answers], [[0.8, 0.2, 0.1], [0.1] * 3])


def test_files_of_codes_and_hex(ask, table):
    answers = ask("--input", table("#cc3319\ncc3319\n204,51,25\n#cc3319,brick\n"), "--encoded")
    np.testing.assert_allclose([answer["rgb"] for answer in answers], [RED] * 4, rtol=0, atol=1e-15)


def test_one_colour_in_a_file_is_an_array_of_one(ask, table):
    assert [answer["rgb"] for answer in ask("--input", table("0.8,0.2,0.1"))] == [[0.8, 0.2, 0.1]]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("0,0,0\n0,0,x\n", ":2: '0 0 x' is no colour"),
        ("r,g,b\n0,0,0\n\n0,0\n", ":4: '0 0' is no colour"),
        ("r,g,b\nr,g,b\n", ":2: 'r g b' is no colour"),
        ("0,0,0\n# a remark\n", ":2: '# a remark' is no colour"),
        ("0,0,0\n0,1.5,0\n", ":2: (0, 1.5, 0) lies outside [0, 1]"),
        ("0,0,nan\n", ":1: (0, 0, nan) lies outside [0, 1]"),
        ("0,0," + "x" * 200_000, ":1: field larger than field limit"),
        ("0,0 0," + "x" * 2000, ":1: '0 0 0 xxx"),
        ("", ": no colours in it"),
        ("r,g,b\n", ": no colours in it"),
        (b"\xff\xfe0\x00", ": is not text"),
        (b"0,0,0\n\xff\n", ": is not text"),
    ],
)
def test_bad_lines_are_named(refuse, table, text, problem):
    path = table(text)
    message = refuse("query", "--input", path)
    assert message.startswith(f"{path}{problem}")
    assert len(message) < len(str(path)) + 250
    assert refuse("query", "-", input=path.read_bytes()).startswith(f"standard input{problem}")


def test_bad_codes_in_a_file_are_named(refuse, table):
    path = table("0,0,0\n\n0,256,0\n")
    assert refuse("query", "--input", path, "--encoded").startswith(
        f"{path}:3: (0, 256, 0) lies outside 0 to 255; "
    )


def test_files_that_cannot_be_read(refuse, home):
    assert refuse("query", "--input", "none.csv").startswith(
        "none.csv: No such file or directory; name a CSV"
    )
    assert refuse("query", "--input", home).startswith(f"{home}: Is a directory; ")
    assert refuse("query", "--cube", "none.uplift", "#fff").startswith("none.uplift: no such file; ")
    assert refuse("query", "--cube", "x" * 300, "#fff").endswith(": no such file; 'uplift build' makes cubes")


def test_json_holds_the_whole_answer(ask, cubes):
    path = cubes / "moments-8-macbeth.uplift"
    cube = uplift.load(path)
    row = cube.data.atlas.names.index("red")
    answer = ask("--cube", path, *cube.data.atlas.rgb[row].tolist())
    assert answer.keys() == {
        *("rgb", "asked", "wavelengths", "reflectance", "round_trip", "cell", "status", "realisable"),
        *("entry", "standard_error", "reference"),
    }
    assert answer["standard_error"] == pytest.approx(cube.data.atlas.error[row])
    assert answer["rgb"] == cube.data.atlas.rgb[row].tolist()
    assert answer["wavelengths"] == list(range(380, 781, 5))
    np.testing.assert_allclose(answer["reflectance"], cube.reflectance(answer["rgb"]), rtol=0, atol=1e-12)
    assert answer["round_trip"].keys() == {"rgb", "delta_e_2000"}
    np.testing.assert_allclose(answer["round_trip"]["rgb"], answer["rgb"], rtol=0, atol=1e-6)
    assert answer["round_trip"]["delta_e_2000"] < 0.01
    assert len(answer["cell"]) == 3
    assert "atlas corner" in answer["status"]
    assert answer["entry"] == "red"


def test_csv_is_csv_alone(run, table, cubes):
    path = table("0.8,0.2,0.1\n0.1,0.1,0.1\n")
    result = run("query", "--input", path, "--format", "csv", "--wavelengths", "450,550.5")
    assert result.stderr == ""
    rows = list(csv.reader(io.StringIO(result.stdout)))
    assert rows[0] == ["r", "g", "b", "delta_e_2000", "standard_error", "entry", "450", "550.5"]
    expected = uplift.load().reflectance([[0.8, 0.2, 0.1], [0.1] * 3], [450, 550.5])
    np.testing.assert_allclose([[float(cell) for cell in row[6:]] for row in rows[1:]], expected, atol=1e-12)
    assert [float(cell) for cell in rows[1][:3]] == [0.8, 0.2, 0.1]
    assert rows[1][4:6] == ["", ""]


def test_the_modes_differ_and_spectra_is_the_default(ask):
    found = {
        mode: ask(*map(str, RED), "--mode", mode)["reflectance"] for mode in ("spectra", "moments", "refined")
    }
    assert found["spectra"] == ask(*map(str, RED))["reflectance"]
    assert len({tuple(values) for values in found.values()}) == 3


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("450", [450]),
        ("450,550,650", [450, 550, 650]),
        ("650,450.5", [650, 450.5]),
        ("400:700:100", [400, 500, 600, 700]),
        ("400:699:100", [400, 500, 600]),
        ("400:400:5", [400]),
        ("400:401:0.1", np.linspace(400, 401, 11)),
        ("1:1e5:1e5", [1]),
        ("300:900:300", [300, 600, 900]),
    ],
)
def test_wavelengths(ask, text, expected):
    answer = ask("#cc3319", "--wavelengths", text)
    np.testing.assert_allclose(answer["wavelengths"], expected, rtol=1e-14)
    assert len(answer["reflectance"]) == len(expected)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "red",
        "400:700",
        "400:700:0",
        "400:700:-5",
        "700:400:5",
        "400:700:5:5",
        "400,,500",
        "nan",
        "0",
        "-5",
        "-5:700:5",
        "inf",
        "400:nan:5",
        "400:inf:5",
        "400:700:nan",
        "400:700:1e-9",
        "1:1e300:1",
        "400;500",
    ],
)
def test_unclear_wavelengths_are_refused(run, text):
    result = run("query", "#cc3319", "--wavelengths", text, code=2)
    assert result.stdout == ""
    assert result.stderr.startswith("error: wavelengths ")
    assert result.stderr.count("\n") == 1


def test_the_sheet_shows_the_colour_and_every_wavelength(run, cubes):
    text = run("query", "--cube", cubes / "moments-8-macbeth.uplift", "#cc3319").stdout
    assert "#cc3319" in text
    assert "none here" in text
    assert all(f"{wavelength} nm" in text for wavelength in range(380, 781, 5))
    assert "\x1b" not in text


def test_the_table_has_a_line_a_colour(run, table):
    text = run("query", "--input", table("#cc3319\n#ffffff\n#000000\n")).stdout
    assert [word for line in text.splitlines() for word in line.split() if word.startswith("#")] == [
        "#cc3319",
        "#ffffff",
        "#000000",
    ]


def test_a_plot_is_a_picture(run, home):
    run("query", "#cc3319", "--plot", "red.png")
    picture = matplotlib.image.imread(home / "red.png")
    assert picture.ndim == 3
    apart = np.abs(picture[..., :3] - np.array([204, 51, 25]) / 255).max(axis=-1)
    assert (apart < 0.01).sum() > 100  # the line is drawn in the colour


def test_plots_are_replaced_by_force_alone(run, refuse, home, table):
    (home / "red.png").write_text("mine")
    assert refuse("query", "#cc3319", "--plot", "red.png").startswith("red.png: exists already; use --force")
    assert (home / "red.png").read_text() == "mine"
    run("query", "--input", table("#cc3319\n#ffffff\n"), "--plot", "red.png", "--force")
    assert matplotlib.image.imread(home / "red.png").size


def test_plots_that_cannot_be_written_are_refused_before_the_answer(refuse, home):
    assert "does not exist" in refuse("query", "#cc3319", "--plot", "none/red.png")
    assert "is not a regular file" in refuse("query", "#cc3319", "--plot", home)
    assert "cannot be written" in refuse("query", "#cc3319", "--plot", "x" * 300)


@pytest.mark.parametrize("style", ["json", "csv", "table"])
def test_a_query_imports_nothing_that_is_slow(style):
    code = (
        "import sys, atexit\n"
        "from uplift_cli.main import main\n"
        "slow = {'jax', 'colour', 'scipy', 'matplotlib'}\n"
        f"slow |= {{'rich'}} if {style!r} != 'table' else set()\n"
        "atexit.register(lambda: print(sorted(slow & set(sys.modules)), file=sys.stderr))\n"
        f"main(['query', '#cc3319', '--format', {style!r}])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, encoding="utf-8"
    )
    assert done.stdout
    assert done.stderr == "[]\n"


@pytest.mark.parametrize("colour", ["#000000", "#ffffff", "#ff0000", "#00ffff"])
def test_json_has_numbers_alone(run, colour):
    answer = json.loads(run("query", colour, "--format", "json").stdout, parse_constant=pytest.fail)
    assert all(math.isfinite(value) for value in answer["reflectance"])
