"""Files in the layouts of instruments and programs give the spectra that they were
written from.
"""

import re
import sys
import zipfile

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.atlas.vendor_files import VENDORS, sample
from tests.helpers import raises, warns
from uplift.atlas.formats import known_formats
from uplift.atlas.sources import read_atlas
from uplift.common.errors import AtlasError, UnknownNameError
from uplift.extras.formats import spreadsheet
from uplift.extras.formats.envi import TYPES

MACBETH = sample(read_atlas("macbeth"))
LAYOUTS = {vendor.name: vendor for vendor in VENDORS}


@pytest.mark.parametrize("vendor", VENDORS, ids=lambda vendor: vendor.name)
def test_spectra_are_those_that_were_written(tmp_path, vendor):
    path = vendor.save(MACBETH[: vendor.count], tmp_path)
    with warns(
        *["values-in-percent"] * vendor.percent, *["entry-skipped"] * vendor.skipped
    ):
        atlas = read_atlas(path)
    assert atlas.sources[0].format == vendor.format
    assert len(atlas) == vendor.count
    if vendor.name != "argyll_sp":
        assert atlas.names == MACBETH[: vendor.count].names
    for entry, expected in zip(atlas, MACBETH, strict=False):
        assert_allclose(entry.wavelengths, expected.wavelengths, rtol=0, atol=1e-6)
        assert_allclose(entry.values, expected.values, rtol=0, atol=1e-6)


def test_rows_of_single_samples_name_the_bad_row(read):
    with raises(AtlasError, "atlas") as caught:
        read("sample,wavelength,reflectance\na,400,0.1\na,red,0.2\n")
    assert (caught.value.line, caught.value.entry) == (3, "a")


ROW = "name,400,500,600,700\n"
SETS = (
    "\nBEGIN_DATA_FORMAT\nID SPEC_400 SPEC_700\nEND_DATA_FORMAT\nBEGIN_DATA\na 1 "
    "1\nEND_DATA\n"
)


@pytest.mark.parametrize(
    ("text", "line", "entry"),
    [
        (ROW + "a,0.2,0.3,0.4,0.5\nb,0.4,45,0.5,0.5\nc,0.1,0.2,0.3,0.4\n", 3, "b"),
        (ROW + "a,0.2,0.3,0.4,0.5\nb,40,45,50,50\nc,0.1,0.2,0.3,0.4\n", 3, "b"),
        (ROW + "a,20,30,40,50\nb,40,0.45,50,50\n", 3, "b"),
        (ROW + "a,0.2,0.3,0.4,50\n", 2, "a"),
    ],
)
def test_mixed_scales_name_the_row(read, text, line, entry):
    with raises(AtlasError, "mixed-scales") as caught:
        read(text)
    assert (caught.value.line, caught.value.entry) == (line, entry)


def test_scale_given_by_the_caller(save):
    dark = save(ROW + "trap,0.4,0.5,0.5,0.4\ngrey,20,20,20,20\n")
    found = read_atlas(dark, measured="percent")
    assert (found["trap"].values.tolist(), found.sources[0].measured) == (
        [0.004, 0.005, 0.005, 0.004],
        "percent",
    )
    for scale, error, code in (
        ("fraction", AtlasError, "atlas"),
        ("per mille", UnknownNameError, "unknown-name"),
    ):
        with raises(error, code):
            read_atlas(dark, measured=scale)


def test_conditions_of_cxf_are_kept_in_names(tmp_path):
    path = LAYOUTS["cxf3"].save(MACBETH[:2], tmp_path)
    spectrum = re.compile(r'<cc:ReflectanceSpectrum ColorSpecification="[^"]*"')
    text = path.read_text()
    (one, *_) = re.findall(
        r"<cc:ReflectanceSpectrum.*?</cc:ReflectanceSpectrum>", text, re.DOTALL
    )
    three = "".join(
        spectrum.sub(f'<cc:ReflectanceSpectrum ColorSpecification="{each}"', one)
        for each in ("M0", "M1", "U")
    )
    path.write_text(text.replace(one, three))
    atlas = read_atlas(path)
    assert atlas.names == ("dark skin M0", "dark skin M1", "dark skin U", "light skin")
    assert any("M0, M1" in note for note in atlas.sources[0].notes)
    (other,) = re.findall(r'"M1">(.*?)</', path.read_text())
    path.write_text(path.read_text().replace(other, "0.75 " * len(other.split()), 1))
    first = next(note for note in read_atlas(path).sources[0].notes if "M0" in note)
    least = min(read_atlas(path)["dark skin M0"].values)
    assert f"differ by up to {0.75 - least:.2g}" in first


