"""The cubes that come with the package, by name."""

from __future__ import annotations

import os
from pathlib import Path

FOLDER = Path(__file__).parent
DEFAULT = FOLDER / "default.uplift"
"""The cube of linear sRGB."""
PACKAGED = {"srgb": DEFAULT, "acescg": FOLDER / "acescg.uplift"}
"""Cubes by the name of their space in lower case."""


def find_file(path: str | os.PathLike[str]) -> str | os.PathLike[str]:
    """Return the file that a path or a name stands for.

    Parameters
    ----------
    path : path-like
        A file, which takes precedence, or a name of `PACKAGED`, in any case.

    Returns
    -------
    path-like
        The file; it may be missing.
    """
    packaged = PACKAGED.get(os.fsdecode(path).casefold())
    return path if packaged is None or os.path.lexists(path) else packaged
