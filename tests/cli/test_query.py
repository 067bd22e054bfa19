"""``uplift query``."""

import csv
import io
import json
import os
import subprocess
import sys

import colour
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from uplift_cli.output.diagnostics import hint_for

import uplift
from uplift.common.errors import ColourError
from uplift.extras.colour import colour_source

from .conftest import warning_lines

RED = [0.6038273388553378, 0.033104766570885055, 0.009721217320237849]
"""Linear sRGB of #cc3319."""
P3 = "0.68,0.32 0.265,0.69 0.15,0.06 0.3127,0.329"


@pytest.fixture
def table(home):
    """Write a file of colours and return its path."""

    def table(text):
        path = home / "colours.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return table


@pytest.fixture
def macbeth_cube(cubes):
    return cubes / "moments-8-macbeth.uplift"


@pytest.mark.parametrize(
    ("words", "rgb"),
    [
        ("#cc3319", RED),
        ("204 51 25 --encoded", RED),
        ("#c31", [RED[0], RED[1], 0.005605391624202723]),
        ("0.8 0.2 0.1", [0.8, 0.2, 0.1]),
        ("'0.8, 0.2, 0.1'", [0.8, 0.2, 0.1]),
        ("0,8 0,2 0,1", [0.8, 0.2, 0.1]),
        ("'0,8 0,2 1'", [0.8, 0.2, 1]),
        ("0,8;0,2;0,1", [0.8, 0.2, 0.1]),
        ("-0.0 0.2 1e-1", [0, 0.2, 0.1]),
        ("123456", [0.006048833022857055, 0.03433980680868217, 0.09305896284668747]),
    ],
)
def test_syntax_of_colours(ask, words, rgb):
    assert_allclose(ask(f"query {words}")["rgb"], rgb, rtol=0, atol=1e-15)


def test_several_colours_have_a_row_each(ask, run, refuse, home):
    words = "query 0.5,0.5,0.5 0.8 0.2 0.1 '0.1 0.2 0.3'"
    colours = [row["rgb"] for row in ask(words)]
    assert colours == [[0.5, 0.5, 0.5], [0.8, 0.2, 0.1], [0.1, 0.2, 0.3]]
    assert run(words, "--plot").stdout.count("#") == 3
    assert (home / "plot.png").is_file()
    assert refuse(words, "0.5").code == "colour"


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("0,2,0,3,0,4", "ambiguous-numbers"),
        ("1,0,5,0,25", "ambiguous-numbers"),
        ("1,0,0,5", "ambiguous-numbers"),
        ("0,2,0,3,0.4", "rgb-out-of-gamut"),
        ("0.2,,0.3,0.4", "colour"),
        ("#ff000, red", "colour"),
    ],
)
def test_lines_that_may_be_misread(refuse, table, line, code):
    assert refuse("query --input", table(f"{line}\n")).code == code


def test_whole_numbers_between_commas(ask, refuse, table):
    for text, options, rgb in (
        ("r,g,b,i,j,k\n0,1,0,3,0,4\n", "", [0, 1, 0]),
        ("1,0,0,1\n", "", [1, 0, 0]),
        ("0,255,0,25,0,25\n", "--encoded", [0, 1, 0]),
    ):
        (answer,) = ask(f"query {options} --input", table(text))
        assert answer["rgb"] == rgb
    for words in ("1,0,0,0,1,0", "0,2,0,3,0,4 --out-of-gamut clip"):
        assert refuse(f"query {words}").code == "ambiguous-numbers"


def test_rounding_is_not_out_of_gamut(run, ask):
    words = "query 1.000000001 -6e-17 0.5"
    assert ask(words)["rgb"] == [1, 0, 0.5]
    result = run(words)
    assert "requested" not in result.stdout
    assert not result.stderr


@pytest.mark.parametrize("command", [("query",), ("lab bounds",), ("paints mix",)])
def test_the_advice_on_colours_outside_the_gamut_works_as_it_stands(
    run, refuse, command
):
    words = (*command, "1.2,0,0")
    hint = hint_for(refuse(*words))
    option = hint[hint.index("--") :].split()
    assert option == ["--out-of-gamut", "desaturate"]
    assert run(*words, *option).stdout


@pytest.mark.parametrize(
    ("method", "rgb"),
    [("clip", [1, 0.3, 0]), ("desaturate-oklab", [1, 0.4215, 0.1069])],
)
def test_out_of_gamut_colours_are_mapped_with_a_warning(run, method, rgb):
    words = ("query", "-", "--out-of-gamut", method)
    result = run(*words, "--format", "json", input="1.4,0.3,-0.1\n#cc3319\n")
    (warning,) = warning_lines(result)
    assert "1 of 2" in warning
    answer, inside = json.loads(result.stdout)
    assert_allclose(answer["rgb"], rgb, rtol=0, atol=1e-3)
    assert answer["requested_rgb"] == [1.4, 0.3, -0.1]
    assert answer["round_trip"]["delta_e_2000"] < 0.01
    assert_allclose(inside["rgb"], RED)


