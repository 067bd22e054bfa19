"""Tables of samples with their parts: what is read, and what raises where."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises, warns
from uplift.common.errors import AtlasError
from uplift.extras.colour.srgb import decode
from uplift.extras.paint.paint_samples import (
    MeasuredColours,
    MeasuredSpectra,
    read_paint_samples,
)
from uplift.extras.paint.paints_file import read_paints
from uplift.samples import sample_path

NM = np.arange(400, 701, 20)


def cells(*values):
    return ",".join(map(str, values))


def spectrum(value):
    return cells(*[value] * len(NM))


HEAD = f"name,white,blue,{cells(*NM)}\n"
TWO = f"{HEAD}a,1,,{spectrum(0.8)}\nb,1,3,{spectrum(0.2)}\n"
FILMS = f"""name,white,thickness (mm),ground,{cells(*NM)}
card,,,,{spectrum(0.85)}
thin,1,0.25,card,{spectrum(0.8)}
on black,1,1,black,{spectrum(0.4)}
thick,1,,,{spectrum(0.9)}
"""
COLOURS = "name,white,blue,colour\na,1,,#ffffff\nb,,1,#0000ff\nc,1,1,#8080c0\n"


@pytest.fixture
def write(tmp_path):
    def write(text, name="samples.csv"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def read(write):
    """A function that reads a text as samples."""
    return lambda text: read_paint_samples(write(text))


def test_columns_are_paints_by_name(read):
    samples = read(TWO)
    assert samples.names == ("a", "b")
    assert samples.paints == ("white", "blue")
    assert_allclose(samples.shares, [[1, 0], [0.25, 0.75]])
    assert samples.is_opaque.all()
    assert_array_equal(samples.wavelengths, NM)
    assert isinstance(samples.measured, MeasuredSpectra)
    assert_allclose(samples.measured.values, [[0.8] * 16, [0.2] * 16])


def test_parts_of_any_unit_are_shares(read):
    doubled = TWO.replace("a,1,,", "a,2,,").replace("b,1,3,", "b,2,6,")
    assert_allclose(read(doubled).shares, read(TWO).shares, rtol=1e-12)


def test_the_packaged_samples_are_of_invented_paints(repository):
    samples = read_paint_samples(sample_path("swatches.csv"))
    assert len(samples.paints) == 6
    assert np.isfinite(samples.thickness).sum() == 6
    assert_allclose(samples.shares.sum(axis=1), 1)
    assert_allclose(samples.grounds[-1].mean(), 0.045, atol=0.002)
    paints = read_paints(repository / "tests" / "reference" / "invented_paints.toml")
    rows = zip(samples.shares, samples.thickness, samples.grounds, strict=True)
    exact = [
        paints.reflectance(shares, None if np.isinf(depth) else depth, ground)
        for shares, depth, ground in rows
    ]
    assert_allclose(samples.measured.values, exact, atol=0.01)


def test_films_have_a_thickness_and_a_ground(read):
    samples = read(FILMS)
    assert samples.names == ("thin", "on black", "thick")
    assert_array_equal(samples.thickness, [0.25, 1, np.inf])
    assert_allclose(samples.grounds[:, 0], [0.85, 0, 1])


def test_decimal_commas_comments_and_percent(write, read):
    comments = "# of May\n\n" + TWO.replace("\nb", "\n  # a remark\nb")
    assert_array_equal(read(comments).shares, read(TWO).shares)
    local = TWO.replace(",", ";").replace("0.", "0,").replace(";3;", ";2,5;")
    assert_allclose(read(local).shares[1], [1 / 3.5, 2.5 / 3.5])
    assert_allclose(read(local).measured.values, read(TWO).measured.values)
    with warns("values-in-percent"):
        percent = read(TWO.replace("0.8", "80").replace("0.2", "20"))
    assert_allclose(percent.measured.values, read(TWO).measured.values)


OTHERS = {
    "L*a*b*": ("L*,a*,b*,", "90,-1,2,", "20,3,-50,"),
    "text": ("maker,batch no,", "Acme,7b,", "Acme,x,"),
    "a date": ("date,", "2026,", "2025,"),
    "an unused paint": ("red,", ",", ","),
    "a colour": ("colour,", "#ffffff,", "#0000ff,"),
    "quantities": (
        "Total (g),BatchNo,Gloss 60°,Temp (°C),Film weight,ΔE00,#,thickness SD,",
        "1,2,80,21.5,3,1,1,.1,",
        "4,3,81,21.5,3,1,2,.1,",
    ),
    "colours": ("R,G,B,", "250,251,252,", "10,20,200,"),
    "a note": ("note Glanz,", "80,", "81,"),
}


@pytest.mark.parametrize(("head", "first", "second"), OTHERS.values(), ids=OTHERS)
def test_other_columns_are_not_paints(read, head, first, second):
    text = TWO.replace("name,", f"name,{head}")
    text = text.replace("\na,", f"\na,{first}").replace("\nb,", f"\nb,{second}")
    samples = read(text)
    assert samples.paints == ("white", "blue")
    assert_array_equal(samples.shares, read(TWO).shares)
    assert isinstance(samples.measured, MeasuredSpectra)
    unused = [label for label in head.split(",") if label not in ("", "colour", "red")]
    assert [note for note in samples.notes if "not used" in note] == [
        f"not used: {', '.join(unused)}"
    ] * bool(unused)


WHOLE = f"""name,zinc,ochre,Glanz,{cells(*NM)}
a,100,,80,{spectrum(0.8)}
b,20,80,81,{spectrum(0.2)}
c,66.6,33.3,82,{spectrum(0.3)}
"""
RATIOS = WHOLE.replace("20,80,", "1,4,").replace("66.6,33.3,", "2,1,")
DECIDED = {
    "percent": (WHOLE, ("zinc", "ochre"), "Glanz"),
    "cells with a sign": (
        WHOLE.replace("100,", "100%,")
        .replace("20,80,", "20%,80 %,")
        .replace("66.6,33.3", "66.6%,33.3%"),
        ("zinc", "ochre"),
        "Glanz",
    ),
    "a sum": (
        WHOLE.replace(",Glanz", ",Summe,Glanz")
        .replace(",80,0", ",100,80,0")
        .replace(",81,", ",100,81,")
        .replace(",82,", ",99.9,82,"),
        ("zinc", "ochre"),
        "Summe, Glanz",
    ),
    "stated": (
        RATIOS.replace("Glanz", "Glanz (parts)").replace("zinc", "zinc white"),
        ("zinc white", "ochre", "Glanz"),
        "",
    ),
    "letters": (TWO.replace("white,blue", "W,B"), ("W", "B"), ""),
}


@pytest.mark.parametrize(("text", "paints", "unused"), DECIDED.values(), ids=DECIDED)
def test_a_whole_decides_where_labels_do_not(read, text, paints, unused):
    samples = read(text)
    assert samples.paints == paints
    assert samples.notes == ((f"not used: {unused}",) if unused else ())


LENGTHS = {
    "header": ("film thickness (µm)", "0.25", "0.5", (0.25, 0.5)),
    "abbreviation": ("DFT mil", "0.25", "0.5 mils", (0.25, 0.5)),
    "cells": ("Dry_Film_Thickness", "25 µm", "1 mil", (25, 25.4)),
    "camel case": ("FilmThickness [um]", "1", "0.001mm", (1, 1)),
}


@pytest.mark.parametrize(
    ("label", "first", "second", "values"), LENGTHS.values(), ids=LENGTHS
)
def test_thickness_has_a_unit(read, label, first, second, values):
    text = FILMS.replace("thickness (mm),ground", f"{label},Substrate")
    samples = read(
        text.replace("0.25,card", f"{first},card").replace("1,1,", f"1,{second},")
    )
    assert samples.paints == ("white",)
    assert_allclose(samples.thickness[:2], values)
    assert any("thickness in" in note for note in samples.notes)


def test_blank_rows_are_none(read):
    blank = TWO.replace("\nb", f"\n,,,{cells(*[''] * len(NM))}\n,\n\nb")
    assert_array_equal(read(blank).shares, read(TWO).shares)


def test_films_without_a_thickness_are_alike(read):
    text = FILMS.replace("thickness (mm)", "note").replace("0.25,card", ",card")
    samples = read(text.replace("1,1,black", "1,,black"))
    assert_array_equal(samples.thickness, [1, 1, np.inf])
    assert any("thickness" in note for note in samples.notes)


def test_codes_of_pigments_are_paints_and_wavelengths_are_not(read):
    text = TWO.replace("white", "PW6").replace("blue", "PB29")
    text = text.replace(cells(*NM), ",".join(f"R{nm}" for nm in NM))
    assert read(text).paints == ("PW6", "PB29")


def test_names_may_stand_last_and_rows_be_short(read):
    samples = read("white,blue,colour,name\n1,,#ffffff,a\n,1,#0000ff\n")
    assert samples.names == ("a", "")
    assert_array_equal(samples.shares, np.eye(2))


def test_quoted_names(read):
    text = TWO.replace("white", '"white, thick"').replace("\na,", '\n"the ""a""",')
    samples = read(text)
    assert samples.paints == ("white, thick", "blue")
    assert samples.names == ('the "a"', "b")


