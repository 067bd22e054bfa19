"""The ART measurement archive, fact by fact."""

from __future__ import annotations

import numpy as np
import pytest

from tests.atlas.atlas_texts import ORANGE, PLAIN, THESIS
from uplift.atlas import read_atlas
from uplift.common.errors import AtlasError, UpliftWarning

HEADER_1_0 = "ART measurement archive version 1.0\n\nArchive content: greys\n\n"
HEADER_1_1 = (
    "ART measurement archive version 1.1\n\nArchive content: greys\n"
    "Archive copyright: (c) A. Person: 2020\nArchive license: CC0\n\n"
)
BISPECTRAL = """\
Reflectance start     :  400.0 nm
Reflectance increment :  100.0 nm
Illumination start    :  300.0 nm
Illumination increment:  100.0 nm
"""


def values(path):
    (entry,) = read_atlas(path).entries
    return entry.values.tolist()


def test_the_printed_entry_reads_once_its_samples_are_complete(save):
    (entry,) = read_atlas(save(ORANGE, "macbeth.txt")).entries
    assert (entry.name, entry.line) == ("orange", 1)
    assert entry.description == '"orange" patch of the Macbeth colour checker'
    np.testing.assert_array_equal(entry.wavelengths, np.arange(380.0, 785.0, 5.0))
    assert entry.values[:3].tolist() == [6.143748 / 100, 5.192119 / 100, 4.867970 / 100]


def test_the_printed_entry_as_printed_stops_at_the_dots(save):
    path = save(THESIS)
    with pytest.raises(AtlasError) as caught:
        read_atlas(path)
    assert str(caught.value) == (
        f"{path}:19: entry 'orange': sample '...' is not a number; write a plain number such as 0.125"
    )


def test_the_printed_samples_alone_do_not_cover_the_visible_range(save):
    with pytest.raises(
        AtlasError, match=r":1: entry 'orange': covers 380–440 nm, not the visible 400–700 nm"
    ):
        read_atlas(save(THESIS.replace(", ... }", "}")))


@pytest.mark.parametrize("header", ["", HEADER_1_0, HEADER_1_1, HEADER_1_1.replace("1.1", "1.2")])
def test_headers(save, header):
    spectra = read_atlas(save(header + PLAIN))
    assert spectra.names == ("grey",)
    stated = spectra.sources[0].header
    assert stated.content == ("greys" if header else "")
    assert (stated.copyright, stated.licence) == (
        ("(c) A. Person: 2020", "CC0") if "copyright" in header else ("", "")
    )


def test_metadata(save):
    (entry,) = read_atlas(save(PLAIN)).entries
    assert (entry.device, entry.measured_by, entry.date) == ("spectrometer", "A. Person", "2020-01-31")
    assert entry.step == 100


def test_additional_description(save):
    text = PLAIN.replace("Type  ", "Additional description:  matt side\nType  ", 1)
    assert read_atlas(save(text)).entries[0].additional == "matt side"


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.replace("\n", "   \n"),
        lambda text: text.replace("  :  ", "\t:\t"),
        lambda text: text.replace("  :  ", ":"),
        lambda text: text.replace(", ", ","),
        lambda text: text.replace(", ", " ,\n  "),
        lambda text: text.replace("{0.5, ", "{\n\n0.5,\n\n").replace("}", "\n}"),
        lambda text: text.replace("---------------------------------------------------------------", "<hr/>"),
        lambda text: text.replace("---", ""),
        lambda text: text.replace("\n", "\n\n"),
        lambda text: text.replace("0.0625", "6.25E-02"),
        lambda text: text.replace("400.0 nm", "400").replace("100.0 nm", "1e2nm"),
        lambda text: text.replace("Type  ", "TYPE  "),
        lambda text: text.replace("Measured by           :  A. Person\n", ""),
        lambda text: "\ufeff" + text,
        lambda text: text.rstrip("\n"),
    ],
)
def test_ways_of_writing_the_same(save, change):
    assert values(save(change(PLAIN))) == [0.5, 0.25, 0.125, 0.0625]


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ('"a grey card"', "a grey card"),
        ("a grey card", "a grey card"),
        ('"grey" and "card"', '"grey" and "card"'),
        ('""grey""', '"grey"'),
        ('"', '"'),
        ("", ""),
        ("ratio 1:2", "ratio 1:2"),
    ],
)
def test_descriptions(save, written, meant):
    assert read_atlas(save(PLAIN.replace("a grey card", written))).entries[0].description == meant


def test_several_entries_without_blank_lines_between(save):
    text = PLAIN.rstrip() + "\n" + PLAIN.replace("grey", "gray")
    assert read_atlas(save(text)).names == ("grey", "gray")


def test_latin_1_is_read_where_utf_8_fails(save):
    text = PLAIN.replace("A. Person", "Anežka Tódová".replace("ž", "z"))
    assert read_atlas(save(text.encode("latin-1"))).entries[0].measured_by == "Anezka Tódová"
    assert read_atlas(save(text.encode())).entries[0].measured_by == "Anezka Tódová"


