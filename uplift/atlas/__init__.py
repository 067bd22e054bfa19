"""Atlases of measured reflectances: readers and writers of text formats, and resampling."""

from __future__ import annotations

import os
import warnings

from uplift.atlas.atlas import Atlas, Entry, Header, SkippedEntry, Source, merge
from uplift.atlas.distributions import from_distributions
from uplift.atlas.document import read_document
from uplift.atlas.formats import FORMATS, Format, art_write, read_any, table
from uplift.atlas.measurements import MEASURED, Measured, check_measured
from uplift.atlas.resample import Clip, Resampled, on_grid, resample
from uplift.atlas.shipped import ShippedAtlas, find_atlas_file, shipped_atlases
from uplift.common.arrays import StrPath
from uplift.common.errors import OutputError
from uplift.common.files import write_text

__all__ = [
    "FORMATS",
    "MEASURED",
    "Atlas",
    "Clip",
    "Entry",
    "Format",
    "Header",
    "Measured",
    "Resampled",
    "ShippedAtlas",
    "SkippedEntry",
    "Source",
    "from_distributions",
    "merge",
    "on_grid",
    "read_atlas",
    "resample",
    "shipped_atlases",
    "write_atlas",
]


def read_atlas(*paths: StrPath, measured: Measured = "auto") -> Atlas:
    """Read atlas files into one atlas. The content of a file determines its format, one of `FORMATS`.

    Parameters
    ----------
    *paths : path-like
        Files, in the order of their entries. Where a file does not exist, a shipped atlas of that name is read, with or
        without the suffix ``.txt``; see `shipped_atlases`.
    measured : {"auto", "percent", "fraction"}
        Scale of the values. ``"auto"`` takes the scale that a file states, or else decides by its values. Measurement
        archives always state their scale.

    Returns
    -------
    Atlas

    Raises
    ------
    AtlasError
        A file cannot be read, or two entries share a name. The error has path, line, entry and hint.
    OptionError
        The scale is unknown.

    Warns
    -----
    UpliftWarning
        An entry was skipped (``entry-skipped``), a table was read as percent (``values-in-percent``), or a shipped
        atlas replaces a missing file (``shipped-atlas``); the name ``macbeth`` without a suffix gives no warning.

    Examples
    --------
    >>> import uplift
    >>> macbeth = uplift.read_atlas("macbeth")
    >>> macbeth["orange"]
    Entry('orange', 81 samples, 380–780 nm)
    """
    check_measured(measured)
    found = list(map(find_atlas_file, paths))
    atlas = merge(read_any(read_document(path), measured) for path in found)
    for skipped in atlas.skipped:
        warnings.warn(skipped.warning(), stacklevel=2)
    return atlas


def write_atlas(atlas: Atlas, path: StrPath, header: Header | None = None, *, force: bool = True) -> None:
    """Write an atlas atomically.

    Parameters
    ----------
    atlas : Atlas
        The entries to write.
    path : path-like
        The file. With the suffix ``.csv`` it is a table, otherwise atlas text.
    header : Header, optional
        Statements about the archive, by default those of the sources. A table has no header.
    force : bool, default True
        Replace an existing file.

    Raises
    ------
    OutputError
        The atlas is empty, the path cannot be written, the file exists and ``force`` is false, or the entries of a
        table differ in sampling.
    """
    if not atlas.entries:
        raise OutputError(
            "an atlas to write must have entries, got none", path=path, hint="give an atlas that contains reflectances"
        )
    is_table = os.fspath(path).lower().endswith(".csv")
    text = table.text(atlas) if is_table else art_write.text(atlas, header or _merge_headers(atlas))
    write_text(text, path, force=force)


def _merge_headers(atlas: Atlas) -> Header:
    """Join the headers of all sources, each statement once."""
    headers = [source.header for source in atlas.sources]

    def join(statements: list[str]) -> str:
        return "; ".join(dict.fromkeys(filter(None, statements)))

    return Header(*(join([getattr(header, key) for header in headers]) for key in ("content", "copyright", "licence")))