@pytest.mark.parametrize("name", ["P3-D65", P3])
def test_colours_of_another_display(ask, name):
    theirs = colour.matrix_RGB_to_RGB("P3-D65", "sRGB")
    requested = ask("query 0.5 0.6 0.3 --input-space", name)["requested_rgb"]
    assert_allclose(requested, theirs @ [0.5, 0.6, 0.3], rtol=0, atol=3e-4)


@pytest.mark.parametrize(
    "text",
    [
        '"r","g","b"\n"0.8","0.2","0.1"\n"0.1","0.1","0.1"\n',
        "\ufeffr,g,b\r\n0.8,0.2,0.1\r\n0.1,0.1,0.1",
        "0.8 0.2 0.1\n\n0.1\t0.1\t0.1\n\n",
        "0.8;0.2;0.1\n 0.1; 0.1; 0.1\n",
        "sep=;\nRot;Grün;Blau;Name\n0,8;0,2;0,1;brick, red\n;;;\n0,1;0,1;0,1;coal;;\n",
        "0,8\t0,2\t0,1\n0,1 0,1  0,1\n",
        '"0,8","0,2","0,1"\n"0,1","0,1","0,1"\n',
        "0.8,\t0.2,\t0.1\n0.1, 0.1, 0.1\n",
        "r,g,b,name\n0.8,0.2,0.1,brick\n0.1,0.1,0.1,coal\n",
    ],
)
def test_syntax_of_files(ask, table, text):
    for source in (["--input", table(text)], ["-"]):
        answers = ask("query", *source, input=text.encode())
        colours = [answer["rgb"] for answer in answers]
        assert_array_equal(colours, [[0.8, 0.2, 0.1], [0.1] * 3])


def test_files_of_codes_and_hex(ask, table):
    path = table("#cc3319\ncc3319\n204,51,25\n#cc3319,brick\n")
    for answer in ask("query --encoded --input", path):
        assert_allclose(answer["rgb"], RED, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("0,0,0\n0,0,x\n", 2),
        ("r,g,b\n0,0,0\n\n0,0\n", 4),
        ("r,g,b\nr,g,b\n", 2),
        ("0,0,0\n0,1.5,0\n", 2),
        ("0,0," + "x" * 200_000, 1),
        (60_000 * "1", 1),
        ("", None),
        ("r,g,b\n", None),
        (b"0,0,0\n\xff\n", None),
    ],
)
def test_errors_in_files_have_the_line(refuse, table, text, line):
    path = table(text)
    error = refuse("query --input", path)
    assert isinstance(error, ColourError)
    assert error.where == (str(path) if line is None else f"{path}:{line}")
    assert len(str(error)) < len(str(path)) + 250
    piped = refuse("query -", input=path.read_bytes())
    assert (piped.line, piped.problem) == (line, error.problem)


def test_lines_and_their_numbers_do_not_depend_on_the_blocks(
    ask, run, table, monkeypatch
):
    monkeypatch.setattr(colour_source, "CHUNK", 1)
    path = table("\ufeffr,g,b,\u00e9\r\n0.1,0.2,0.3\r\u0020\n\n0.5,0.5,0.5")
    colours = [answer["rgb"] for answer in ask("query --input", path)]
    assert_array_equal(colours, [[0.1, 0.2, 0.3], [0.5] * 3])
    path.write_bytes(path.read_bytes() + b"\r\n0.5,0.5")
    assert f"{path}:6: " in run("query --input", path, code=2).stderr


def test_lines_parsed_at_once_are_those_parsed_one_by_one(ask, table):
    text = "0.1,0.2,0.3\n.5 1. 0\n1e-3;2E-2;+1e0\n0.2, 0.3, 0.4\n#cc3319\n"
    at_once = ask("query --input", table(text))
    # left to the parser of single lines
    quoted = text.replace("0.1,0.2,0.3", '"0.1","0.2","0.3"')
    assert ask("query --input", table(quoted)) == at_once


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="needs /dev/zero")
def test_an_endless_line_is_an_error(refuse):
    assert isinstance(refuse("query --input /dev/zero"), ColourError)


def test_lines_of_a_stream_are_answered_as_they_come():
    words = ["query", "-", "--format", "json", "--wavelengths", "500,600"]
    command = [sys.executable, "-m", "uplift_cli", *words]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as query:
        for line in (b"#cc3319\n", b"0.5,0.5,0.5\n"):
            query.stdin.write(line)
            query.stdin.flush()
            answer = b""
            while answer.count(b"0.") < 2:
                # This hangs if the answer waits for the end of the stream.
                chunk = query.stdout.read1()
                assert chunk
                answer += chunk
        query.communicate()
        assert query.returncode == 0


