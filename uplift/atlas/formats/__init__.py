"""Registry of the formats of atlas files, in the order in which they are recognised."""

import re
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from uplift.atlas.atlas import Atlas
from uplift.atlas.document import Document
from uplift.atlas.measurements import Measurements

LIBRARY = ".sli"
"""Suffix of the numbers of an ENVI library, which have no mark: its header is another
file.
"""


@dataclass(frozen=True)
class Format:
    """A format of atlas files. Its reader is imported when a file has it.

    Parameters
    ----------
    name : str
        Name for listings.
    suffixes : tuple of str
        Usual suffixes. The content determines the format, but for ``.sli``.
    pattern : str or bytes
        Regular expression that is found in the text, or the bytes, of a file of the
        format.
    module : str
        Module of ``uplift.atlas.formats`` that reads it.
    library : str
        Distribution that parses the format; empty for uplift itself.
    extra : str
        Extra that installs the distribution; empty if it is required.
    written : bool
        Whether `write_atlas` writes the format.
    """

    name: str
    suffixes: tuple[str, ...]
    pattern: str | bytes
    module: str
    library: str = ""
    extra: str = ""
    written: bool = False


XML = r"\A\s*<(?s:.{0,4000}?<)?(?:[\w.-]+:)?"
"""Text before the name of an element near the beginning of an XML file."""
FORMATS = (
    Format(
        "spreadsheet", (".xlsx", ".xls", ".ods"), rb"\A(PK\x03\x04|\xd0\xcf\x11\xe0)", "spreadsheet",
        "python-calamine", "io",
    ),
    Format("ENVI spectral library", (LIBRARY, ".hdr"), rb"\A\s*ENVI", "envi", "spectral", "io"),
    Format("CxF3", (".cxf",), XML + r"CxF\s[^>]{0,4000}colorexchangeformat\.com/CxF3-core", "cxf", "colour-cxf", "io"),
    Format("IES TM-27-14", (".spdx",), XML + r"IESTM2714[\s/>]", "tm27", "colour-science"),
    Format("JCAMP-DX", (".dx", ".jdx"), r"(?i)\A(\s*\$\$.*\n)*\s*##\s*TITLE\s*=", "jcamp_dx", "jcamp", "io"),
    Format("CGATS", (".txt", ".ti3", ".sp"), r"(?m)^[^\S\n]*\"?BEGIN_DATA_FORMAT[\"\t ,;]*$", "cgats"),
    Format(
        "ART measurement archive", (".txt", ".ark"),
        r"(?im)\A\s*ART\s+measurement\s+archive|^[^\S\n]*Entry\s+ID\s*:", "art", written=True,
    ),
    Format("table", (".csv", ".txt", ".spd"), "", "table", written=True),
)  # fmt: skip
"""Formats; the last one takes all other files."""


def read_any(document: Document) -> tuple[Format, Measurements | Atlas]:
    """Read a document by the first format whose pattern it has, and return both. Raise
    `AtlasError`.
    """
    for each in FORMATS:
        content: Any = (
            document.data if isinstance(each.pattern, bytes) else document.text
        )
        is_library = LIBRARY in each.suffixes and document.path.lower().endswith(
            LIBRARY
        )
        if is_library or re.search(each.pattern, content):
            break  # the last one has every document
    return each, import_module(f"{__name__}.{each.module}").read(document)