def test_two_objects_of_a_name_are_refused_with_the_place_of_the_first(tmp_path):
    path = LAYOUTS["cxf3"].save(MACBETH[:2], tmp_path)
    path.write_text(path.read_text().replace("light skin", "dark skin"))
    with raises(AtlasError, "atlas") as caught:
        read_atlas(path)
    assert caught.value.problem.endswith(str(path))


def test_ignored_values_of_libraries_are_missing(tmp_path):
    path = LAYOUTS["envi_floats"].save(MACBETH[:1], tmp_path)
    header = path.with_suffix(".hdr")
    value = float(MACBETH[0].values[5])
    header.write_text(f"{header.read_text()}data ignore value = {value!r}\n")
    with raises(AtlasError, "missing-value") as caught:
        read_atlas(path)
    assert "430 nm" in caught.value.problem
    assert 430 not in read_atlas(path, missing="interpolate")[0].wavelengths


def test_transmittances_of_cxf_are_skipped(tmp_path):
    path = LAYOUTS["cxf3"].save(MACBETH, tmp_path)
    text = path.read_text()
    first = text.index("<cc:ReflectanceSpectrum")
    last = text.index("</cc:ReflectanceSpectrum>") + len("</cc:ReflectanceSpectrum>")
    path.write_text(
        text[:first]
        + text[first:last].replace("Reflectance", "Transmittance")
        + text[last:]
    )
    with warns("entry-skipped"):
        atlas = read_atlas(path)
    assert [skipped.name for skipped in atlas.skipped] == ["dark skin"]
    assert len(atlas) == 5


@pytest.mark.parametrize(
    "format",
    [form for form in known_formats() if form.extra],
    ids=lambda form: form.name,
)
def test_missing_packages_are_named(tmp_path, monkeypatch, format):
    modules = {"colour-cxf": "colour_cxf", "python-calamine": "python_calamine"}
    module = modules.get(format.library, format.library)
    for name in [name for name in sys.modules if name.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    vendor = next(each for each in VENDORS if each.format == format.name)
    with raises(AtlasError, "extra-not-installed") as caught:
        read_atlas(vendor.save(MACBETH[: vendor.count], tmp_path))
    assert "pip install" in caught.value.hint


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (
            (
                '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "b">]>\n<IESTM2714 '
                'xmlns="i">&a;</IESTM2714>'
            ),
            "atlas",
        ),
        (
            '<IESTM2714 xmlns="i">' + "<a>" * 100 + "</a>" * 100 + "</IESTM2714>",
            "atlas",
        ),
        ('<IESTM2714 xmlns="iestm2714"/>', "atlas"),
        (
            '<cc:CxF xmlns:cc="http://colorexchangeformat.com/CxF3-core"/>',
            "not-an-atlas",
        ),
        ("##TITLE=a\n##NPOINTS=1000000000\n", "atlas"),
        (
            "##TITLE=a\n##XUNITS=HZ\n##YUNITS=REFLECTANCE\n##XYPOINTS=(XY..XY)\n1, 1\n",
            "atlas",
        ),
        ("##TITLE=a\n##XYDATA=(X++(Y..Y))\n400 q\n", "atlas"),
        ("CGATS.17\nBEGIN_DATA_FORMAT\nEND_DATA_FORMAT\n", "atlas"),
        (
            (
                "CGATS.17\nBEGIN_DATA_FORMAT\nID LAB_L\nEND_DATA_FORMAT\nBEGIN_DATA\n1 "
                "2\nEND_DATA\n"
            ),
            "atlas",
        ),
        (
            (
                'X\nSPECTRAL_NORM "0"\nBEGIN_DATA_FORMAT\nnm400 '
                "nm700\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2\nEND_DATA"
            ),
            "atlas",
        ),
        (b"PK\x03\x04junk", "not-spectra"),
        (b"PK\x03\x04" + bytes(26) + b"x.npy", "not-spectra"),
        (b"%PDF-1.7\n", "not-spectra"),
        ("ENVI\nsamples = 3\n", "file-not-found"),
        ("name,nm410,nm550,nm690\na,1,1,1\n", "atlas"),
    ],
)
def test_damaged_files_raise(read, text, code):
    with raises(AtlasError, code):
        read(text)


