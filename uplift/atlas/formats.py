"""Registry of the formats of atlas files, in the order in which they are recognised."""

import functools
import itertools
import re
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Protocol

from uplift.atlas.atlas import Atlas
from uplift.atlas.document import Document
from uplift.common.extensions import installed, registered

KIND = "formats"
"""Kind of the extensions that are sequences of `Format`."""


class Content(Protocol):
    """Spectra of a file as the reader of its format returns them, not validated."""

    def to_atlas(
        self, document: Document, format_name: str, measured: str, missing: str
    ) -> Atlas:
        """Make entries of the reflectances of a document."""


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
        Module whose function ``read`` takes a `Document` and returns an `Atlas` or
        `uplift.extras.formats.measurements.Measurements`. If the format is written, its
        function ``text`` takes an `Atlas` and a `Header`.
    library : str
        Distribution that parses the format; empty for uplift itself.
    extra : str
        Extra that installs the distribution; empty if it is required.
    written : bool
        Whether `write_atlas` writes the format, to files of the first suffix.
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
    module="uplift.atlas.art",
    written=True,
)


def known_formats() -> tuple[Format, ...]:
    """Return the formats of this package.

    Returns
    -------
    tuple of Format
        In the order in which they are recognised. One without a pattern takes all
        files, and comes last.
    """
    formats = (*itertools.chain.from_iterable(registered(KIND)), ART)
    return tuple(sorted(formats, key=lambda form: form.pattern == ""))


def read_any(document: Document) -> tuple[Format, Atlas | Content]:
    """Read a document by the first format that it has, and return both. Raise
    `AtlasError`.
    """
    form = recognise(document)
    return form, import_module(form.module).read(document)


def recognise(document: Document) -> Format:
    """Return the first format that a document has. Raise `AtlasError` for none."""
    is_marked = functools.partial(_has_mark, document)
    formats = known_formats()
    marked = next(filter(is_marked, formats), None)
    if marked is not None:
        return marked
    unmarked = [form for form in formats if form.pattern == ""]
    if not any(document.path.lower().endswith(form.suffixes) for form in unmarked):
        # A search of all installed distributions, which the usual tables do without
        outside = itertools.chain.from_iterable(
            load() for load in installed(KIND).values()
        )
        unmarked = [*filter(is_marked, outside), *unmarked]
    if not unmarked:
        problem = "no format of an atlas is recognised"
        hint = "name a measurement archive, or install all of uplift"
        raise document.location.error(problem, hint, code="not-an-atlas")
    return unmarked[0]


def _has_mark(document: Document, form: Format) -> bool:
    """Whether the suffix or the content of a document marks it as of a format."""
    if form.unmarked and document.path.lower().endswith(form.unmarked):
        return True
    is_binary = isinstance(form.pattern, bytes)
    content: Any = document.data if is_binary else document.text
    return form.pattern != "" and re.search(form.pattern, content) is not None
