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


def row(name, factor=1.0):
    cells = [f"{round(value * factor, 6):g}" for value in VALUES]
    return ",".join([name, *cells]) + "\n"


NUMBERS = "nm," + ",".join(map(str, range(101, 801))) + "\n"
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
        "Units: % Reflectance\n" + HEADER + row("felt"),
        "name," + ",".join(f"R% {at}" for at in NM) + "\n" + row("felt"),
        "nm,Reflect. %\n" + lines(),
        "nm,felt\n" + lines("{:g},{:g} %"),
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
        (lines("{:g} {:.6f}", 1.3 / VALUES.max()), "scale-not-stated"),
        (HEADER + row("a").replace("\n", "%\n"), "mixed-scales"),
        (lines(nm=NM * 10), "atlas"),  # units that nothing states
        (lines(nm=1e7 / NM), "atlas"),
        (lines(nm=NM + 600), "atlas"),
        (NUMBERS + lines("{:g},{:g}" + ",0.5" * 699), ""),  # may mean two things
        (lines("{:g} {:g} 0.5"), ""),
        ("nm,a\n" + lines("{:g},0,{:g}"), ""),
        ("nm,a\n" + lines('{:g},"{:.3f}"', 15).replace(".", ","), ""),
        ("nm,a\n" + lines("{:g},{:.0f}", 10000), ""),
    ],
)
def test_contradictions_and_doubts_are_refused(read, text, code):
    with raises(AtlasError, code):
        read(text)


@pytest.mark.parametrize(
    ("factor", "pattern", "divisor"),
    [
        (10000, '{:g},"{:,.0f}"', 10000),
        (18200, '{:g},"{:,.0f}"', 10000),
        (100, '{:g},"{:.3f}"', 100),
        (1, '{:g},"{:.4f}"', 1),
        (100, "{:g};{:.3f}", 100),
        (15000, '{:g}\t"{:,.0f}"', None),
    ],
)
def test_commas_of_thousands(read, factor, pattern, divisor):
    """Those of 8 % × 10,000 have no comma, those of 8 % × 18,200 reach that of a white;
    the others may be decimal.
    """
    table = lines(pattern, factor)
    is_whole = ".0f" in pattern
    if not is_whole:
        table = table.replace(".", ",")
    text = f"nm{pattern[4]}a\n{table}"
    if divisor is None:
        with raises(AtlasError):
            read(text)
        return
    with warns(*["values-in-percent"] * (divisor == 100)):
        atlas = read(text)
    expected = np.round(VALUES * factor, 0 if is_whole else 4) / divisor
    check_values(atlas, expected)


def test_values_without_any_label_may_be_a_little_above_one(read):
    factor = 1.05 / VALUES.max()
    check_values(read(lines("{:g} {:.6f}", factor)), VALUES * factor)


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


@pytest.mark.parametrize(
    ("text", "skipped"),
    [
        (
            "nm,ochre,Transmittance,Std Dev\n" + lines("{:g},{:g},0.5,0.001"),
            ["Transmittance", "Std Dev"],
        ),
        (
            "Sample,ochre,ochre,red,red\nnm,Mean,SD,K,S\n"
            + lines("{:g},{:g},0.01,0.2,0.3"),
            ["SD", "red", "red"],
        ),
        (HEADER + row("ochre") + row("Std Dev", 0.01), ["Std Dev"]),
    ],
)
def test_spectra_of_other_quantities_are_skipped_by_name(read, text, skipped):
    with warns("entry-skipped"):
        atlas = read(text)
    assert atlas.names == ("ochre",)
    assert [entry.name for entry in atlas.skipped] == skipped


