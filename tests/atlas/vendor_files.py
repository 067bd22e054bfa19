"""Shipped spectra in the layouts of instruments and programs, for the tests of the readers.

Each file in layouts/ is the text of a layout as a template of Jinja, in archives the texts of all parts.
"""

import io
import re
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import jinja2
import numpy as np

from uplift.atlas import Atlas, Entry, on_grid

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
    """Return the first entries at the wavelengths of an instrument, with eight decimals."""
    chosen = atlas[:count]
    values = np.round(on_grid(chosen, NM), 8)
    return Atlas(tuple(Entry(entry.name, NM, row) for entry, row in zip(chosen, values, strict=True)))


def labels(pattern: str, separator: str, step: int = 1) -> str:
    """Return the labels of all wavelengths, in descending order if ``step`` is -1."""
    return separator.join(pattern.format(f"{nm:g}") for nm in NM[::step])


def row(values: Sequence[float], separator: str, scale: float = 1.0, comma: bool = False) -> str:
    """Return numbers of eight decimals."""
    text = separator.join(f"{value * scale:.8f}" for value in values)
    return text.replace(".", ",") if comma else text


@dataclass(frozen=True)
class Vendor:
    """A layout: the format that must recognise it, its template, and the number of spectra that it can hold.

    Samples of libraries of ENVI are numbers of a type, each eighth decimal a unit, in a file of their own.
    """

    format: str
    template: str
    count: int = 6
    percent: bool = False
    encoding: str = "utf-8"
    newline: str = "\n"
    samples: tuple[str, float] | None = None

    @property
    def name(self) -> str:
        """Name of the layout."""
        return self.template.partition(".")[0]

    def write(self, atlas: Atlas) -> Files:
        """Return the contents of the files by name, first that of the file to read."""
        values = np.array([entry.values for entry in atlas])
        columns = [(f"{nm:g}", column) for nm, column in zip(NM, values.T, strict=True)]
        sheet = [["Measured with a spectrophotometer"], ["Mode", "M1"]]
        sheet.append(["No", "Sample Name", "L*", "a*", "b*", *(f"{nm:g}nm" for nm in NM)])
        sheet += [[i, each.name, 50.0, 1.0, 2.0, *(100 * each.values).tolist()] for i, each in enumerate(atlas, 1)]
        template = LAYOUTS.get_template(self.template)
        text = template.render(atlas=atlas, columns=columns, sheet=sheet, labels=labels, row=row)
        content = text.replace("\n", self.newline).encode(self.encoding)
        if self.format == "spreadsheet":
            content = archive(text)
        files = {atlas[0].name + Path(self.template).suffix: content}
        if self.samples is None:
            return files
        kind, unit = self.samples
        return {f"{atlas[0].name}.sli": np.round(np.rint(1e8 * values) * unit, 8).astype(kind).tobytes(), **files}

    def save(self, atlas: Atlas, folder: Path) -> Path:
        """Write the files of an atlas and return the path to read."""
        files = self.write(atlas)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        return folder / next(iter(files))


def archive(text: str) -> bytes:
    """Return an archive of parts, each below a line with its name; their lines become one, as programs write them."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as parts:
        for part in re.split(r"^=== ", text, flags=re.MULTILINE)[1:]:
            name, _, content = part.partition("\n")
            parts.writestr(name, content.replace("\n", ""))
    return buffer.getvalue()


TABLE, CGATS, ENVI, SHEET = "table", "CGATS", "ENVI spectral library", "spreadsheet"
VENDORS = (
    Vendor(TABLE, "plain_csv.csv"),
    Vendor(TABLE, "excel_csv.csv", encoding="utf-8-sig", newline="\r\n"),
    Vendor(TABLE, "excel_unicode_text.txt", percent=True, encoding="utf-16", newline="\r\n"),
    Vendor(TABLE, "utf_16_without_mark.txt", encoding="utf-16-be"),
    Vendor(TABLE, "commented.csv"),
    Vendor(TABLE, "konica_minolta.csv", percent=True, encoding="latin-1"),
    Vendor(TABLE, "datacolor.txt", percent=True),
    Vendor(TABLE, "babelcolor.csv"),
    Vendor(TABLE, "lambda_spectrophotometer.csv", percent=True),
    Vendor(TABLE, "spd.spd", count=1),
    Vendor(CGATS, "cgats.txt", percent=True),
    Vendor(CGATS, "xrite.txt", encoding="latin-1", newline="\r\n"),
    Vendor(CGATS, "argyll_ti3.ti3"),
    Vendor(CGATS, "argyll_sp.sp", count=1),
    Vendor("CxF3", "cxf3.cxf"),
    Vendor("IES TM-27-14", "tm27.spdx", count=1),
    Vendor("JCAMP-DX", "jcamp_points.jdx", count=1),
    Vendor("JCAMP-DX", "jcamp_table.dx", count=1),
    Vendor(ENVI, "envi.hdr", samples=("<i4", 1.0)),
    Vendor(ENVI, "envi_floats.hdr", samples=(">f8", 1e-8)),
    Vendor(SHEET, "xlsx.xlsx", percent=True),
    Vendor(SHEET, "ods.ods", percent=True),
)
"""All layouts."""