@pytest.mark.parametrize(
    "samples", ["{{400, 50}, {555.5, 25}, {700, 12.5}}", "{ {400,50}{555.5,25}\n,{700,12.5} }"]
)
def test_point_samples(save, samples):
    text = PLAIN.replace("regular", "point sampled").replace("value  :  1.0", "value  :  100.0")
    text = text.replace("{0.5, 0.25, 0.125, 0.0625}", samples)
    text = text.replace("Start                 :  400.0 nm\nIncrement             :  100.0 nm\n", "")
    (entry,) = read_atlas(save(text)).entries
    assert entry.wavelengths.tolist() == [400, 555.5, 700]
    assert entry.values.tolist() == [0.5, 0.25, 0.125]
    assert entry.step is None


@pytest.mark.parametrize(
    "kind", ["emission spectrum", "colourimetric matching function", "colour matching function"]
)
def test_other_types_are_skipped_by_name(save, kind):
    other = PLAIN.replace("grey", "lamp").replace("reflectance spectrum", kind)
    other = other.replace("Fluorescence data     :  no\n", "").replace("Maximum sample value  :  1.0\n", "")
    path = save(PLAIN + other)
    with pytest.warns(UpliftWarning, match=f":19: entry 'lamp' skipped: its type is '{kind}'"):
        spectra = read_atlas(path)
    assert spectra.names == ("grey",)
    assert [(item.name, item.line) for item in spectra.skipped] == [("lamp", 19)]


def test_fluorescent_entries_are_skipped_by_name(save):
    text = PLAIN.replace("data     :  no", "data     :  yes").replace("{0.5,", "{{-0.01, 0},{0.5,")
    text = text.replace("0.0625}", "0.0625}}")
    text = text.replace("Start                 :  400.0 nm\nIncrement             :  100.0 nm\n", BISPECTRAL)
    for written in (text, text.replace("Fluorescence data     :  yes\n", "")):
        with pytest.warns(UpliftWarning, match="entry 'grey' skipped: it is fluorescent"):
            spectra = read_atlas(save(written + PLAIN.replace("grey", "plain")))
        assert spectra.names == ("plain",)
        assert spectra.skipped[0].name == "grey"


def without(key):
    return lambda text: "\n".join(line for line in text.split("\n") if not line.startswith(key))


FAULTS = [
    (without("Type"), 1, "the field 'Type' is missing; add a line 'Type : …'"),
    (without("Start"), 1, "the field 'Start' is missing; add a line"),
    (without("Increment"), 1, "the field 'Increment' is missing; add a line"),
    (without("Maximum"), 1, "the field 'Maximum sample value' is missing; add a line"),
    (without("{"), 1, "the sample list, opened by '{', is missing; complete the entry"),
    (without("Sampling info"), 16, "the entry has no section 'Sampling information'; complete the entry"),
    (without("ASCII"), 16, "the entry has no section 'ASCII sample data'; complete the entry"),
    (lambda text: text[: text.index("Measured by")], 6, "the entry has no section 'Sampling information'"),
    (lambda text: text[: text.index("25")], 17, "the sample list is not closed by '}'; complete the entry"),
    (lambda text: text.replace("}", "} 3"), 17, "unexpected text after the sample list; end the entry"),
    (lambda text: text.replace("}", "}\n\n\nabc"), 20, "unexpected text after the sample list"),
    (lambda text: text.replace("0.25", "0.25x"), 17, "sample '0.25x' is not a number; write a plain number"),
    (lambda text: text.replace("0.25,", "\n0.25,\n oops,"), 19, "sample 'oops' is not a number"),
    (lambda text: text.replace("0.25", "0.\n25"), 17, "sample '0. 25' is not a number"),
    (lambda text: text.replace("0.0625", "0.06 0.02\n"), 17, "sample '0.06 0.02' is not a number"),
    (lambda text: text.replace("0.25,", ","), 17, "sample '' is not a number"),
    (lambda text: text.replace("0.25", "0_2"), 17, "sample '0_2' is not a number"),
    (
        lambda text: text.replace("0.25", "{0.25}"),
        17,
        "braces within a regular sample list; write the samples",
    ),
    (lambda text: text.replace("400.0 nm", "0.4 µm"), 12, "'Start' '0.4 µm' is not a number"),
    (
        lambda text: text.replace("value  :  1.0", "value  :  0"),
        14,
        "'Maximum sample value' is 0; write 100.0",
    ),
    (lambda text: text.replace("value  :  1.0", "value  :  nan"), 14, "'Maximum sample value' is nan"),
    (
        lambda text: text.replace("value  :  1.0", "value  :  1e-320"),
        1,
        "sample 1 is not finite: inf at 400 nm",
    ),
    (lambda text: text.replace("reflectance spectrum", "smell"), 4, "unknown type 'smell'; the types are"),
    (
        lambda text: text.replace("regular", "random"),
        11,
        "unknown sampling type 'random'; write 'regular' or",
    ),
    (lambda text: text.replace("regular", "point sampled"), 12, "unknown field 'start'; the fields are"),
    (
        lambda text: text.replace(":  no", ":  perhaps"),
        5,
        "'Fluorescence data' is 'perhaps'; write 'yes' or 'no'",
    ),
    (
        lambda text: text.replace("Maximum", "Maximun"),
        14,
        "unknown field 'maximun sample value'; the fields are",
    ),
    (lambda text: text.replace("Measured by", "Measured for"), 7, "unknown field 'measured for'"),
    (lambda text: text.replace("Increment  ", "Start  "), 13, "the field 'Start' stands twice; remove one"),
    (
        lambda text: text.replace("Measured by  ", "A note\nMeasured by"),
        7,
        "unexpected text 'A note'; write 'key",
    ),
    (lambda text: text.replace("0.25", "nan"), 1, "sample 2 is not finite: nan at 500 nm; replace it"),
    (lambda text: text.replace("0.25", "inf"), 1, "sample 2 is not finite: inf at 500 nm; replace it"),
    (
        lambda text: text.replace("0.25", "25"),
        1,
        "reflectance 25 at 500 nm is out of range; the scale (in atlas",
    ),
    (lambda text: text.replace("0.25", "-0.25"), 1, "reflectance -0.25 at 500 nm is out of range; the scale"),
    (
        lambda text: text.replace("100.0 nm", "0 nm"),
        1,
        "wavelengths do not ascend: 400 nm, then 400 nm; sort",
    ),
    (lambda text: text.replace("100.0 nm", "-100 nm"), 1, "wavelengths do not ascend: 400 nm, then 300 nm"),
    (
        lambda text: text.replace("400.0 nm", "-400 nm"),
        1,
        "wavelength -400 nm is not positive; give wavelengths",
    ),
    (
        lambda text: text.replace("400.0 nm", "401 nm"),
        1,
        "covers 401–701 nm, not the visible 400–700 nm; add",
    ),
    (
        lambda text: text.replace("400.0 nm", "399 nm"),
        1,
        "covers 399–699 nm, not the visible 400–700 nm; add",
    ),
    (lambda text: text.replace(", 0.25, 0.125, 0.0625", ""), 1, "1 sample(s), at least 2 are needed; add"),
]