@pytest.mark.parametrize(
    "label",
    [
        "{}[nm]",
        "R{}",
        "SPECTRAL_NM{}",
        "Refl ({} nm)",
        "X{}.0",
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


@pytest.mark.parametrize("mark", ["", "NaN", "n/a", "--", "-9999", "-1.23e34", "#N/A"])
def test_missing_values_within_the_range(save, mark):
    path = save(HEADER + row("a").replace(f",{VALUES[5]:g},", f",{mark},") + row("b"))
    with raises(AtlasError, "missing-value") as caught:
        read_atlas(path)
    assert (caught.value.line, caught.value.entry) == (2, "a")
    assert f"{NM[5]} nm" in caught.value.problem
    filled = read_atlas(path, missing="interpolate")
    assert NM[5] not in filled["a"].wavelengths
    assert any("interpolated" in note for note in filled.sources[0].notes)
    with warns("entry-skipped"):
        kept = read_atlas(path, missing="skip")
    assert (kept.names, kept.sources[0].missing) == (("b",), "skip")
    with raises(UnknownNameError, "unknown-name"):
        read_atlas(path, missing="zero")


@pytest.mark.parametrize(("level", "value"), [(0.08, 0.88), (0.3, 0.027)])
def test_a_value_ten_times_its_neighbours_is_warned_of(read, level, value):
    cells = dict.fromkeys(range(380, 781, 5), level) | {580: value}
    with warns("odd-value") as caught:
        read("nm,a\n" + "".join(f"{at},{cell}\n" for at, cell in cells.items()))
    assert (caught[0].entry, "580 nm" in caught[0].problem) == ("a", True)


PAIRS = lines().split()
NUMBERED = "".join(row(str(number)) for number in range(101, 801, 100))
WAVE_NUMBERS = [f"{1e7 / at:.6f}" for at in NM]


@pytest.mark.parametrize(
    "text",
    [
        "pixel,nm,a\n" + "".join(f"{at},{pair}\n" for at, pair in enumerate(PAIRS)),
        "nm,cm-1,a\n" + "".join(map("{},{},{}\n".format, NM, WAVE_NUMBERS, VALUES)),
        "nm,a,nm,b\n" + lines("{0:g},{1:g},{0:g},{1:g}") + ",,900,\n,,920,\n",
        "nm,a\n" + lines().replace("600", "nm,a\n600"),
        HEADER + row("a") + HEADER + row("b"),
        HEADER + ",%" * len(NM) + "\n" + row("a", 100),
        HEADER + ",nm" * len(NM) + "\n" + row("a"),
        f"{len(NM)}\n" + lines("{:g}\t{:g}"),
        "a,,b,\nnm,R,nm,R\n" + lines("{0:g},{1:g},{0:g},{1:g}"),
        "of 2024,1\n" + lines("{:g},{:g},").replace("\n", "") + "\nn,9\n",
        lines("{:g} {:g}, ").replace("\n", ""),
        "\n".join(map(" ".join, np.reshape(lines("{:g} {:g}").split(), (-1, 6)))),
        "Paint,wave,R\n" + lines("NA,{:g},{:g}") + lines("1,{:g},{:g}"),
        HEADER.replace("name", "Sample No") + NUMBERED,
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


def test_a_second_table_is_skipped_by_name(read):
    with warns("entry-skipped"):
        atlas = read("nm R\n" + lines("{:g} {:g}") + "\nnm R\n" + lines("{:g} {:g}"))
    assert [entry.line for entry in atlas.skipped] == [25]
    check_values(atlas)


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
    path = tmp_path / "a.txt"
    path.write_text("a paint\n" + "".join(f"{value}\n" for value in VALUES))
    waves = "".join(f"{at / 1000}\n" for at in NM)
    with raises(AtlasError, "not-an-atlas"):
        read_atlas(path)
    (tmp_path / "Wavelengths_1.txt").write_text("Wavelengths in microns\n" + waves)
    atlas = read_atlas(path)
    check_values(atlas)
    assert any("Wavelengths_1.txt" in note for note in atlas.sources[0].notes)
    (tmp_path / "Wavelengths_2.txt").write_text("Wavelengths in microns\n" + waves)
    with raises(AtlasError, "not-an-atlas"):  # which of the two?
        read_atlas(path)
