"""Formats of atlas files: tables, spreadsheets, files of instruments and spectral
libraries. Each one is a file, and a row of `FORMATS`.

Not here: the measurement archives of ART, atlases as such (`uplift.atlas`), and the
tables of recipes of paints (`uplift.extras.paint`).
"""

from uplift.atlas.formats import Format

XML = r"\A\s*<(?s:.{0,4000}?<)?(?:[\w.-]+:)?"
"""Text before the name of an element near the beginning of an XML file."""

FORMATS = (
    Format(
        name="spreadsheet",
        suffixes=(".xlsx", ".xls", ".ods"),
        pattern=rb"(?s)\A(PK\x03\x04.*?(xl/|content\.xml)|\xd0\xcf\x11\xe0)",
        module="uplift.extras.formats.spreadsheet",
        library="python-calamine",
        extra="io",
    ),
    Format(
        name="ENVI spectral library",
        suffixes=(".sli", ".hdr"),
        pattern=rb"\A(?:\xef\xbb\xbf)?\s*ENVI\s*[\r\n]",
        module="uplift.extras.formats.envi",
        unmarked=".sli",  # numbers, whose header is another file
    ),
    Format(
        name="CxF3",
        suffixes=(".cxf",),
        pattern=XML + r"CxF\s[^>]{0,4000}colorexchangeformat\.com/CxF3-core",
        module="uplift.extras.formats.cxf",
        library="colour-cxf",
        extra="io",
    ),
    Format(
        name="IES TM-27-14",
        suffixes=(".spdx",),
        pattern=XML + r"IESTM2714[\s/>]",
        module="uplift.extras.formats.tm27",
        library="colour-science",
    ),
    Format(
        name="JCAMP-DX",
        suffixes=(".dx", ".jdx"),
        pattern=r"(?i)\A(\s*\$\$.*\n)*\s*##\s*TITLE\s*=",
        module="uplift.extras.formats.jcamp_dx",
        library="jcamp",
        extra="io",
    ),
    Format(
        name="CGATS",
        suffixes=(".txt", ".ti3", ".sp"),
        pattern=r"(?m)^[^\S\n]*\"?BEGIN_DATA_FORMAT[\"\t ,;]*$",
        module="uplift.extras.formats.cgats",
    ),
    Format(
        name="table",
        suffixes=(".csv", ".txt", ".spd"),
        pattern="",
        module="uplift.extras.formats.delimited",
        written=True,
    ),
)
"""The formats, in the order in which they are recognised."""
