"""Reader of CGATS text (ANSI CGATS.17, ISO 28178): exports of X-Rite programs, and ``.ti3`` and ``.sp`` of ArgyllCMS.

Keywords precede ``BEGIN_DATA_FORMAT``, which lists the fields of a set. ``BEGIN_DATA`` follows with a set per line.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence

import numpy as np

from uplift.atlas.atlas import Header
from uplift.atlas.document import Document, SourceLocation, parse_number
from uplift.atlas.formats.grid import Cell, Row, find_table, read_grid, wavelength
from uplift.atlas.measurements import Measurements, check_quantity, refuse_quantity
from uplift.common.text import parse_float

FORMAT, DATA = "DATA_FORMAT", "DATA"
TOKEN = re.compile(r'"((?:[^"]|"")*)"|(\S+)')
DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+")
KEYWORD = re.compile(r'(\w+)\s+(?:"((?:[^"]|"")*)"|(.+))')
LIGHT_SOURCES = re.compile(r'^\s*DEVICE_CLASS\s+"?DISPLAY', re.MULTILINE)
"""Keyword of ArgyllCMS for measurements of a screen."""


def is_cgats(document: Document) -> bool:
    """Whether a line begins the format of the data."""
    return any(line.strip() == f"BEGIN_{FORMAT}" for line in document.lines)


def read(document: Document) -> Measurements:
    """Read the sets of a CGATS file. Fields other than the name and the spectrum are not used."""
    location = SourceLocation(document.path)
    preamble, rows = _parse(document)
    text = "\n".join(preamble)
    check_quantity(text, location)
    if LIGHT_SOURCES.search(text):
        refuse_quantity(
            "the file states measurements of a display, not reflectance",
            "measure the reflectance: a cube holds reflectances",
            location,
        )
    if not any(wavelength(cell.text) is not None for cell in rows[0]):
        raise location.at(rows[0][0].line).error(
            "the CGATS file has no spectral fields", "export the spectra with the colours"
        )
    keywords = {match[1]: match[2] or match[3] or "" for line in preamble if (match := KEYWORD.match(line))}
    found = read_grid(rows, document.path)
    return dataclasses.replace(
        _with_exact_wavelengths(found, keywords, rows, document.path),
        scale=_stated_scale(keywords, location),
        header=Header(content=_one_line(keywords.get("DESCRIPTOR", ""))),
    )


def _parse(document: Document) -> tuple[list[str], list[Row]]:
    """Return the lines of keywords, and the fields and sets as rows. Raise `AtlasError`."""
    preamble, fields, sets = list[str](), list[Cell](), list[Row]()
    section = ""
    for line, text in enumerate(document.lines, 1):
        word = text.strip()
        if word in (f"BEGIN_{FORMAT}", f"BEGIN_{DATA}"):
            if word == f"BEGIN_{FORMAT}" and fields:
                break  # another table follows
            section = word.removeprefix("BEGIN_")
        elif word in (f"END_{FORMAT}", f"END_{DATA}"):
            section = ""
        elif not word or word.startswith("#"):
            continue
        elif section == FORMAT:
            fields += [Cell(token, line) for token in _tokens(text, None)]
        elif section == DATA:
            sets.append(tuple(Cell(token, line) for token in _tokens(text, len(fields))))
        elif not sets:
            preamble.append(text)
    if not fields or not sets:
        location = SourceLocation(document.path, len(document.lines))
        raise location.error("a CGATS file must have fields and sets of data", "export the file again")
    return preamble, [tuple(fields), *sets]


def _tokens(text: str, count: int | None) -> list[str]:
    """Split a line at tabs if that gives ``count`` tokens, or else at blanks outside of quotes."""
    by_tabs = [token.strip().strip('"') for token in text.strip("\n").strip(" ").split("\t")]
    while by_tabs and not by_tabs[-1]:
        by_tabs.pop()
    by_blanks = [match[1].replace('""', '"') if match[2] is None else match[2] for match in TOKEN.finditer(text)]
    tokens = (
        by_tabs if "\t" in text and count in (None, len(by_tabs)) and _is_single_words(by_tabs, count) else by_blanks
    )
    return [token.replace(",", ".") if DECIMAL_COMMA.fullmatch(token) else token for token in tokens]


def _is_single_words(tokens: Sequence[str], count: int | None) -> bool:
    """Whether tokens between tabs can be labels of fields; those of a set can be any text."""
    return count is not None or not any(" " in token for token in tokens)


def _stated_scale(keywords: dict[str, str], location: SourceLocation) -> float | None:
    """Return the value of a perfect reflector, which ArgyllCMS states."""
    if "SPECTRAL_NORM" not in keywords:
        return None
    norm = parse_number(keywords["SPECTRAL_NORM"], location, "SPECTRAL_NORM")
    if not 0 < norm < float("inf"):
        raise location.error(
            f"SPECTRAL_NORM must be positive and finite, got {norm:g}", "write 100 for percent, 1 for values in [0, 1]"
        )
    return norm


def _with_exact_wavelengths(
    found: Measurements, keywords: dict[str, str], rows: Sequence[Row], path: str
) -> Measurements:
    """Replace wavelengths that ArgyllCMS rounds in labels, such as SPEC_383, by those of the keywords."""
    stated = [keywords.get(f"SPECTRAL_{name}", "") for name in ("START_NM", "END_NM", "BANDS")]
    try:
        start, end, bands = map(parse_float, stated)
    except ValueError:
        return found
    table = find_table(rows, path)
    if table.last - table.first != bands:
        return found
    exact = np.linspace(start, end, int(bands))
    labels = found.spectra[0].wavelengths
    if np.abs(exact - np.asarray(labels)).max() > 1:
        return found
    return dataclasses.replace(
        found, spectra=tuple(dataclasses.replace(each, wavelengths=exact) for each in found.spectra)
    )


def _one_line(text: str) -> str:
    return " ".join(text.split())