def test_colours_alone(read):
    samples = read(COLOURS)
    assert isinstance(samples.measured, MeasuredColours)
    codes = np.array([[255, 255, 255], [0, 0, 255], [128, 128, 192]])
    assert_allclose(samples.measured.values, decode(codes / 255))
    assert_array_equal(samples.wavelengths[[0, -1]], [400, 700])


def test_recipes_in_a_second_file(write):
    """Spectra in the text of atlases and in CGATS; the colours of recipes do not
    count.
    """
    recipes = write(COLOURS, "recipes.csv")
    wide = " ".join(f"{nm}" for nm in NM)
    cgats = "CGATS.17\nBEGIN_DATA_FORMAT\nSAMPLE_NAME "
    cgats += " ".join(f"SPECTRAL_NM{nm}" for nm in NM)
    cgats += "\nEND_DATA_FORMAT\nBEGIN_DATA\n"
    for name, value in (("b", 0.2), ("a", 0.8), ("x", 0.5)):
        cgats += f"{name} {' '.join([str(value)] * len(NM))}\n"
    cgats += "END_DATA\n"
    table = "name " + wide + "\n"
    table += f"b {spectrum(0.2)}\na {spectrum(0.8)}\n".replace(",", " ")
    for name, text in (("chart.txt", cgats), ("table.txt", table)):
        samples = read_paint_samples(write(text, name), recipes)
        assert samples.names == ("b", "a")
        assert samples.paints == ("white", "blue")
        assert_allclose(samples.shares, [[0, 1], [1, 0]])
        assert isinstance(samples.measured, MeasuredSpectra)
        assert_allclose(samples.measured.values[:, 0], [0.2, 0.8])


