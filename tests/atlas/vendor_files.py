"""Shipped spectra in the layouts of instruments and programs, for the tests of the readers."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uplift.atlas import Atlas, Entry, on_grid

Files = dict[str, bytes]
NM = np.arange(380.0, 731.0, 10.0)
"""Wavelengths of most instruments."""


def sample(atlas: Atlas, count: int = 6, nm: np.ndarray = NM) -> Atlas:
    """Return the first entries at the wavelengths of an instrument, with eight decimals."""
    chosen = atlas[:count]
    values = np.round(on_grid(chosen, nm), 8)
    return Atlas(tuple(Entry(entry.name, nm, row) for entry, row in zip(chosen, values, strict=True)))


def _numbers(values: Sequence[float], separator: str, scale: float = 1.0, comma: bool = False) -> str:
    text = separator.join(f"{value * scale:.8f}" for value in values)
    return text.replace(".", ",") if comma else text


def _rows(atlas: Atlas, separator: str, label: str = "{:g}", scale: float = 1.0, comma: bool = False) -> str:
    lines = [separator.join(["Name", *(label.format(nm) for nm in atlas[0].wavelengths)])]
    lines += [f"{entry.name}{separator}" + _numbers(entry.values, separator, scale, comma) for entry in atlas]
    return "\n".join(lines) + "\n"


def _columns(atlas: Atlas, separator: str, corner: str = "Wavelength", scale: float = 1.0, comma: bool = False) -> str:
    lines = [separator.join([corner, *atlas.names])]
    for index, nm in enumerate(atlas[0].wavelengths):
        values = _numbers([entry.values[index] for entry in atlas], separator, scale, comma)
        lines.append(f"{nm:g}{separator}{values}")
    return "\n".join(lines) + "\n"


def plain_csv(atlas: Atlas) -> Files:
    return {"table.csv": _rows(atlas, ",").encode()}


def excel_csv(atlas: Atlas) -> Files:
    text = "sep=;\r\n" + _rows(atlas, ";", comma=True).replace("\n", "\r\n")
    return {"excel.csv": text.encode("utf-8-sig")}


def excel_unicode_text(atlas: Atlas) -> Files:
    return {"unicode.txt": _rows(atlas, "\t", scale=100).replace("\n", "\r\n").encode("utf-16")}


def utf_16_without_mark(atlas: Atlas) -> Files:
    return {"utf16.txt": _columns(atlas, "\t").encode("utf-16-be")}


def commented(atlas: Atlas) -> Files:
    head = "# Ocean spectrometer\n# 2026-01-31, reflectance of paints\n"
    return {"commented.csv": (head + _columns(atlas, ",", "# nm".lstrip("# "))).encode()}


def konica_minolta(atlas: Atlas) -> Files:
    """Rows below a preamble, with date, group, CIELAB, and reflectance with and without gloss."""
    head = "Instrument Name;CM-700d\nIlluminant;D65\nObserver;10 Degree\n\n"
    nm = atlas[0].wavelengths
    labels = ["Data Name", "Date", "Group", "L*(D65)", "a*(D65)", "b*(D65)"]
    lines = [";".join(["Name", *labels[1:], *(f"SCI {each:g}nm" for each in nm), *(f"SCE {each:g}nm" for each in nm)])]
    for entry in atlas:
        numbers = _numbers(entry.values, ";", 100, comma=True)
        gloss = _numbers(entry.values * 0.96, ";", 100, comma=True)
        lines.append(f"{entry.name};31.01.2026;Group 1;50,1;2,2;-3,3;{numbers};{gloss}")
    return {"cm700d.csv": (head + "\n".join(lines)).encode("latin-1")}


def datacolor(atlas: Atlas) -> Files:
    return {"datacolor.txt": _rows(atlas, "\t", "R{:g}", scale=100).encode()}


def babelcolor(atlas: Atlas) -> Files:
    """Descending wavelengths, and columns of an identity before and CIELAB behind them."""
    nm = atlas[0].wavelengths[::-1]
    lines = [",".join(["No.", "Name", *(f"{each:g} nm" for each in nm), "L*", "a*", "b*"])]
    lines += [f"{i},{e.name},{_numbers(e.values[::-1], ',')},50,1,-1" for i, e in enumerate(atlas, 1)]
    return {"babelcolor.csv": "\n".join(lines).encode()}


def lambda_spectrophotometer(atlas: Atlas) -> Files:
    """A column per spectrum, descending, with a preamble of key and value."""
    lines = _columns(atlas, ",", "nm", 100).splitlines()
    return {"lambda.csv": "\n".join(["Method,Scan", "Slit,2.00", "", lines[0], *lines[:0:-1]]).encode()}


def _cgats(atlas: Atlas, labels: Sequence[str], scale: float, keywords: str, separator: str = "\t") -> str:
    fields = ["SAMPLE_ID", "SAMPLE_NAME", "LAB_L", "LAB_A", "LAB_B", *labels]
    lines = [keywords.rstrip(), f"NUMBER_OF_FIELDS {len(fields)}", "BEGIN_DATA_FORMAT", separator.join(fields)]
    lines += ["END_DATA_FORMAT", f"NUMBER_OF_SETS {len(atlas)}", "BEGIN_DATA"]
    for number, entry in enumerate(atlas, 1):
        cells = [str(number), f'"{entry.name}"', "50.1", "2.5", "-3.5", _numbers(entry.values, separator, scale)]
        lines.append(separator.join(cells))
    return "\n".join([*lines, "END_DATA", ""])


def cgats(atlas: Atlas) -> Files:
    labels = [f"SPECTRAL_NM{each:g}" for each in atlas[0].wavelengths]
    keywords = 'CGATS.17\nORIGINATOR "a program"\nDESCRIPTOR "six paints"\n'
    return {"cgats.txt": _cgats(atlas, labels, 100, keywords).encode()}


def xrite(atlas: Atlas) -> Files:
    """Export of ProfileMaker: names without quotes, labels such as nm380."""
    labels = [f"nm{each:g}" for each in atlas[0].wavelengths]
    keywords = 'LGOROWLENGTH\t10\nCREATED\t"1/31/2026"  # Time: 16:45\nINSTRUMENTATION\t"Spectrolino"\n'
    text = _cgats(atlas, labels, 1, keywords).replace('"dark skin"', "dark skin").replace("SAMPLE_ID", "SampleID")
    return {"xrite.txt": text.replace("\n", "\r\n").encode("latin-1")}


def argyll_ti3(atlas: Atlas) -> Files:
    nm = atlas[0].wavelengths
    keywords = (
        'CTI3\n\nDESCRIPTOR "Argyll Calibration Target chart information 3"\nDEVICE_CLASS "OUTPUT"\n'
        f'COLOR_REP "RGB_XYZ"\nKEYWORD "SPECTRAL_BANDS"\nSPECTRAL_BANDS "{len(nm)}"\nKEYWORD "SPECTRAL_START_NM"\n'
        f'SPECTRAL_START_NM "{nm[0]:.6f}"\nSPECTRAL_END_NM "{nm[-1]:.6f}"\nSPECTRAL_NORM "100.000000"\n'
    )
    labels = [f"SPEC_{round(each)}" for each in nm]
    return {"chart.ti3": _cgats(atlas, labels, 100, keywords, " ").encode()}


def argyll_sp(atlas: Atlas) -> Files:
    nm = atlas[0].wavelengths
    head = f'SPECT\n\nMEAS_TYPE "REFLECTIVE"\nSPECTRAL_BANDS "{len(nm)}"\nSPECTRAL_START_NM "{nm[0]}"\n'
    head += f'SPECTRAL_END_NM "{nm[-1]}"\nSPECTRAL_NORM "100.0"\n\nNUMBER_OF_FIELDS {len(nm)}\nBEGIN_DATA_FORMAT\n'
    fields = " ".join(f"SPEC_{round(each)}" for each in nm)
    data = _numbers(atlas[0].values, " ", 100)
    return {"one.sp": f"{head}{fields}\nEND_DATA_FORMAT\n\nNUMBER_OF_SETS 1\nBEGIN_DATA\n{data}\nEND_DATA\n".encode()}


def cxf3(atlas: Atlas) -> Files:
    objects = "".join(
        f'<cc:Object ObjectType="Standard" Name="{entry.name}" Id="c{number}">'
        "<cc:CreationDate>2026-01-31T00:00:00</cc:CreationDate><cc:ColorValues>"
        f'<cc:ReflectanceSpectrum ColorSpecification="CS1">{_numbers(entry.values, " ")}</cc:ReflectanceSpectrum>'
        '<cc:ColorCIELab ColorSpecification="CS1"><cc:L>50</cc:L><cc:A>1</cc:A><cc:B>2</cc:B></cc:ColorCIELab>'
        "</cc:ColorValues></cc:Object>"
        for number, entry in enumerate(atlas)
    )
    nm = atlas[0].wavelengths
    text = (
        '<?xml version="1.0" encoding="UTF-8"?>\n<cc:CxF xmlns:cc="http://colorexchangeformat.com/CxF3-core">'
        "<cc:FileInformation><cc:Creator>X-Rite</cc:Creator><cc:Description>paints</cc:Description>"
        f"</cc:FileInformation><cc:Resources><cc:ObjectCollection>{objects}</cc:ObjectCollection>"
        '<cc:ColorSpecificationCollection><cc:ColorSpecification Id="CS1"><cc:MeasurementSpec>'
        "<cc:MeasurementType>Spectrum_Reflectance</cc:MeasurementType><cc:GeometryChoice><cc:SingleAngle>"
        "<cc:SingleAngleConfiguration>Annular</cc:SingleAngleConfiguration>"
        "<cc:IlluminationAngle>45.0</cc:IlluminationAngle><cc:MeasurementAngle>0.0</cc:MeasurementAngle>"
        f'</cc:SingleAngle></cc:GeometryChoice><cc:WavelengthRange StartWL="{nm[0]:.0f}" '
        f'Increment="{nm[1] - nm[0]:.0f}"/></cc:MeasurementSpec></cc:ColorSpecification>'
        "</cc:ColorSpecificationCollection></cc:Resources></cc:CxF>"
    )
    return {"paints.cxf": text.encode()}


def tm27(atlas: Atlas) -> Files:
    entry = atlas[0]
    data = "".join(
        f'<SpectralData wavelength="{nm:.1f}">{value:.8f}</SpectralData>'
        for nm, value in zip(entry.wavelengths, entry.values, strict=True)
    )
    text = (
        '<?xml version="1.0"?>\n<IESTM2714 xmlns="iestm2714" version="1.0"><Header><Manufacturer>m</Manufacturer>'
        f"<Description>{entry.name}</Description><DocumentCreator>c</DocumentCreator></Header><SpectralDistribution>"
        f"<SpectralQuantity>reflectance</SpectralQuantity>{data}</SpectralDistribution></IESTM2714>"
    )
    return {"one.spdx": text.encode()}


def spd(atlas: Atlas) -> Files:
    lines = (f"{nm:g} {value:.8f}" for nm, value in zip(atlas[0].wavelengths, atlas[0].values, strict=True))
    return {f"{atlas[0].name}.spd": ("# wavelength reflectance\n" + "\n".join(lines) + "\n").encode()}


def _jcamp(atlas: Atlas, units: str, data: str) -> bytes:
    head = f"##TITLE={atlas[0].name}\n##JCAMP-DX=4.24\n##DATA TYPE=UV-VIS SPECTRUM\n"
    return f"{head}{units}##NPOINTS={len(atlas[0].values)}\n{data}\n##END=\n".encode()


def jcamp_points(atlas: Atlas) -> Files:
    entry = atlas[0]
    pairs = "\n".join(f"{nm:g}, {100 * value:.8f}" for nm, value in zip(entry.wavelengths, entry.values, strict=True))
    units = "##XUNITS=NANOMETERS\n##YUNITS=% REFLECTANCE\n"
    return {"one.jdx": _jcamp(atlas, units, f"##XYPOINTS=(XY..XY)\n{pairs}")}


def jcamp_table(atlas: Atlas) -> Files:
    """Equal steps, descending, in micrometres, with factors."""
    um, values = 1e-3 * atlas[0].wavelengths[::-1], np.rint(1e8 * atlas[0].values[::-1]).astype(int)
    rows = (" ".join([f"{um[first]:.4f}", *map(str, values[first : first + 6])]) for first in range(0, len(um), 6))
    units = "##XUNITS=MICROMETERS\n##YUNITS=REFLECTANCE\n##XFACTOR=1.0\n##YFACTOR=0.00000001\n"
    units += f"##FIRSTX={um[0]}\n##LASTX={um[-1]}\n"
    return {"table.dx": _jcamp(atlas, units, "##XYDATA=(X++(Y..Y))\n" + "\n".join(rows))}


def _envi_header(atlas: Atlas, fields: str, unit: str, length: float) -> bytes:
    nm = atlas[0].wavelengths
    return (
        f"ENVI\nsamples = {len(nm)}\nlines = {len(atlas)}\nbands = 1\nheader offset = 0\n"
        f"file type = ENVI Spectral Library\ninterleave = bsq\n{fields}wavelength units = {unit}\n"
        f"spectra names = {{{', '.join(atlas.names)}}}\n"
        f"wavelength = {{{', '.join(f'{length * each:.5f}' for each in nm)}}}\n"
    ).encode()


def envi(atlas: Atlas) -> Files:
    """A spectral library in micrometres, with integers and a factor."""
    values = np.round(1e8 * np.array([entry.values for entry in atlas])).astype("<i4")
    fields = "description = { paints }\ndata type = 3\nbyte order = 0\nreflectance scale factor = 100000000\n"
    return {"library.sli": values.tobytes(), "library.hdr": _envi_header(atlas, fields, "Micrometers", 1e-3)}


def envi_floats(atlas: Atlas) -> Files:
    values = np.array([entry.values for entry in atlas]).astype(">f8")
    header = _envi_header(atlas, "data type = 5\nbyte order = 1\n", "Nanometers", 1.0)
    return {"floats.hdr": header, "floats.sli": values.tobytes()}


def _cells(atlas: Atlas) -> list[list[str | float]]:
    """A sheet with a preamble, an identity, CIELAB and the spectra."""
    rows: list[list[str | float]] = [["Measured with a spectrophotometer"], ["Mode", "M1"]]
    rows.append(["No", "Sample Name", "L*", "a*", "b*", *(f"{nm:g}nm" for nm in atlas[0].wavelengths)])
    rows += [[i, e.name, 50.0, 1.0, 2.0, *(100 * e.values).tolist()] for i, e in enumerate(atlas, 1)]
    return rows


def xlsx(atlas: Atlas) -> Files:
    rows = "".join(
        f'<row r="{line}">' + "".join(_xlsx_cell(value) for value in cells) + "</row>"
        for line, cells in enumerate(_cells(atlas), 1)
    )
    main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    parts = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types"><Default Extension="rels" '
        'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="xml" '
        'ContentType="application/xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook xmlns="{main}" xmlns:r="{office}"><sheets><sheet name="About" sheetId="1" '
        'r:id="r1"/><sheet name="Paints" sheetId="2" r:id="r2"/></sheets></workbook>',
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="r1" '
        f'Type="{office}/worksheet" Target="worksheets/sheet1.xml"/><Relationship Id="r2" Type="{office}/worksheet" '
        'Target="worksheets/sheet2.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f'<worksheet xmlns="{main}"><sheetData><row r="1">{_xlsx_cell("text")}</row>'
        f'<row r="2">{_xlsx_cell("more")}</row></sheetData></worksheet>',
        "xl/worksheets/sheet2.xml": f'<worksheet xmlns="{main}"><sheetData>{rows}</sheetData></worksheet>',
    }
    return {"paints.xlsx": _archive(parts)}


def _xlsx_cell(value: str | float) -> str:
    if isinstance(value, str):
        return f'<c t="inlineStr"><is><t>{value}</t></is></c>'
    return f"<c><v>{value!r}</v></c>"


def ods(atlas: Atlas) -> Files:
    kind = "application/vnd.oasis.opendocument.spreadsheet"
    name = "urn:oasis:names:tc:opendocument:xmlns"
    rows = "".join(
        "<table:table-row>" + "".join(_ods_cell(value) for value in cells) + "</table:table-row>"
        for cells in _cells(atlas)
    )
    content = (
        f'<office:document-content xmlns:office="{name}:office:1.0" xmlns:table="{name}:table:1.0" '
        f'xmlns:text="{name}:text:1.0"><office:body><office:spreadsheet><table:table table:name="Paints">{rows}'
        "</table:table></office:spreadsheet></office:body></office:document-content>"
    )
    manifest = (
        f'<manifest:manifest xmlns:manifest="{name}:manifest:1.0"><manifest:file-entry manifest:full-path="/" '
        f'manifest:media-type="{kind}"/></manifest:manifest>'
    )
    return {"paints.ods": _archive({"mimetype": kind, "META-INF/manifest.xml": manifest, "content.xml": content})}


def _ods_cell(value: str | float) -> str:
    if isinstance(value, str):
        return f'<table:table-cell office:value-type="string"><text:p>{value}</text:p></table:table-cell>'
    return f'<table:table-cell office:value-type="float" office:value="{value!r}"/>'


def _archive(parts: dict[str, str]) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return buffer.getvalue()


@dataclass(frozen=True)
class Vendor:
    """A layout: the format that must recognise it, its writer, and the number of spectra that it can hold."""

    format: str
    write: Callable[[Atlas], Files]
    count: int = 6
    percent: bool = False

    @property
    def name(self) -> str:
        """Name of the layout."""
        return self.write.__name__

    def save(self, atlas: Atlas, folder: Path) -> Path:
        """Write the files of an atlas and return the path to read."""
        files = self.write(atlas)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        return folder / next(iter(files))


TABLE, CGATS = "table", "CGATS"
VENDORS = (
    Vendor(TABLE, plain_csv),
    Vendor(TABLE, excel_csv),
    Vendor(TABLE, excel_unicode_text, percent=True),
    Vendor(TABLE, utf_16_without_mark),
    Vendor(TABLE, commented),
    Vendor(TABLE, konica_minolta, percent=True),
    Vendor(TABLE, datacolor, percent=True),
    Vendor(TABLE, babelcolor),
    Vendor(TABLE, lambda_spectrophotometer, percent=True),
    Vendor(TABLE, spd, count=1),
    Vendor(CGATS, cgats, percent=True),
    Vendor(CGATS, xrite),
    Vendor(CGATS, argyll_ti3),
    Vendor(CGATS, argyll_sp, count=1),
    Vendor("CxF3", cxf3),
    Vendor("IES TM-27-14", tm27, count=1),
    Vendor("JCAMP-DX", jcamp_points, count=1),
    Vendor("JCAMP-DX", jcamp_table, count=1),
    Vendor("ENVI spectral library", envi),
    Vendor("ENVI spectral library", envi_floats),
    Vendor("spreadsheet", xlsx, percent=True),
    Vendor("spreadsheet", ods, percent=True),
)
"""All layouts."""