@pytest.mark.parametrize(("damage", "line", "message"), FAULTS)
def test_faults_name_file_line_entry_and_remedy(save, damage, line, message):
    path = save(damage(PLAIN))
    with pytest.raises(AtlasError) as caught:
        read_atlas(path)
    assert str(caught.value).startswith(f"{path}:{line}: entry 'grey': {message}")
    assert caught.value.hint
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        (HEADER_1_1, 7, "the archive has no entry; add entries"),
        (
            HEADER_1_1.replace("1.1", "2.0") + PLAIN,
            1,
            "archive version '2.0' is not known; write the archive as",
        ),
        ("# my atlas\n" + PLAIN, 1, "unexpected text '# my atlas'; write 'key : value'"),
        (
            "Archive colour: red\n" + PLAIN,
            1,
            "unknown field 'archive colour'; the fields are 'Archive content'",
        ),
        (PLAIN.replace(":   grey", ":"), 1, "entry '': an entry has no name; give every entry a name"),
    ],
)
def test_faults_outside_entries(save, text, line, message):
    path = save(text)
    with pytest.raises(AtlasError) as caught:
        read_atlas(path)
    assert str(caught.value).startswith(f"{path}:{line}: {message}")


@pytest.mark.parametrize(
    "samples", ["{1, 2, 3}", "{{400, 1}, {500}}", "{{400, 1}, 500, 1}", "{}", "{{400, 1, 2}}", "{{{400, 1}}}"]
)
def test_points_that_are_not_in_pairs(save, samples):
    text = PLAIN.replace("regular", "point sampled").replace("{0.5, 0.25, 0.125, 0.0625}", samples)
    text = text.replace("Start                 :  400.0 nm\nIncrement             :  100.0 nm\n", "")
    with pytest.raises(AtlasError, match=r"atlas.txt:15: entry 'grey': "):
        read_atlas(save(text))


def test_cutting_the_file_anywhere_is_an_atlas_error_or_a_whole_entry(save):
    text = PLAIN.rstrip()
    for end in range(1, len(text)):
        with pytest.raises(AtlasError, match=r"^[^\n]*atlas\.txt[^\n]*$"):
            read_atlas(save(text[:end]))


def test_long_lines_and_many_entries_are_read(save):
    long = PLAIN.replace("Increment             :  100.0", "Increment             :  0.1")
    long = long.replace("{0.5,", "{" + "0.123456, " * 3000)
    text = "".join(long.replace("grey", f"grey{i}") for i in range(30))
    assert len(read_atlas(save(text))) == 30


def test_braces_without_end_are_refused(save):
    """So many that a reader of quadratic cost would not come back."""
    with pytest.raises(AtlasError, match="not closed"):
        read_atlas(save(PLAIN.replace("}", "{" * 300_000)))
    with pytest.raises(AtlasError, match="braces within"):
        read_atlas(save(PLAIN.replace("}", "{" * 300_000 + "}" * 300_001)))
