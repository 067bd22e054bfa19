"""Shipped spectra in the layouts of instruments and programs, for the tests of the
readers.

Each file in layouts/ is the text of a layout as a template of Jinja, in archives the
texts of all parts.
"""

import io
import re
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import jinja2
import numpy as np

from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.resampling import on_grid

Files = dict[str, bytes]
NM = np.arange(380.0, 731.0, 10.0)
"""Wavelengths of most instruments."""
LAYOUTS = jinja2.Environment(
    loader=jinja2.FileSystemLoader(Path(__file__).parent / "layouts"),
    undefined=jinja2.StrictUndefined,
    trim_blocks=True,
    keep_trailing_newline=True,
)


def sample(atlas: Atlas, count: int = 6) -> Atlas:
    """Return the first entries at the wavelengths of an instrument, with eight
    decimals.
    """
    chosen = atlas[:count]
    values = np.round(on_grid(chosen, NM), 8)
    return Atlas(
        tuple(
            Entry(entry.name, NM, row)
            for entry, row in zip(chosen, values, strict=True)
        )
    )


def labels(pattern: str, separator: str, step: int = 1) -> str:
    """Return the labels of all wavelengths, in descending order if ``step`` is -1."""
    return separator.join(pattern.format(f"{nm:g}") for nm in NM[::step])


def row(
    values: Sequence[float], separator: str, scale: float = 1.0, comma: bool = False
) -> str:
    """Return numbers of eight decimals."""
    text = separator.join(f"{value * scale:.8f}" for value in values)
    return text.replace(".", ",") if comma else text


@dataclass(frozen=True)
class Vendor:
    """A layout: the format that must recognise it, its template, and the programs that
    write it.

    ``count`` spectra fit into it, ``percent`` is not stated, ``skipped`` columns are of
    other quantities. Samples of libraries of ENVI are numbers of a type, each eighth
    decimal a unit, in a file of their own behind ``offset`` bytes. Those of the USGS
    are next to a file of ``wavelengths``.
    """

    template: str
    program: str
    format: str = "table"
    count: int = 6
    percent: bool = False
    skipped: bool = False
    wavelengths: bool = False
    encoding: str = "utf-8"
    newline: str = "\n"
    samples: tuple[str, float] | None = None
    offset: int = 0

    @property
    def name(self) -> str:
        """Name of the layout."""
        return self.template.partition(".")[0]

    def write(self, atlas: Atlas) -> Files:
        """Return the contents of the files by name, first that of the file to read."""
        values = np.array([entry.values for entry in atlas])
        columns = [(f"{nm:g}", column) for nm, column in zip(NM, values.T, strict=True)]
        sheet = [["Measured with a spectrophotometer"], ["Mode", "M1"]]
        sheet.append(
            ["No", "Sample Name", "L*", "a*", "b*", *(f"{nm:g}nm" for nm in NM)]
        )
        sheet += [
            [i, each.name, 50.0, 1.0, 2.0, *(100 * each.values).tolist()]
            for i, each in enumerate(atlas, 1)
        ]
        template = LAYOUTS.get_template(self.template)
        text = template.render(
            atlas=atlas, columns=columns, sheet=sheet, labels=labels, row=row
        )
        content = text.replace("\n", self.newline).encode(self.encoding)
        if self.format == "spreadsheet":
            content = archive(text)
        files = {atlas[0].name + Path(self.template).suffix: content}
        if self.wavelengths:
            lines = [
                " Wavelengths 0.38-0.73 microns",
                *(f" {nm / 1000:.6E}" for nm in NM),
            ]
            files["Wavelengths.txt"] = "\n".join(lines).encode()
        if self.samples is None:
            return files
        kind, unit = self.samples
        numbers = np.round(np.rint(1e8 * values) * unit, 8).astype(kind)
        content = bytes(self.offset) + numbers.tobytes()
        return {f"{atlas[0].name}.sli": content, **files}

    def save(self, atlas: Atlas, folder: Path) -> Path:
        """Write the files of an atlas and return the path to read."""
        files = self.write(atlas)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        return folder / next(iter(files))


