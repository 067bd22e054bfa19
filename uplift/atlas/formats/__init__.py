"""Registry of the formats of atlas files, in the order in which they are recognised."""

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from uplift.atlas.atlas import Atlas
from uplift.atlas.document import Document
from uplift.atlas.measurements import Measurements
from uplift.common.extensions import installed, registered

KIND = "formats"
"""Kind of the extensions that are sequences of `Format`."""


@dataclass(frozen=True)
class Format:
    """A format of atlas files. Its reader is imported when a file has it.

    Parameters
    ----------
    name : str
        Name for listings.
    suffixes : tuple of str
        Usual suffixes. The content determines the format.
    pattern : str or bytes
        Regular expression that is found in the text, or the bytes, of a file of the
        format.
    module : str
        Module whose function ``read`` takes a `Document` and returns `Measurements`.
    library : str
        Distribution that parses the format; empty for uplift itself.
    extra : str
        Extra that installs the distribution; empty if it is required.
    written : bool
        Whether `write_atlas` writes the format.
    unmarked : str
        Suffix of files that have no mark, which determines the format; empty if there
        are none.
    """

    name: str
    suffixes: tuple[str, ...]
    pattern: str | bytes
    module: str
    library: str = ""
    extra: str = ""
    written: bool = False
    unmarked: str = ""


ART = Format(
    name="ART measurement archive",
    suffixes=(".txt", ".ark"),
    pattern=r"(?im)\A\s*ART\s+measurement\s+archive|^[^\S\n]*Entry\s+ID\s*:",
    module="uplift.atlas.formats.art",
    written=True,
)
TABLE = Format(
    name="table",
    suffixes=(".csv", ".txt", ".spd"),
    pattern="",
    module="uplift.atlas.formats.table",
    written=True,
)


def known_formats() -> tuple[Format, ...]:
    """Return the formats of this package.

    Returns
    -------
    tuple of Format
        In the order in which they are recognised. The last one takes all other files.
    """
    outside = itertools.chain.from_iterable(registered(KIND))
    return (*outside, ART, TABLE)


def read_any(document: Document) -> tuple[Format, Measurements | Atlas]:
    """Read a document by the first format that it has, and return both. Raise
    `AtlasError`.
    """
    *marked, table = known_formats()
    form = _recognise(document, marked)
    if form is None and not document.path.lower().endswith(table.suffixes):
        # A search of all installed distributions, which the usual tables do without
        forms = itertools.chain.from_iterable(installed(KIND))
        form = _recognise(document, list(forms))
    form = form or table
    return form, import_module(form.module).read(document)


def _recognise(document: Document, forms: Sequence[Format]) -> Format | None:
    """Return the first format that a document has."""
    for form in forms:
        if form.unmarked and document.path.lower().endswith(form.unmarked):
            return form
        is_binary = isinstance(form.pattern, bytes)
        content: Any = document.data if is_binary else document.text
        if re.search(form.pattern, content):
            return form
    return None