def test_colours_by_xyz_and_by_chromaticity(ask):
    xyz = ask("query --xyz 0.05 0.2 0.1 --light D65")
    assert min(xyz["rgb"]) < 0
    assert xyz["round_trip"]["delta_e_2000"] < 1e-3
    assert_allclose(xyz["lights"]["D65"]["xyz"], [0.05, 0.2, 0.1], atol=1e-5)
    by_xy = ask("query --xy", str(0.05 / 0.35), str(0.2 / 0.35), "--luminance", "0.2")
    assert_allclose(by_xy["reflectance"], xyz["reflectance"], rtol=0, atol=1e-6)


FIELDS = """
cube rgb requested_rgb wavelengths reflectance xyz round_trip cell status realisable
entry standard_error error_bound reference standard_errors error_bounds lights
unlike_atlas hsv hsl yiq dominant_wavelength complementary purity
"""


def test_json_has_every_field_of_an_entry(ask, macbeth_cube):
    cube = uplift.load(macbeth_cube)
    atlas = cube.data.atlas
    row = atlas.names.index("red")
    rgb = atlas.rgb[row].tolist()
    answer = ask("query --cube", macbeth_cube, *rgb)
    assert answer.keys() == set(FIELDS.split())
    assert answer["cube"]["atlases"] == ["macbeth.txt"]
    assert answer["standard_error"] == pytest.approx(atlas.error[row])
    assert answer["rgb"] == rgb
    assert_allclose(answer["reflectance"], cube.reflectance(rgb), rtol=0, atol=1e-12)
    assert_allclose(answer["round_trip"]["rgb"], rgb, rtol=0, atol=1e-6)
    assert answer["status"] == ["atlas primary", "atlas corner"]
    assert answer["entry"] == "red"


def test_classical_coordinates(ask):
    """Of encoded RGB; #ff0000 has the I and Q that the FCC's matrix of 1953 gives to
    red.
    """
    red = ask("query #ff0000")
    assert (red["hsv"], red["hsl"]) == ([0, 1, 1], [0, 1, 0.5])
    assert_allclose(red["yiq"], [0.30, 0.60, 0.21], atol=0.005)
    assert red["dominant_wavelength"] == pytest.approx(611.4, abs=0.5)
    grey = ask("query #808080")
    assert (grey["dominant_wavelength"], grey["purity"]) == (None, 0)
    assert ask("query #ff00ff")["complementary"]


def test_csv_has_the_numbers_of_json_and_of_the_library(ask, run, table, macbeth_cube):
    path = table("0.8,0.2,0.1\n0,0,0\n0,1,0\n#735244\n")
    line = "query --light A --light FL11 --wavelengths 450,550.5 --cube"
    words = macbeth_cube, "--input", path
    text = run(line, *words, "--format", "csv").stdout
    cube = uplift.load(macbeth_cube)
    rows = csv.DictReader(io.StringIO(text))
    for row, answer in zip(rows, ask(line, *words), strict=True):
        assert (row["entry"] or None) == answer["entry"]
        assert float(row["450"]) == answer["reflectance"][0]
        assert float(row["550.5"]) == answer["reflectance"][1]
        for key in ("standard_error", "error_bound"):
            assert float(row[key]) == answer[key]
            for light, error in answer[f"{key}s"].items():
                expected = getattr(cube, key)(answer["rgb"], light)
                assert error == pytest.approx(expected)
                assert float(row[f"{key}_{light}"]) == error
                assert row[f"hex_{light}"] == answer["lights"][light]["hex"]
    text = run("query --light FL11 --light HP1 --cube", *words).stdout
    assert "unlike the atlas" in text
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("650,450.5", [650, 450.5]),
        ("400:699:100", [400, 500, 600]),
        ("400:400:5", [400]),
        ("400:401:0.1", np.linspace(400, 401, 11)),
    ],
)
def test_wavelengths(ask, text, expected):
    answer = ask("query #cc3319 --wavelengths", text)
    assert_allclose(answer["wavelengths"], expected, rtol=1e-14)
    assert len(answer["reflectance"]) == len(expected)


def test_stored_answers_are_checked(
    run, ask, refuse, home, small_cube, plain_cube, table
):
    small_cube.save(home / "a.uplift")
    plain_cube.save(home / "b.uplift")
    colours = table("0.2,0.3,0.4\n0.5,0.1,0.7\n")
    answers = run("query --cube a.uplift --format csv --input", colours).stdout
    (home / "answers.csv").write_text(answers)
    assert "passed, 0 of 2" in run("query --cube a.uplift --check answers.csv").stdout
    failed = ask("query --cube b.uplift --check answers.csv", code=1)
    assert (failed["passed"], failed["colours"]) == (False, 2)
    assert failed["largest"] > failed["tolerance"]
    run("query --cube b.uplift --check answers.csv --tolerance 1")
    (home / "bad.csv").write_text("r,g,b,500\n0.1,0.2,0.3,x\n")
    assert refuse("query --check bad.csv").where == "bad.csv:2"