def archive(text: str) -> bytes:
    """Return an archive of parts, each below a line with its name; their lines become
    one, as programs write them.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as parts:
        for part in re.split(r"^=== ", text, flags=re.MULTILINE)[1:]:
            name, _, content = part.partition("\n")
            parts.writestr(name, content.replace("\n", ""))
    return buffer.getvalue()


CGATS = "CGATS"
ENVI = "ENVI spectral library"
SHEET = "spreadsheet"
VENDORS = (
    Vendor("plain_csv.csv", "programs with tables"),
    Vendor(
        "excel_csv.csv",
        "spreadsheets, European",
        encoding="utf-8-sig",
        newline="\r\n",
    ),
    Vendor("excel_percent.csv", "spreadsheets, cells in percent"),
    Vendor(
        "excel_unicode_text.txt",
        "Excel, Unicode text",
        percent=True,
        encoding="utf-16",
        newline="\r\n",
    ),
    Vendor("utf_16_without_mark.txt", "programs for Windows", encoding="utf-16-be"),
    Vendor("commented.csv", "scripts"),
    Vendor(
        "konica_minolta.csv",
        "Konica Minolta SpectraMagic",
        percent=True,
        encoding="latin-1",
    ),
    Vendor("datacolor.txt", "Datacolor", percent=True),
    Vendor("babelcolor.csv", "BabelColor"),
    Vendor("lambda_spectrophotometer.csv", "PerkinElmer Lambda", percent=True),
    Vendor("spd.spd", "Mitsuba", count=1),
    Vendor("ocean_optics.txt", "Ocean Optics OceanView", count=1, percent=True),
    Vendor("avantes.txt", "Avantes AvaSoft", count=1, skipped=True),
    Vendor(
        "spectral_evolution.sed",
        "Spectral Evolution DARWin",
        count=1,
        skipped=True,
    ),
    Vendor("ecostress.txt", "ECOSTRESS and ASTER libraries", count=1),
    Vendor("usgs_columns.txt", "USGS library 6", count=1, skipped=True),
    Vendor("usgs_values.txt", "USGS library 7", count=1, wavelengths=True),
    Vendor(
        "detectors.txt",
        "spectrometers with three detectors",
        count=1,
        skipped=True,
    ),
    Vendor("relab.asc", "RELAB library", count=1, skipped=True),
    Vendor(
        "spectra_vista.sig",
        "Spectra Vista",
        count=1,
        skipped=True,
        newline="\r\n",
    ),
    Vendor("asd.txt", "ASD ViewSpec", newline="\r\n"),
    Vendor("perkin_elmer.asc", "PerkinElmer UV WinLab", count=1),
    Vendor("cary.csv", "Agilent Cary WinUV"),
    Vendor("pairs_of_columns.csv", "plots in spreadsheets"),
    Vendor("pairs_on_a_line.csv", "scripts, a line per spectrum"),
    Vendor("long_table.csv", "programs for statistics"),
    Vendor("uvprobe.txt", "Shimadzu UVProbe", count=1),
    Vendor("cgats.txt", "programs with CGATS", CGATS, percent=True),
    Vendor(
        "xrite.txt", "X-Rite ProfileMaker", CGATS, encoding="latin-1", newline="\r\n"
    ),
    Vendor("cgats_spreadsheet.csv", "CGATS saved by spreadsheets", CGATS, percent=True),
    Vendor("argyll_ti3.ti3", "ArgyllCMS chartread", CGATS),
    Vendor("argyll_sp.sp", "ArgyllCMS spotread", CGATS, count=1),
    Vendor("cxf3.cxf", "X-Rite ColorCert, i1Profiler", "CxF3"),
    Vendor("tm27.spdx", "programs with TM-27", "IES TM-27-14", count=1),
    Vendor("jcamp_points.jdx", "programs with JCAMP-DX", "JCAMP-DX", count=1),
    Vendor("jcamp_table.dx", "infrared spectrometers", "JCAMP-DX", count=1),
    Vendor("jcamp_comma.jdx", "programs with decimal commas", "JCAMP-DX", count=1),
    Vendor("envi.hdr", "ENVI, integers", ENVI, samples=("<i4", 1.0)),
    Vendor("envi_floats.hdr", "ENVI, floats", ENVI, samples=(">f8", 1e-8)),
    Vendor(
        "envi_offset.hdr", "ENVI with a header", ENVI, samples=(">u4", 1.0), offset=128
    ),
    Vendor("xlsx.xlsx", "Excel", SHEET, percent=True),
    Vendor("ods.ods", "LibreOffice", SHEET, percent=True),
)
"""All layouts."""
