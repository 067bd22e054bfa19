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


ROW = "name,400,500,600,700\n"


@pytest.mark.parametrize(
    ("text", "code", "place"),
    [
        ("sample,wavelength,R\na,400,0.1\na,red,0.2\n", "atlas", (3, "a")),
        (
            ROW + "a,0.2,0.3,0.4,0.5\nb,40,45,50,50\nc,0.1,0.2,0.3,0.4\n",
            "mixed-scales",
            (3, "b"),
        ),
        (ROW + "a,20,30,40,50\nb,40,0.45,50,50\n", "mixed-scales", (3, "b")),
        (ROW + "a,0.2,0.3,0.4,50\n", "mixed-scales", (2, "a")),
    ],
)
def test_errors_name_the_row(read, text, code, place):
    with raises(AtlasError, code) as caught:
        read(text)
    assert (caught.value.line, caught.value.entry) == place


def test_scale_given_by_the_caller(save):
    dark = save(ROW + "trap,0.4,0.5,0.5,0.4\ngrey,20,20,20,20\n")
    found = read_atlas(dark, measured="percent")
    assert found["trap"].values.tolist() == [0.004, 0.005, 0.005, 0.004]
    assert found.sources[0].measured == "percent"
    for scale, error, code in (
        ("fraction", AtlasError, "atlas"),
        ("per mille", UnknownNameError, "unknown-name"),
    ):
        with raises(error, code):
            read_atlas(dark, measured=scale)


SPECTRUM = re.compile(r"<cc:ReflectanceSpectrum.*?</cc:ReflectanceSpectrum>", re.DOTALL)
CONDITION = re.compile('ColorSpecification="[^"]*"')


@pytest.fixture
def cxf(tmp_path):
    """Function that saves CxF of two colours, changed by a function of its text and the
    first spectrum.
    """

    def cxf(change):
        path = LAYOUTS["cxf3"].save(MACBETH[:2], tmp_path)
        text = path.read_text()
        path.write_text(change(text, SPECTRUM.search(text)[0]))
        return path

    return cxf


def test_conditions_of_cxf_are_kept_in_names(cxf):
    def three_times(text, one):
        spectra = [
            CONDITION.sub(f'ColorSpecification="{name}"', one)
            for name in ("M0", "M1", "U")
        ]
        spectra[1] = re.sub(r">[^<]*<", ">" + "0.75 " * 36 + "<", spectra[1])
        return text.replace(one, "".join(spectra))

    atlas = read_atlas(cxf(three_times))
    assert atlas.names == ("dark skin M0", "dark skin M1", "dark skin U", "light skin")
    (note,) = [note for note in atlas.sources[0].notes if "M0, M1" in note]
    least = min(atlas["dark skin M0"].values)
    assert f"differ by up to {0.75 - least:.2g}" in note


def test_two_objects_of_a_name_are_refused_with_the_place_of_the_first(cxf):
    path = cxf(lambda text, one: text.replace("light skin", "dark skin"))
    with raises(AtlasError, "atlas") as caught:
        read_atlas(path)
    assert caught.value.problem.endswith(str(path))


def test_transmittances_of_cxf_are_skipped(cxf):
    path = cxf(
        lambda text, one: text.replace(one, one.replace("Reflectance", "Transmittance"))
    )
    with warns("entry-skipped"):
        atlas = read_atlas(path)
    assert [skipped.name for skipped in atlas.skipped] == ["dark skin"]
    assert atlas.names == ("light skin",)


MODULES = {"colour-cxf": "colour_cxf", "python-calamine": "python_calamine"}
LIBRARIES = [form for form in known_formats() if form.extra]


@pytest.mark.parametrize("form", LIBRARIES, ids=lambda form: form.name)
def test_missing_packages_are_named(tmp_path, monkeypatch, form):
    module = MODULES.get(form.library, form.library)
    for name in [name for name in sys.modules if name.partition(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    vendor = next(each for each in VENDORS if each.format == form.name)
    with raises(AtlasError, "extra-not-installed") as caught:
        read_atlas(vendor.save(MACBETH[: vendor.count], tmp_path))
    assert "pip install" in caught.value.hint


ENTITY = '<?xml version="1.0"?>\n<!DOCTYPE x [<!ENTITY a "b">]>\n'
DEEP = "<a>" * 100 + "</a>" * 100
CXF = "http://colorexchangeformat.com/CxF3-core"
CGATS = "BEGIN_DATA_FORMAT\n{}\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2\nEND_DATA\n"


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (ENTITY + '<IESTM2714 xmlns="i">&a;</IESTM2714>', "atlas"),
        (f'<IESTM2714 xmlns="i">{DEEP}</IESTM2714>', "atlas"),
        ('<IESTM2714 xmlns="iestm2714"/>', "atlas"),
        (f'<cc:CxF xmlns:cc="{CXF}"/>', "not-an-atlas"),
        ("##TITLE=a\n##NPOINTS=1000000000\n", "atlas"),
        ("##TITLE=a\n##XUNITS=HZ\n##XYPOINTS=(XY..XY)\n1, 1\n", "atlas"),
        ("##TITLE=a\n##XYDATA=(X++(Y..Y))\n400 q\n", "atlas"),
        ("CGATS.17\nBEGIN_DATA_FORMAT\nEND_DATA_FORMAT\n", "atlas"),
        ("CGATS.17\n" + CGATS.format("ID LAB_L"), "atlas"),
        ('X\nSPECTRAL_NORM "0"\n' + CGATS.format("nm400 nm700"), "atlas"),
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
    ("old", "new", "code"),
    [
        ("lines = 6", "lines = 600000000", "atlas"),
        ("ENVI Spectral Library", "ENVI Standard", "not-an-atlas"),
        ("Micrometers", "Furlongs", "atlas"),
        ("factor = 100000000", "factor = -1", "atlas"),
        ("{0.38000", "{1e306", "atlas"),
        ("ENVI", "NVI", "not-an-atlas"),
        ("data type = 3", "data type = 6", "atlas"),
        ("offset = 0", "offset = 8", "atlas"),
        ("bands = 1", "bands = 2", "atlas"),
        ("dark skin, ", "", "atlas"),
    ],
)
def test_damaged_libraries_raise(tmp_path, old, new, code):
    path = LAYOUTS["envi"].save(MACBETH, tmp_path)
    header = path.with_suffix(".hdr")
    header.write_text(header.read_text().replace(old, new))
    with np.errstate(over="raise"), raises(AtlasError, code):
        read_atlas(path)


@pytest.mark.parametrize(("number", "kind"), TYPES.items())
@pytest.mark.parametrize("order", "<>")
def test_libraries_of_all_types(tmp_path, number, kind, order):
    path = LAYOUTS["envi"].save(MACBETH, tmp_path)
    header = path.with_suffix(".hdr")
    text = header.read_text()
    for old, new in (
        ("factor = 100000000", "factor = 100"),
        ("data type = 3", f"Data Type = {number}"),
        ("byte order = 0", f"byte order = {'<>'.index(order)}"),
        ("offset = 0", "offset = 3"),
        ("{ paints }", "{\nDeckweiß,\n; x = 1\n grün}"),
        ("\n", "\r\n"),
    ):
        text = text.replace(old, new)
    header.unlink()
    path.with_suffix(".sli.hdr").write_bytes(text.encode("cp1252"))
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
