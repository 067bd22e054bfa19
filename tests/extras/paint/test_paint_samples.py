"""Tables of samples with their parts: what is read, and what raises where."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import raises
from uplift.common.errors import AtlasError
from uplift.extras.colour.srgb import decode
from uplift.extras.paint.paint_samples import (
    MeasuredColours,
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
    assert_array_equal(samples.wavelengths, NM)
    assert_allclose(samples.measured.values, [[0.8] * 16, [0.2] * 16])


def with_columns(head, first, second):
    """The samples of `TWO` with further columns before the paints."""
    text = TWO.replace("name,", f"name,{head}")
    return text.replace("\na,", f"\na,{first}").replace("\nb,", f"\nb,{second}")


QUANTITIES = "Total (g),BatchNo,Gloss 60°,Temp (°C),Film weight,ΔE00,#,thickness SD,"
SAME = {
    "parts of another unit": (TWO.replace("1,,", "2,,").replace("1,3,", "2,6,"), ""),
    "comments": ("# of May\n\n" + TWO.replace("\nb", "\n  # a remark\nb"), ""),
    "blank rows": (TWO.replace("\nb", f"\n,,,{cells(*[''] * 16)}\n,\n\nb"), ""),
    "decimal commas": (TWO.replace(",", ";").replace("0.", "0,"), ""),
    "L*a*b*": (with_columns("L*,a*,b*,", "90,-1,2,", "20,3,-50,"), "L*, a*, b*"),
    "an unused paint": (with_columns("red,", ",", ","), ""),
    "a colour": (with_columns("colour,", "#ffffff,", "#0000ff,"), ""),
    "letters of colours": (with_columns("R,G,B,", "5,1,2,", "1,20,200,"), "R, G, B"),
    "quantities": (
        with_columns(QUANTITIES, "1,2,80,21.5,3,1,1,.1,", "4,3,81,21.5,3,1,2,.1,"),
        QUANTITIES.rstrip(",").replace(",", ", "),
    ),
}


@pytest.mark.parametrize(("text", "unused"), SAME.values(), ids=SAME)
def test_other_columns_and_spellings_have_the_same_samples(read, text, unused):
    samples = read(text)
    expected = read(TWO)
    assert samples.paints == expected.paints
    assert_allclose(samples.shares, expected.shares, rtol=1e-12)
    assert_array_equal(samples.measured.values, expected.measured.values)
    assert samples.notes == ((f"not used: {unused}",) if unused else ())


def test_the_packaged_samples_are_of_invented_paints(repository):
    samples = read_paint_samples(sample_path("swatches.csv"))
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


WHOLE = f"""name,zinc,ochre,Glanz,{cells(*NM)}
a,100,,80,{spectrum(0.8)}
b,20,80,81,{spectrum(0.2)}
c,66.6,33.3,82,{spectrum(0.3)}
"""
RATIOS = WHOLE.replace("20,80,", "1,4,").replace("66.6,33.3,", "2,1,")
SUM = WHOLE.replace(",Glanz", ",Summe,Glanz").replace(",80,0", ",100,80,0")
STATED = RATIOS.replace("Glanz", "Glanz (parts)").replace("zinc", "zinc white")
DECIDED = {
    "percent": (WHOLE, ("zinc", "ochre")),
    "cells with a sign": (WHOLE.replace("20,80,", "20%,80 %,"), ("zinc", "ochre")),
    "a sum": (
        SUM.replace(",81,", ",100,81,").replace(",82,", ",99.9,82,"),
        ("zinc", "ochre"),
    ),
    "stated": (STATED, ("zinc white", "ochre", "Glanz")),
    "codes": (TWO.replace("white,blue", "PW6,PB29"), ("PW6", "PB29")),
    "quoted": (TWO.replace("white", '"white, thick"'), ("white, thick", "blue")),
}


@pytest.mark.parametrize(("text", "paints"), DECIDED.values(), ids=DECIDED)
def test_labels_or_else_a_whole_decide_what_is_a_paint(read, text, paints):
    assert read(text).paints == paints


LENGTHS = {
    "header": ("film thickness (µm)", "0.25", "0.5", (0.25, 0.5)),
    "cells": ("Dry_Film_Thickness", "25 µm", "1 mil", (25, 25.4)),
    "camel case": ("FilmThickness [um]", "1", "0.001mm", (1, 1)),
    "films alike": ("note", "", "", (1, 1)),
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
    assert_allclose(samples.thickness, [*values, np.inf])
    assert any("thickness" in note for note in samples.notes)


def test_colours_alone(read):
    samples = read(COLOURS)
    assert isinstance(samples.measured, MeasuredColours)
    codes = np.array([[255, 255, 255], [0, 0, 255], [128, 128, 192]])
    assert_allclose(samples.measured.values, decode(codes / 255))
    assert_array_equal(samples.wavelengths[[0, -1]], [400, 700])


def test_names_may_stand_last_and_rows_be_short(read):
    samples = read("white,blue,colour,name\n1,,#ffffff,a\n,1,#0000ff\n")
    assert samples.names == ("a", "")
    assert_array_equal(samples.shares, np.eye(2))


def test_recipes_in_a_second_file(write):
    """The colours of recipes do not count."""
    recipes = write(COLOURS, "recipes.csv")
    spectra = f"name,{cells(*NM)}\nb,{spectrum(0.2)}\nx,{spectrum(0.5)}\n"
    samples = read_paint_samples(write(f"{spectra}a,{spectrum(0.8)}\n"), recipes)
    assert samples.names == ("b", "a")
    assert samples.paints == ("white", "blue")
    assert_allclose(samples.shares, [[0, 1], [1, 0]])
    assert_allclose(samples.measured.values[:, 0], [0.2, 0.8])
    with raises(AtlasError, "recipe-without-sample"):
        read_paint_samples(write(f"name,{cells(*NM)}\ny,{spectrum(0.2)}\n"), recipes)


@pytest.mark.parametrize("nm", [range(400, 701, 50), range(400, 701, 2)])
def test_fine_and_coarse_wavelengths_are_sampled_each_10_nm(read, nm):
    straight = cells(*np.interp(nm, [400, 700], [0.2, 0.8]).round(6))
    samples = read(f"name,white,{cells(*nm)}\na,1,{straight}\n")
    assert_array_equal(samples.wavelengths, np.arange(400, 701, 10))
    assert_allclose(samples.measured.values[0, [0, -1]], [0.2, 0.8], atol=0.01)


INVALID = {
    "no paints": (f"name,{cells(*NM)}\na,{spectrum(0.5)}\n", "no-paints", 0),
    "two columns of a name": (TWO.replace("blue", "white"), "atlas", 0),
    "two samples of a name": (TWO.replace("\nb,", "\na,"), "atlas", 3),
    "infinite parts": (TWO.replace(",3,", ",inf,"), "invalid-parts", 3),
    "a letter for a digit": (TWO.replace("a,1,,", "a,1,1o,"), "invalid-parts", 2),
    "an unknown quantity": (RATIOS, "ambiguous-column", 0),
    "two thicknesses": (
        FILMS.replace("white,thick", "WFT,thick").replace(",,,,0.85", ",,1,card,0.85"),
        "ambiguous-column",
        0,
    ),
    "no part": (TWO.replace("1,,", ",,").replace("1,3,", ",,"), "no-paints", 0),
    "film without thickness": (FILMS.replace("1,1,black", "1,,black"), "atlas", 4),
    "thickness 0": (FILMS.replace("0.25", "0"), "atlas", 3),
    "unknown ground": (FILMS.replace("0.25,card", "0.25,grey"), "atlas", 3),
    "film without ground": (FILMS.replace("0.25,card", "0.25,"), "atlas", 3),
    "bad code": (COLOURS.replace("#0000ff", "#0000f"), "atlas", 3),
    "missing reflectance": (TWO.replace("b,1,3,0.2,", "b,1,3,,"), "missing-value", 3),
}


@pytest.mark.parametrize(("text", "code", "line"), INVALID.values(), ids=INVALID)
def test_invalid_tables_raise_with_their_line(write, text, code, line):
    path = write(text)
    with raises(AtlasError, code) as caught:
        read_paint_samples(path)
    place = f"{path}:{line}" if line else f"{path}"
    assert caught.value.where.startswith(place)
