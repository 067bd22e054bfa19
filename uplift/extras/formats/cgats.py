"""Reader of CGATS text (ANSI CGATS.17, ISO 28178): exports of X-Rite programs, and
``.ti3`` and ``.sp`` of ArgyllCMS.

Keywords precede ``BEGIN_DATA_FORMAT``, which lists the fields of a set. ``BEGIN_DATA``
follows with a set per line.
"""

import itertools
import re
from dataclasses import replace

import numpy as np

from uplift.atlas.atlas import Header
from uplift.atlas.document import EXPORT, Document, check_scale, one_line, parse_number
from uplift.common.text import parse_float
from uplift.extras.files.csv import split_line
from uplift.extras.formats.measurements import Measurements, wrong_quantity
from uplift.extras.formats.quantities import remark_quantity
from uplift.extras.formats.statements import Scale
from uplift.extras.formats.tables.cells import Cell, Row, parse_label
from uplift.extras.formats.tables.grid import Grid
from uplift.extras.formats.tables.read import read_grid

FORMAT = "DATA_FORMAT"
DATA = "DATA"
SECTIONS = {
    f"BEGIN_{FORMAT}": FORMAT,
    f"END_{FORMAT}": "",
    f"BEGIN_{DATA}": DATA,
    f"END_{DATA}": "",
}
"""What begins with a line that is one of these words."""
TOKEN = re.compile(r'"((?:[^"]|"")*)"|(\S+)')
KEYWORD = re.compile(r'(\w+)\s+(?:"((?:[^"]|"")*)"|(.+))')


def read(document: Document) -> Measurements:
    """Read the sets of a CGATS file. Fields other than the name and the spectrum are
    not used.
    """
    location = document.location
    preamble, rows = _parse(document)
    if not any(parse_label(cell.text) for cell in rows[0]):
        if quantity := remark_quantity(preamble):
            raise wrong_quantity(quantity, location.at(rows[0][0].line))
        problem = "the CGATS file has no spectral fields"
        raise location.at(rows[0][0].line).error(
            problem, "export the spectra with the colours"
        )
    keywords = {
        match[1]: match[2] or match[3] or ""
        for line in preamble
        if (match := KEYWORD.match(line))
    }
    found = _with_exact_wavelengths(
        read_grid(Grid(rows, location, preamble), document.stem), keywords
    )
    if "SPECTRAL_NORM" in keywords:  # of ArgyllCMS: the value of a perfect reflector
        norm = parse_number(keywords["SPECTRAL_NORM"], location, "SPECTRAL_NORM")
        stated = f"SPECTRAL_NORM {keywords['SPECTRAL_NORM']}"
        found = replace(
            found, scales=(Scale(check_scale(norm, "SPECTRAL_NORM", location), stated),)
        )
    return replace(found, header=Header(one_line(keywords.get("DESCRIPTOR"))))


def _parse(document: Document) -> tuple[list[str], list[Row]]:
    """Return the lines of keywords, and the fields and sets as rows. Raise
    `AtlasError`.
    """
    preamble = list[str]()
    fields = list[Cell]()
    sets = list[Row]()
    section = ""
    for line, text in enumerate(_lines(document), 1):
        word = text.strip()
        if word == f"BEGIN_{FORMAT}" and fields:
            break  # another table follows
        if word in SECTIONS:
            section = SECTIONS[word]
        elif section == FORMAT:
            fields += _cells(text, line, None)
        elif section == DATA:
            sets += filter(None, [_cells(text, line, len(fields))])
        elif word and not word.startswith("#") and not sets:
            preamble.append(text)
    if not fields or not sets:
        raise document.location.at(len(document.lines)).error(
            "a CGATS file must have fields and sets of data", EXPORT
        )
    return preamble, [tuple(fields), *sets]


def _cells(text: str, line: int, count: int | None) -> Row:
    """Return the cells of a line, see `_tokens`; none of a comment."""
    if not text.strip() or text.strip().startswith("#"):
        return ()
    return tuple(Cell(token, line) for token in _tokens(text, count))


def _lines(document: Document) -> list[str]:
    """Return the lines; those that a spreadsheet saved with commas or semicolons have
    tabs in their place.
    """
    labels = next(
        (after for line, after in itertools.pairwise(document.lines) if FORMAT in line),
        "",
    )
    delimiter = next((mark for mark in ",;" if mark in labels), None)
    if delimiter is None or "\t" in labels:
        return document.lines
    try:
        return ["\t".join(split_line(line, delimiter)) for line in document.lines]
    except ValueError as error:
        raise document.location.error(
            f"not a readable table: {error}", EXPORT
        ) from None


def _tokens(text: str, count: int | None) -> list[str]:
    """Split a line at tabs if that gives ``count`` tokens, or else at blanks outside of
    quotes.
    """
    by_tabs = [
        token.strip().strip('"') for token in text.strip("\n").strip(" ").split("\t")
    ]
    while by_tabs and not by_tabs[-1]:
        by_tabs.pop()
    by_blanks = [
        match[1].replace('""', '"') if match[2] is None else match[2]
        for match in TOKEN.finditer(text)
    ]
    # tokens between tabs are labels of fields only if they are single words; those of a
    # set can be any text
    words = count == len(by_tabs) or (
        count is None and not any(" " in token for token in by_tabs)
    )
    return by_tabs if "\t" in text and words else by_blanks


def _with_exact_wavelengths(
    found: Measurements, keywords: dict[str, str]
) -> Measurements:
    """Replace wavelengths that ArgyllCMS rounds in labels, such as SPEC_383, by those
    of the keywords.
    """
    try:
        start, end, bands = (
            parse_float(keywords.get(f"SPECTRAL_{key}", ""))
            for key in ("START_NM", "END_NM", "BANDS")
        )
    except ValueError:
        return found
    # The labels must agree with the keywords, up to their rounding.
    labels = np.asarray(found.spectra[0].wavelengths)
    exact = np.linspace(start, end, len(labels))
    if len(labels) != bands or np.abs(exact - labels).max() > 1:
        return found
    return replace(
        found,
        spectra=tuple(
            replace(spectrum, wavelengths=exact) for spectrum in found.spectra
        ),
    )