def test_uneven_fine_and_coarse_wavelengths_are_sampled_each_10_nm(read):
    for steps in (
        np.arange(400, 701, 50),
        np.arange(400, 701, 2),
        np.array([400, 430, 450, 500, 600, 700]),
    ):
        straight = cells(*np.interp(steps, [400, 700], [0.2, 0.8]).round(6))
        samples = read(f"name,white,{cells(*steps)}\na,1,{straight}\n")
        assert_array_equal(samples.wavelengths, np.arange(400, 701, 10))
        assert_allclose(samples.measured.values[0, [0, -1]], [0.2, 0.8], atol=0.01)


INVALID = {
    "no paints": (f"name,{cells(*NM)}\na,{spectrum(0.5)}\n", "no-paints", 0),
    "comments": ("# nothing\n", "no-paints", 0),
    "empty": ("", "atlas", 0),
    "two columns of a name": (TWO.replace("blue", "white"), "atlas", 0),
    "two samples of a name": (TWO.replace("\nb,", "\na,"), "atlas", 3),
    "infinite parts": (TWO.replace(",3,", ",inf,"), "invalid-parts", 3),
    "parts not a number": (TWO.replace(",3,", ",nan,"), "invalid-parts", 3),
    "negative parts": (TWO.replace(",3,", ",-3,"), "invalid-parts", 3),
    "a letter for a digit": (TWO.replace("a,1,,", "a,1,1o,"), "invalid-parts", 2),
    "an unknown quantity": (RATIOS, "ambiguous-column", 0),
    "two thicknesses": (
        FILMS.replace("white,thick", "WFT,thick").replace(",,,,0.85", ",,1,card,0.85"),
        "ambiguous-column",
        0,
    ),
    "thousands": (TWO.replace(",3,", ',"3,000",'), "invalid-parts", 3),
    "film without thickness": (FILMS.replace("1,1,black", "1,,black"), "atlas", 4),
    "no part": (TWO.replace("1,,", ",,").replace("1,3,", ",,"), "no-paints", 0),
    "negative thickness": (FILMS.replace("0.25", "-1"), "atlas", 3),
    "thickness 0": (FILMS.replace("0.25", "0"), "atlas", 3),
    "infinite thickness": (FILMS.replace("0.25", "inf"), "atlas", 3),
    "thickness of text": (FILMS.replace("0.25", "thin"), "atlas", 3),
    "film without ground": (FILMS.replace("0.25,card", "0.25,"), "atlas", 3),
    "unknown ground": (FILMS.replace("0.25,card", "0.25,grey"), "atlas", 3),
    "ground with paint": (FILMS.replace("0.25,card", "0.25,thick"), "atlas", 3),
    "bad code": (COLOURS.replace("#0000ff", "#0000f"), "atlas", 3),
    "a code is missing": (COLOURS.replace("#0000ff", ""), "atlas", 3),
    "missing reflectance": (TWO.replace("b,1,3,0.2,", "b,1,3,,"), "missing-value", 3),
}


@pytest.mark.parametrize(("text", "code", "line"), INVALID.values(), ids=INVALID)
def test_invalid_tables_raise_with_their_line(write, text, code, line):
    path = write(text)
    with raises(AtlasError, code) as caught:
        read_paint_samples(path)
    place = f"{path}:{line}" if line else f"{path}"
    assert caught.value.where.startswith(place)


def test_recipes_of_no_sample_raise(write):
    recipes = write(COLOURS, "recipes.csv")
    spectra = write(TWO.replace("\na", "\nx").replace("\nb", "\ny"))
    with raises(AtlasError, "recipe-without-sample"):
        read_paint_samples(spectra, recipes)
    with raises(AtlasError):
        read_paint_samples(spectra, spectra.with_name("none.csv"))
