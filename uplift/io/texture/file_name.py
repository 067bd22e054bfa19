"""Names of files for OpenImageIO, which opens only those that are UTF-8."""

from __future__ import annotations

import os
from pathlib import Path

from uplift.common.errors import UpliftError


def utf8_name(path: Path, error: type[UpliftError]) -> str:
    """Return the name of a file as text. Raises ``error`` for bytes that are not UTF-8."""
    name = os.fspath(path)
    try:
        name.encode()
    except UnicodeEncodeError as cause:
        raise error("the file name is not UTF-8", code="name-not-utf8", path=path, hint="rename the file") from cause
    return name
