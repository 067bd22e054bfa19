"""Reader of the ART measurement archive."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tests.atlas.atlas_texts import ORANGE, PLAIN
from tests.helpers import raises, warns
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError

HEADER_1_0 = "ART measurement archive version 1.0\n\nArchive content: greys\n\n"
HEADER_1_1 = (
    "ART measurement archive version 1.1\n\nArchive content: greys\n"
    "Archive copyright: (c) A. Person: 2020\nArchive license: CC0\n\n"
)
SAMPLES = "{0.5, 0.25, 0.125, 0.0625}"
REGULAR = "Start                 :  400.0 nm\nIncrement             :  100.0 nm\n"
BISPECTRAL = """\
Reflectance start     :  400.0 nm
Reflectance increment :  100.0 nm
Illumination start    :  300.0 nm
Illumination increment:  100.0 nm
"""


def test_printed_entry_with_complete_samples(read):
    (entry,) = read(ORANGE, "macbeth.txt").entries
    assert (entry.name, entry.line) == ("orange", 1)
    assert entry.description == '"orange" patch of the Macbeth colour checker'
    assert_array_equal(entry.wavelengths, np.arange(380.0, 785.0, 5.0))
    assert entry.values[:3].tolist() == [6.143748 / 100, 5.192119 / 100, 4.867970 / 100]


@pytest.mark.parametrize(
    "header", ["", HEADER_1_0, HEADER_1_1, HEADER_1_1.replace("1.1", "1.2")]
)
def test_headers(read, header):
    spectra = read(header + PLAIN)
    assert spectra.names == ("grey",)
    stated = spectra.sources[0].header
    assert stated.content == ("greys" if header else "")
    assert (stated.copyright, stated.licence) == (
        ("(c) A. Person: 2020", "CC0") if "copyright" in header else ("", "")
    )


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("  :  ", ":"),
        lambda text: text.replace(", ", " ,\n  "),
        lambda text: text.replace("{0.5, ", "{\n\n0.5,\n\n").replace("}", "\n}"),
        lambda text: text.replace(
            "---------------------------------------------------------------", "<hr/>"
        ),
        lambda text: text.replace("400.0 nm", "400").replace("100.0 nm", "1e2nm"),
        lambda text: text.replace("Measured by           :  A. Person\n", ""),
        lambda text: "\ufeff" + text,
    ],
)
def test_equivalent_notations(read, change):
    (entry,) = read(change(PLAIN))
    assert entry.values.tolist() == [0.5, 0.25, 0.125, 0.0625]


def test_latin_1_is_the_fallback_of_utf_8(read):
    text = PLAIN.replace("A. Person", "Anežka Tódová".replace("ž", "z"))
    assert read(text.encode("latin-1")).entries[0].measured_by == "Anezka Tódová"
    assert read(text.encode()).entries[0].measured_by == "Anezka Tódová"


@pytest.mark.parametrize(
    "samples",
    ["{{400, 50}, {555.5, 25}, {700, 12.5}}", "{ {400,50}{555.5,25}\n,{700,12.5} }"],
)
def test_point_samples(read, samples):
    text = PLAIN.replace("regular", "point sampled").replace(
        "value  :  1.0", "value  :  100.0"
    )
    (entry,) = read(text.replace(SAMPLES, samples).replace(REGULAR, "")).entries
    assert entry.wavelengths.tolist() == [400, 555.5, 700]
    assert entry.values.tolist() == [0.5, 0.25, 0.125]
    assert entry.step is None


OTHER = PLAIN.replace("grey", "other")
EMISSION = OTHER.replace("reflectance spectrum", "emission spectrum").replace(
    "Maximum sample value  :  1.0\n", ""
)
FLUORESCENT = OTHER.replace("data     :  no", "data     :  yes").replace(
    "{0.5,", "{{-0.01, 0},{0.5,"
)
FLUORESCENT = FLUORESCENT.replace("0.0625}", "0.0625}}").replace(REGULAR, BISPECTRAL)


@pytest.mark.parametrize(
    ("other", "reason"),
    [
        (EMISSION, "'emission spectrum'"),
        (FLUORESCENT, "fluorescent"),
        (FLUORESCENT.replace("Fluorescence data     :  yes\n", ""), "fluorescent"),
    ],
)
def test_entries_that_are_no_reflectances_are_skipped(save, other, reason):
    path = save(PLAIN + other)
    with warns("entry-skipped") as caught:
        spectra = read_atlas(path)
    assert caught[0].where == f"{path}:19: entry 'other'"
    assert reason in caught[0].problem
    assert spectra.names == ("grey",)
    assert [each.name for each in spectra.skipped] == ["other"]


def without(key):
    return "\n".join(line for line in PLAIN.split("\n") if not line.startswith(key))


def pairs(samples):
    return (
        PLAIN.replace("regular", "point sampled")
        .replace(REGULAR, "")
        .replace(SAMPLES, samples)
    )


FAULTS = [
    (without("Type"), 1),
    (without("{"), 1),
    (without("ASCII"), 16),
    (PLAIN[: PLAIN.index("Measured by")], 6),
    (PLAIN[: PLAIN.index("25")], 17),
    *(
        (PLAIN.replace(old, new), line)
        for old, new, line in (
            ("}", "}\n\n\nabc", 20),
            ("0.25,", "\n0.25,\n oops,", 19),
            ("0.0625", "0.06 0.02\n", 17),
            ("400.0 nm", "0.4 µm", 12),
            ("value  :  1.0", "value  :  0", 14),
            ("regular", "random", 11),
            ("regular", "point sampled", 12),
            (":  no", ":  perhaps", 5),
            ("0.25", "nan", 1),
            (", 0.25, 0.125, 0.0625", "", 1),
        )
    ),
    *(
        (pairs(samples), 15)
        for samples in (
            "{1, 2, 3}",
            "{{400, 1}, {500}}",
            "{{{400, 1}}}",
        )
    ),
]
OUTSIDE = [
    (HEADER_1_1, 7),
    (HEADER_1_1.replace("1.1", "2.0") + PLAIN, 1),
    ("Archive colour: red\n" + PLAIN, 1),
    (PLAIN.replace(":   grey", ":"), 1),
]


@pytest.mark.parametrize(
    ("text", "line", "entry"),
    [*((*each, "grey") for each in FAULTS), *((*each, None) for each in OUTSIDE)],
)
def test_faults_report_line_and_entry(read, text, line, entry):
    with raises(AtlasError, "atlas") as caught:
        read(text)
    assert (caught.value.line, caught.value.entry or None) == (line, entry)


def test_truncated_files_raise(read):
    text = PLAIN.rstrip()
    for end in range(1, len(text), 3):
        with raises(AtlasError):
            read(text[:end])


def test_unbalanced_braces_raise(read):
    """A reader of quadratic cost would not finish."""
    for braces in ("{" * 300_000, "{" * 300_000 + "}" * 300_001):
        with raises(AtlasError, "atlas"):
            read(PLAIN.replace("}", braces))
