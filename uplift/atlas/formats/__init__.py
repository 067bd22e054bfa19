"""Registry of the formats of atlas files, in the order in which they are recognised."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from uplift.atlas.atlas import Atlas
from uplift.atlas.document import Document
from uplift.atlas.formats import art, cgats, cxf, envi, jcamp_dx, spreadsheet, table, tm27
from uplift.atlas.measurements import Measurements, to_atlas


@dataclass(frozen=True)
class Format:
    """A format of atlas files.

    Parameters
    ----------
    name : str
        Name for listings.
    suffixes : tuple of str
        Usual suffixes. The content determines the format, but for ``.sli``.
    recognise : callable
        Whether a document has the format.
    read : callable
        Reader of a document that has it.
    library : str
        Distribution that parses the format; empty for uplift itself.
    extra : str
        Extra that installs the distribution; empty if it is required.
    written : bool
        Whether `write_atlas` writes the format.
    """

    name: str
    suffixes: tuple[str, ...]
    recognise: Callable[[Document], bool]
    read: Callable[[Document], Measurements | Atlas]
    library: str = ""
    extra: str = ""
    written: bool = False


FORMATS = (
    Format(
        "spreadsheet", (".xlsx", ".xls", ".ods"), spreadsheet.is_spreadsheet, spreadsheet.read, "python-calamine", "io"
    ),
    Format("ENVI spectral library", (".sli", ".hdr"), envi.is_envi, envi.read, "spectral", "io"),
    Format("CxF3", (".cxf",), cxf.is_cxf, cxf.read, "colour-cxf", "io"),
    Format("IES TM-27-14", (".spdx",), tm27.is_tm27, tm27.read, "colour-science"),
    Format("JCAMP-DX", (".dx", ".jdx"), jcamp_dx.is_jcamp, jcamp_dx.read, "jcamp", "io"),
    Format("CGATS", (".txt", ".ti3", ".sp"), cgats.is_cgats, cgats.read),
    Format("ART measurement archive", (".txt", ".ark"), art.is_art_archive, art.read, written=True),
    Format("table", (".csv", ".txt", ".spd"), lambda _: True, table.read, written=True),
)
"""Formats; the last one takes all other files."""


def read_any(document: Document, measured: str = "auto") -> Atlas:
    """Read a document by the first format that recognises it. Raise `AtlasError`."""
    chosen = recognise(document)
    found = chosen.read(document)
    return found if isinstance(found, Atlas) else to_atlas(document, found, chosen.name, measured)


def recognise(document: Document) -> Format:
    """Return the first format that recognises a document."""
    return next(each for each in FORMATS if each.recognise(document))
