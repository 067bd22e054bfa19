"""Header of Radiance HDR files, of which OpenImageIO does not read the primaries.

Reference: G. Ward, "Radiance File Formats",
https://radsite.lbl.gov/radiance/refer/filefmts.pdf.
"""

from pathlib import Path
from typing import Any

MAGIC = b"#?"
MAX_HEADER = 1 << 16
PRIMARIES = b"PRIMARIES="


def read_primaries(path: Path) -> dict[str, Any]:
    """Return ``PRIMARIES``, words that should be x, y of red, green, blue and white, if
    the file states them.
    """
    with path.open("rb") as file:
        header, _, _ = file.read(MAX_HEADER).partition(b"\n\n")
    stated = dict[str, Any]()
    for line in header.splitlines():
        if line.startswith(PRIMARIES):
            stated["PRIMARIES"] = tuple(line.removeprefix(PRIMARIES).split())
    return stated
