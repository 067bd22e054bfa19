"""Registry of the formats of atlas files, in the order in which they are recognised."""

import re
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

    def has(self, document: Document) -> bool:
        """Return whether a document is of this format."""
        if self.unmarked and document.path.lower().endswith(self.unmarked):
            return True
        content: Any = (
            document.data if isinstance(self.pattern, bytes) else document.text
        )
        return re.search(self.pattern, content) is not None


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
    """Return the formats of this package; the last one takes all other files."""
    outside = [form for forms in registered(KIND) for form in forms]
    return (*outside, ART, TABLE)


def read_any(document: Document) -> tuple[Format, Measurements | Atlas]:
    """Read a document by the first format that it has, and return both. Raise
    `AtlasError`.
    """
    *marked, table = known_formats()
    chosen = next((form for form in marked if form.has(document)), None)
    if chosen is None:
        installed_forms = [form for forms in installed(KIND) for form in forms]
        chosen = next((form for form in installed_forms if form.has(document)), table)
    return chosen, import_module(chosen.module).read(document)
