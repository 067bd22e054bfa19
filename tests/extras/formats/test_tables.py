"""Tables as people have them: read right, with a note on what was assumed,
or refused.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.fuzz.tables import check
from tests.helpers import raises, warns
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError, UnknownNameError
from uplift.extras.emission.lamps import read_lamps

NM = np.arange(380, 781, 20)
VALUES = np.round(0.08 + 0.47 / (1 + np.exp((600 - NM) / 20)), 4)


def lines(pattern="{:g},{:g}", factor=1.0, nm=NM):
    return "".join(
        pattern.format(at, round(value * factor, 6)) + "\n"
        for at, value in zip(nm, VALUES, strict=True)
    )


def row(name, factor=1.0, pattern="{:g}"):
    return (
        ",".join(
            [name, *(pattern.format(round(value * factor, 6)) for value in VALUES)]
        )
        + "\n"
    )


HEADER = ",".join(["name", *map(str, NM)]) + "\n"


def check_values(atlas, expected=VALUES):
    for entry in atlas:
        assert_allclose(entry.wavelengths, NM, atol=1e-6)
        assert_allclose(entry.values, expected, atol=1e-6)


@pytest.mark.parametrize("seed", range(30))
def test_generated_tables_are_read(tmp_path, seed):
    assert check(seed, tmp_path) == "read"


@pytest.mark.parametrize(
    "text",
    [
        "# reflectance in percent\n" + HEADER + row("felt"),
        "Paints (%R)\n" + HEADER + row("felt"),
        "Units: % Reflectance\n" + HEADER + row("felt"),
        HEADER + row("felt (%R)"),
        "name," + ",".join(f"R% {at}" for at in NM) + "\n" + row("felt"),
        "nm,Reflect. %\n" + lines(),
        "nm,felt [%]\n" + lines(),
        "Y Units: Reflectance (percentage)\nnm,felt\n" + lines(),
        "nm,felt\n" + lines("{:g},{:g} %"),
        "sample,wavelength,Reflectance (%)\n" + lines("felt,{:g},{:g}"),
    ],
)
def test_a_stated_percentage_wins_over_small_values(read, text):
    with warns("dark-percent"):
        atlas = read(text)
    assert "%" in atlas.sources[0].notes[-1] or "percent" in atlas.sources[0].notes[-1]
    check_values(atlas, VALUES / 100)


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("# reflectance as a fraction\n" + HEADER + row("a", 100), "scales-contradict"),
        ("nm,R (0-1)\n" + lines(factor=100), "scales-contradict"),
        ("# values in percent\nnm,R (fraction)\n" + lines(), "scales-contradict"),
        (HEADER + row("a").replace("0.", "1."), "scale-not-stated"),
        (lines("{:g} {:g}", 8), "scale-not-stated"),  # a lamp, perhaps
    ],
)
def test_contradictions_and_doubts_are_refused(read, text, code):
    with raises(AtlasError, code) as caught:
        read(text)
    assert "measured=" in caught.value.hint


def test_percent_signs_in_some_cells_are_refused(read):
    with raises(AtlasError, "mixed-scales"):
        read(HEADER + row("a").replace("\n", "%\n"))


@pytest.mark.parametrize(
    ("factor", "pattern", "divisor"),
    [
        (10000, '{:g},"{:,.0f}"', 10000),
        (18200, '{:g},"{:,.0f}"', 10000),
        (100, '{:g},"{:.3f}"', 100),
        (1, '{:g},"{:.4f}"', 1),
        (100, "{:g};{:.3f}", 100),
        (15000, '{:g}\t"{:,.0f}"', None),
        (15, '{:g},"{:.3f}"', None),
        (10000, "{:g},{:.0f}", None),
    ],
)
def test_commas_of_thousands(read, factor, pattern, divisor):
    """Those of 8 % × 10,000 have no comma, those of 8 % × 18,200 reach that of a white;
    the others may be decimal.
    """
    text = lines(pattern, factor)
    if ".0f" not in pattern:
        text = text.replace(".", ",")
    if divisor is None:
        with raises(AtlasError):
            read("nm,a\n".replace(",", pattern[4]) + text)
        return
    with warns(*["values-in-percent"] * (divisor == 100)):
        atlas = read("nm,a\n".replace(",", pattern[4]) + text)
    digits = 0 if ".0f" in pattern else 4
    check_values(atlas, np.round(VALUES * factor, digits) / divisor)


@pytest.mark.parametrize(("top", "code"), [(1.05, ""), (1.3, "x"), (9, "x"), (20, "")])
def test_values_without_any_label_may_be_of_another_quantity(read, top, code):
    text = lines("{:g} {:.6f}", top / VALUES.max())
    with warns(*["values-in-percent"] * (top == 20)):
        if code:
            with raises(AtlasError, "scale-not-stated"):
                read(text)
        else:
            check_values(read(text), VALUES / VALUES.max() * top / (100 ** (top == 20)))


def test_names_with_percentages_are_names(read):
    atlas = read(HEADER + row("grey 50%") + row("100 % black"))
    assert atlas.names == ("grey 50%", "100 % black")
    assert "assumed" in atlas.sources[0].notes[-1]
    check_values(atlas)


LIGHTS = ("wavelength,A,D65\n" + lines("{0:g},{1:g},{1:g}"),)
LIGHTS_WITHOUT_A_UNIT = (
    "LUX\t250.5\nCCT\t3050\nCRI\t92.1\nx\t0.43\n" + lines("{:g}nm\t{:g}"),
    "Illuminance [lx],344\n" + lines("Spectral Data {:g}[nm],{:g}"),
    "Name,LUX,CCT," + HEADER[5:] + row("a,300,3000"),
    "nm,Counts\n" + lines(factor=1000),
)


@pytest.mark.parametrize("text", [*LIGHTS, *LIGHTS_WITHOUT_A_UNIT])
def test_lights_are_no_reflectances(save, text):
    path = save(text)
    with raises(AtlasError, "not-reflectance") as caught:
        read_atlas(path)
    assert "read_lamps" in caught.value.hint
    with warns(*["lamp-unit"] * (text in LIGHTS_WITHOUT_A_UNIT)):
        lamps = read_lamps(path)
    check_values(lamps, VALUES / VALUES.max())


def test_columns_of_other_quantities_are_skipped_by_name(read):
    text = "nm,ochre,Transmittance,Std Dev\n" + lines("{:g},{:g},0.5,0.001")
    with warns("entry-skipped"):
        atlas = read(text)
    assert atlas.names == ("ochre",)
    assert [entry.name for entry in atlas.skipped] == ["Transmittance", "Std Dev"]
    two = "Sample,ochre,ochre,red,red\nnm,Mean,SD,K,S\n"
    with warns("entry-skipped"):
        heads = read(two + lines("{:g},{:g},0.01,0.2,0.3"))
    assert heads.names == ("ochre",)
    with warns("entry-skipped"):
        rows = read(HEADER + row("ochre") + row("Std Dev", 0.01))
    assert rows.names == ("ochre",)


@pytest.mark.parametrize(
    "label",
    [
        "{}[nm]",
        "{}nm",
        "nm{}",
        "λ{}",
        "R{}",
        "R_{}",
        "SPECTRAL_NM{}",
        "Refl ({} nm)",
        "X{}.0",
        "{}.0",
        "R% {}",
        "Spectral Data {}[nm]",
    ],
)
def test_labels_are_wavelengths_in_rows_and_columns(read, label):
    factor = 100 if "%" in label else 1
    heads = ["id", *(label.format(at) for at in NM)]
    check_values(read(",".join(heads) + "\n" + row("a", factor), "wide.csv"))
    labels = [label.format(at) for at in NM]
    check_values(read("label,a\n" + lines("{},{:g}", factor, labels), "tall.csv"))


@pytest.mark.parametrize(
    ("head", "pattern", "numbers"),
    [
        ("X Units: Wavelength (micrometers)", "{:.4f},{:g}", NM / 1000),
        ("Wavelength range: 0.35-2.5 µm\nnm,a", "{:g},{:g}", NM),
        ("Wavelength accuracy: 0.1 nm\nwavelength,a", "{:.4f},{:g}", NM / 1000),
    ],
)
def test_units_in_remarks_are_those_of_wavelengths(read, head, pattern, numbers):
    check_values(read(f"{head}\n" + lines(pattern, nm=numbers)))


@pytest.mark.parametrize(
    "text", [lines(nm=NM * 10), lines(nm=1e7 / NM), lines(nm=NM + 600)]
)
def test_units_that_nothing_states_are_refused_by_their_numbers(read, text):
    with raises(AtlasError, "atlas") as caught:
        read(text)
    assert "400–700 nm" in caught.value.problem


@pytest.mark.parametrize(
    "outside",
    [
        ["350 -0.2", "352 -0.37"], ["350 -9999", "360 -1.23e34"],
        ["2400 0.4", "2401 -9999"],
        ["973 0.7", "975 0.5", "975 0.6"], ["350 NaN", "900 n/a"],
        ["820 --", "840 -999"],
    ],
)  # fmt: skip
def test_faults_outside_the_used_range_are_cut_off(read, outside):
    atlas = read(lines("{:g} {:g}") + "\n".join(outside) + "\n")
    inside = (atlas[0].wavelengths >= 380) & (atlas[0].wavelengths <= 780)
    assert_allclose(atlas[0].values[inside], VALUES)


@pytest.mark.parametrize("mark", ["", "NaN", "n/a", "--", "-9999", "-1.23e34", "#N/A"])
def test_missing_values_within_the_range(save, mark):
    text = HEADER + row("a").replace(f",{VALUES[5]:g},", f",{mark},", 1) + row("b")
    path = save(text)
    with raises(AtlasError, "missing-value") as caught:
        read_atlas(path)
    assert (caught.value.line, caught.value.entry) == (2, "a")
    assert f"{NM[5]} nm" in caught.value.problem
    filled = read_atlas(path, missing="interpolate")
    assert NM[5] not in filled["a"].wavelengths
    assert any("interpolated" in note for note in filled.sources[0].notes)
    with warns("entry-skipped"):
        kept = read_atlas(path, missing="skip")
    assert kept.names == ("b",)
    assert kept.sources[0].missing == "skip"
    with raises(UnknownNameError, "unknown-name"):
        read_atlas(path, missing="zero")


@pytest.mark.parametrize("value", [10.0, 0.1])
def test_a_value_ten_times_its_neighbours_is_warned_of(read, value):
    values = np.full(81, 0.3 if value < 1 else 0.08)
    values[40] *= 1.1 * value if value > 1 else value / 1.1
    text = "nm,a\n" + "".join(
        f"{380 + 5 * at},{each:.4f}\n" for at, each in enumerate(values)
    )
    with warns("odd-value") as caught:
        read(text)
    assert (caught[0].entry, "580 nm" in caught[0].problem) == ("a", True)


@pytest.mark.parametrize(
    "text",
    [
        lines("{:g}.0 {:g}"),
        "Data from x\nUser: u\n>>>>>Begin Spectral Data<<<<<\n"
        + lines("{:g}\t{:g}")
        + ">>>>>End<<<<<\nsigned\n",
        lines("{:g},0;{:g}").replace("0.", "0,"),
        "nm;a\n" + lines("{:g},0;{:g}").replace("0.", "0,"),
        "nm,a,nm,b\n" + lines("{0:g},{1:g},{0:g},{1:g}"),
        "pixel,nm,a\n"
        + "".join(f"{at},{line}\n" for at, line in enumerate(lines().split())),
        "nm,cm-1,a\n"
        + "".join(
            f"{at:g},{1e7 / at:.6f},{value:g}\n"
            for at, value in zip(NM, VALUES, strict=True)
        ),
        "nm,a,,\n" + lines("{:g},{:g},,"),
        "nm,a,nm,b\n" + lines("{0:g},{1:g},{0:g},{1:g}") + ",,900,\n,,920,\n",
        "nm,a\n" + lines().replace("600", "nm,a\n600"),
        HEADER + row("a") + HEADER + row("b"),
        HEADER + "".join(",%" for _ in NM) + "\n" + row("a", 100),
        HEADER + "".join(",nm" for _ in NM) + "\n" + row("a"),
        f"{len(NM)}\n" + lines("{:g}\t{:g}"),
        "a,,b,\nnm,R,nm,R\n" + lines("{0:g},{1:g},{0:g},{1:g}"),
        "of 2024,1\n" + lines("{:g},{:g},").replace("\n", "") + "\nn,9\n",
        lines("{:g} {:g}, ").replace("\n", ""),
        "Paint,wave,R\n"
        + "".join(lines(f"{name},{{:g}},{{:g}}") for name in ("NA", 1)),
        "Sample No,"
        + HEADER[5:]
        + "".join(row(str(number)) for number in range(101, 801, 100)),
    ],
)
def test_where_a_table_begins_and_ends(read, text):
    check_values(read(text))


@pytest.mark.parametrize("pair", ["ochre,", "ochre,R", "ochre nm,ochre", "w 1,ochre"])
def test_a_column_before_each_spectrum_may_have_its_name(read, pair):
    heads = f"{pair},{pair.replace('ochre', 'umber')}\n"
    atlas = read(heads + lines("{0:g},{1:g},{0:g},{1:g}"))
    assert atlas.names == ("ochre", "umber")
    check_values(atlas)


def test_pairs_on_a_line_are_one_spectrum(read):
    pairs = [f"{at:g} {value:g}" for at, value in zip(NM, VALUES, strict=True)]
    atlas = read(
        "\n".join(" ".join(pairs[at : at + 3]) for at in range(0, len(pairs), 3)),
        "paint.txt",
    )
    assert atlas.names == ("paint",)
    check_values(atlas)


def test_a_second_table_is_skipped_by_name(read):
    with warns("entry-skipped"):
        atlas = read("nm R\n" + lines("{:g} {:g}") + "\nnm R\n" + lines("{:g} {:g}"))
    assert [entry.line for entry in atlas.skipped] == [25]
    check_values(atlas)


@pytest.mark.parametrize(
    "text",
    [
        "nm,"
        + ",".join(map(str, range(101, 801)))
        + "\n"
        + lines("{:g},{:g}" + ",0.5" * 699),
        lines("{:g} {:g} 0.5"),
        "nm,a\n" + lines("{:g},0,{:g}"),
    ],
)
def test_tables_that_may_mean_two_things_are_refused(read, text):
    with raises(AtlasError):
        read(text)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("a,b\nc,d\n1,x\n2,y\n", 3),
        ("hello\nworld\n", 1),
        ("name,400,x,700\na,1,1,1\n", 1),
    ],
)
def test_errors_show_the_line_that_was_not_understood(read, text, line):
    with raises(AtlasError, "not-an-atlas") as caught:
        read(text)
    assert caught.value.line == line
    assert text.split("\n")[line - 1].replace(",", " ") in caught.value.problem


def test_values_without_their_wavelengths(tmp_path):
    (tmp_path / "a.txt").write_text(
        "a paint\n" + "".join(f"{value}\n" for value in VALUES)
    )
    with raises(AtlasError, "not-an-atlas"):
        read_atlas(tmp_path / "a.txt")
    for name in ("Wavelengths_1.txt", "Wavelengths_2.txt"):
        (tmp_path / name).write_text(
            "Wavelengths in microns\n" + "".join(f"{at / 1000}\n" for at in NM)
        )
        if name == "Wavelengths_1.txt":
            atlas = read_atlas(tmp_path / "a.txt")
            check_values(atlas)
            assert any(name in note for note in atlas.sources[0].notes)
    with raises(AtlasError, "not-an-atlas"):  # which of the two?
        read_atlas(tmp_path / "a.txt")


@pytest.mark.parametrize(("xy", "factor"), [("{:g},0 {}", 100), ("{:g},0; {}", 100)])
def test_decimal_commas_of_jcamp(read, xy, factor):
    head = (
        "##TITLE=a\n##JCAMP-DX=4.24\n##XUNITS=NANOMETERS\n##YUNITS=% "
        "REFLECTANCE\n##XYPOINTS=(XY..XY)\n"
    )
    text = "".join(
        xy.format(at, f"{value * factor:.4f}".replace(".", ",")) + "\n"
        for at, value in zip(NM, VALUES, strict=True)
    )
    check_values(read(head + text + "##END=\n"))
    pairs = "".join(
        f"{at:g},{value * factor:.0f}\n" for at, value in zip(NM, VALUES, strict=True)
    )
    check_values(read(head + pairs + "##END=\n"), np.round(VALUES, 2))