SHEET_XML = (
    '<worksheet><sheetData><row r="1"><c '
    'r="A1"><v>1</v></c></row>{}</sheetData></worksheet>'
)


@pytest.mark.parametrize(
    "row",
    [
        '<row r="1048576"><c r="XFD1048576"><v>2</v></c></row>',
        '<row r="4294967290">' + "<c><v>2</v></c>" * 2 + "</row>",
    ],
)
def test_sheets_with_distant_cells_are_refused_before_they_are_allocated(tmp_path, row):
    with zipfile.ZipFile(tmp_path / "a.xlsx", "w") as archive:
        archive.writestr("xl/worksheets/sheet1.xml", SHEET_XML.format(row))
    with raises(AtlasError, "atlas") as caught:
        read_atlas(tmp_path / "a.xlsx")
    assert f"{spreadsheet.MAX_CELLS:,} cells" in caught.value.problem


@pytest.mark.parametrize(("limit", "value"), [("MAX_CONTENT", 100), ("MAX_CELLS", 10)])
def test_content_of_archives_is_limited(tmp_path, monkeypatch, limit, value):
    monkeypatch.setattr(spreadsheet, limit, value)
    with raises(AtlasError, "atlas"):
        read_atlas(LAYOUTS["xlsx"].save(MACBETH, tmp_path))


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda text: text.replace("lines = 6", "lines = 600000000"), "atlas"),
        (
            lambda text: text.replace("ENVI Spectral Library", "ENVI Standard"),
            "not-an-atlas",
        ),
        (lambda text: text.replace("Micrometers", "Furlongs"), "atlas"),
        (lambda text: text.replace("factor = 100000000", "factor = -1"), "atlas"),
        (lambda text: text.replace("{0.38000", "{1e306"), "atlas"),
        (lambda text: text.replace("ENVI", "NVI"), "not-an-atlas"),
        (lambda text: text.replace("data type = 3", "data type = 6"), "atlas"),
        (lambda text: text.replace("offset = 0", "offset = 8"), "atlas"),
        (lambda text: text.replace("bands = 1", "bands = 2"), "atlas"),
        (lambda text: text.replace("dark skin, ", ""), "atlas"),
    ],
)
def test_damaged_libraries_raise(tmp_path, change, code):
    path = LAYOUTS["envi"].save(MACBETH, tmp_path)
    header = path.with_suffix(".hdr")
    header.write_text(change(header.read_text()))
    with np.errstate(over="raise"), raises(AtlasError, code):
        read_atlas(path)


@pytest.mark.parametrize(("number", "kind"), TYPES.items())
@pytest.mark.parametrize("order", "<>")
def test_libraries_of_all_types(tmp_path, number, kind, order):
    path = LAYOUTS["envi"].save(MACBETH, tmp_path)
    header = path.with_suffix(".hdr")
    text = header.read_text().replace("factor = 100000000", "factor = 100")
    for old, new in (
        ("data type = 3", f"Data Type = {number}"),
        ("byte order = 0", f"byte order = {'<>'.index(order)}"),
        ("offset = 0", "offset = 3"),
        ("{ paints }", "{\nDeckweiß,\n; x = 1\n grün}"),
    ):
        text = text.replace(old, new)
    header.unlink()
    path.with_suffix(".sli.hdr").write_bytes(
        text.replace("\n", "\r\n").encode("cp1252")
    )
    values = np.array([np.rint(100 * entry.values) for entry in MACBETH])
    path.write_bytes(b"abc" + values.astype(order + kind).tobytes())
    atlas = read_atlas(path)
    assert atlas.names == MACBETH.names
    assert_allclose([entry.values for entry in atlas], values / 100)


def test_a_library_without_its_other_file_raises(tmp_path):
    path = LAYOUTS["envi"].save(MACBETH, tmp_path)
    assert read_atlas(path.with_suffix(".hdr")).names == MACBETH.names
    path.with_suffix(".hdr").unlink()
    with raises(AtlasError, "file-not-found"):
        read_atlas(path)
