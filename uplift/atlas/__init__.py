"""Measured reflectances: text formats → `Atlas`, and back."""

from __future__ import annotations

import os
import warnings

from uplift.atlas import art, art_write, table
from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source, merge
from uplift.atlas.distributions import from_distributions
from uplift.atlas.document import read_document
from uplift.atlas.resample import Clip, Resampled, on_grid, resample
from uplift.common.arrays import StrPath
from uplift.common.errors import OutputError, UpliftWarning
from uplift.common.files import write_text

__all__ = [
    "Atlas",
    "Clip",
    "Entry",
    "Header",
    "Resampled",
    "SkippedEntry",
    "Source",
    "from_distributions",
    "merge",
    "on_grid",
    "read_atlas",
    "resample",
    "write_atlas",
]


def read_atlas(*paths: StrPath) -> Atlas:
    """Read atlas files, text or CSV as their content shows, into one atlas.

    An `UpliftWarning` names every entry that was skipped, and every table that was read as percent.

    Raises
    ------
    AtlasError : with path, line, entry and hint.
    """
    spectra = merge(_read(path) for path in paths)
    for skipped in spectra.skipped:
        warnings.warn(str(skipped), UpliftWarning, stacklevel=2)
    return spectra


def write_atlas(spectra: Atlas, path: StrPath, header: Header | None = None) -> None:
    """Write an atlas at once, replacing ``path``: as CSV where it ends in ``.csv``, as text otherwise.

    ``header`` is by default what the sources said of themselves; a CSV has no room for it.

    Raises
    ------
    OutputError : nothing to write, a place that cannot be written, or a table of different samplings.
    """
    if not spectra.entries:
        raise OutputError("no entries to write", path=path, hint="name an atlas that holds reflectances")
    is_table = os.fspath(path).lower().endswith(".csv")
    text = table.text(spectra) if is_table else art_write.text(spectra, header or _joined(spectra))
    write_text(text, path, force=True)


def _read(path: StrPath) -> Atlas:
    document = read_document(path)
    return art.read(document) if art.claims(document) else table.read(document)


def _joined(spectra: Atlas) -> Header:
    """The headers of all sources, each statement once."""
    headers = [source.header for source in spectra.sources]

    def join(statements: list[str]) -> str:
        return "; ".join(dict.fromkeys(filter(None, statements)))

    return Header(
        join([header.content for header in headers]),
        join([header.copyright for header in headers]),
        join([header.licence for header in headers]),
    )
