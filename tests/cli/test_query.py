"""``uplift query``: every way to ask, every way to be answered, every way to be refused."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.image import imread
from uplift_cli.main import main

import uplift

from .conftest import SMALL


def ask(run, *arguments, **options):
    return json.loads(run("query", *arguments, "--format", "json", **options).stdout)


def test_the_answer_in_json(run):
    answer = ask(run, "--cube", SMALL, 0.7, 0.2, 0.05)
    cube = uplift.load(SMALL)
    assert answer["rgb"] == [0.7, 0.2, 0.05]
    assert answer["wavelengths"] == list(range(380, 781, 5))
    np.testing.assert_allclose(answer["reflectance"], cube.reflectance([0.7, 0.2, 0.05]), atol=1e-15)
    np.testing.assert_allclose(answer["round_trip"]["rgb"], [0.7, 0.2, 0.05], atol=1e-5)
    assert answer["round_trip"]["delta_e_2000"] < 0.01
    assert answer["cell"] == [5, 3, 1]
    assert answer["entry"] is None


def test_an_entry_s_colour_names_the_entry(run):
    assert ask(run, "--cube", SMALL, "#da7b2a")["entry"] == "orange"


@pytest.mark.parametrize(
    "words", [("#cc3319",), ("cc3319",), ("#CC3319",), ("204", "51", "25", "--8bit"), ("204,51,25", "--8bit")]
)
def test_codes_in_all_their_forms(run, words):
    np.testing.assert_allclose(ask(run, *words)["rgb"], uplift.load().decode([204, 51, 25]), atol=1e-15)


def test_three_hex_digits(run):
    assert ask(run, "#f80")["rgb"] == ask(run, "#ff8800")["rgb"]


@pytest.mark.parametrize(
    "words", [("0.1", "0.2", "0.3"), ("0.1,0.2,0.3",), ("0.1 0.2 0.3",), ("1e-1", ".2", "0.3")]
)
def test_numbers_in_all_their_forms(run, words):
    assert ask(run, *words)["rgb"] == [0.1, 0.2, 0.3]


@pytest.mark.parametrize(
    "text",
    [
        "0.1,0.2,0.3\n#cc3319\n",
        "r,g,b\n0.1,0.2,0.3\n#cc3319\n",
        "\ufeffR;G;B\r\n0.1;0.2;0.3\r\n\r\n#cc3319\r\n",
        "0.1 0.2 0.3\ncc3319",
        "0.1\t0.2\t0.3\tnote\n#cc3319\tnote\n",
    ],
)
def test_tables_in_all_their_forms(run, elsewhere, text):
    (elsewhere / "colours.csv").write_text(text, encoding="utf-8", newline="")
    expected = [[0.1, 0.2, 0.3], ask(run, "#cc3319")["rgb"]]
    assert [answer["rgb"] for answer in ask(run, "--input", "colours.csv")] == expected
    assert [answer["rgb"] for answer in ask(run, "-", stdin=text.encode())] == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("400:700:100", [400, 500, 600, 700]),
        ("400:690:100", [400, 500, 600]),
        ("555.5", [555.5]),
        ("450,550", [450, 550]),
    ],
)
def test_wavelengths_in_all_their_forms(run, text, expected):
    assert ask(run, 0.1, 0.2, 0.3, "--wavelengths", text)["wavelengths"] == expected


@pytest.mark.parametrize("mode", ["spectra", "moments", "refined"])
def test_modes_are_the_library_s(run, mode):
    answer = ask(run, "--cube", SMALL, 0.15, 0.25, 0.35, "--mode", mode)
    expected = uplift.load(SMALL).reflectance([0.15, 0.25, 0.35], mode=mode)
    np.testing.assert_allclose(answer["reflectance"], expected, atol=1e-12)


def test_csv_is_a_row_a_colour(run):
    out = run(
        "query", "-", "--format", "csv", "--wavelengths", "400,500", stdin="0.1,0.2,0.3\n1,1,1\n"
    ).stdout
    rows = list(csv.DictReader(io.StringIO(out)))
    assert list(rows[0]) == ["r", "g", "b", "delta_e_2000", "entry", "400", "500"]
    assert float(rows[1]["400"]) == pytest.approx(1, abs=1e-5)


def test_the_table_tells_what_one_wants_to_know(run):
    out = run("query", "--cube", SMALL, "#da7b2a").stdout
    for text in ("#da7b2a", "atlas entry orange", "ΔE00", "380–780 nm", "   550 nm"):
        assert text in out
    assert "\x1b" not in out
    several = run("query", "--cube", SMALL, "-", stdin="#da7b2a\n0,0,0\n").stdout
    assert len([line for line in several.splitlines() if "#" in line]) == 2


def test_the_plot_is_a_picture_and_is_not_replaced_unasked(run, refused):
    run("query", "#cc3319", "--plot", "red.png")
    picture = imread("red.png")
    assert picture.shape[0] > 300
    assert picture[..., :3].std() > 0.01
    assert "red.png: exists already; use --force" in refused("query", "#cc3319", "--plot", "red.png")
    run("query", "#cc3319", "--plot", "red.png", "--force")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("1.2", "0", "0"), "(1.2, 0, 0) lies outside [0, 1]"),
        (("-0.1", "0", "0"), "(-0.1, 0, 0) lies outside [0, 1]"),
        (("nan", "0", "0"), "(nan, 0, 0) lies outside"),
        (("inf", "0", "0"), "lies outside"),
        (("0.1", "0.2"), "'0.1 0.2' is no colour"),
        (("0.1", "0.2", "0.3", "0.4"), "is no colour"),
        (("red",), "'red' is no colour; write three numbers"),
        (("#cc33",), "is no colour"),
        (("256", "0", "0", "--8bit"), "8-bit codes run from 0 to 255"),
        (("-1", "0", "0", "--8bit"), "8-bit codes"),
        (("0", "0", "0", "--wavelengths", "700:400:10"), "are not clear"),
        (("0", "0", "0", "--wavelengths", "400:700:0"), "are not clear"),
        (("0", "0", "0", "--wavelengths", "400:700:1e-9"), "are not clear"),
        (("0", "0", "0", "--wavelengths", "blue"), "are not clear"),
        (("0", "0", "0", "--wavelengths", "-5"), "positive"),
        (("0", "0", "0", "--cube", "none.uplift"), "none.uplift: no such file"),
        (("0", "0", "0", "--cube", "."), "no such file"),
        (("--input", "none.csv"), "none.csv: No such file"),
        (("0", "0", "0", "--plot", "nowhere/a.png"), "no folder"),
    ],
)
def test_bad_questions_are_refused_in_one_line(refused, words, message):
    assert message in refused("query", *words)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0.1,0.2,0.3\n0.1,x,0.3\n", "standard input:2: '0.1 x 0.3' is no colour"),
        ("0.1,0.2\n", "standard input:1:"),
        ("", "standard input: no colours in it"),
        ("r,g,b\n", "no colours in it"),
        ("0.1,0.2,0.3\n0.1,0.2,7\n", "(0.1, 0.2, 7) lies outside"),
        (b"\xff\xfe\x00", "standard input"),
    ],
)
def test_bad_tables_are_refused_with_their_line(refused, text, message):
    assert message in refused("query", "-", stdin=text)


@pytest.mark.parametrize(
    "words", [(), ("0", "0", "0", "--input", "a.csv"), ("0", "0", "0", "--mode", "exact"), ("-x",)]
)
def test_questions_that_make_no_sense_show_how_to_ask(words):
    result = CliRunner().invoke(main, ["query", *words])
    assert result.exit_code == 2
    assert "Usage: " in result.stderr
