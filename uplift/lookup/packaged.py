"""Files that come with the package: cubes of reflectances, and an emission table. Each has a name."""

from __future__ import annotations

import os
from pathlib import Path

from uplift.cube import is_emission_table

FOLDER = Path(__file__).parent
DEFAULT = FOLDER / "default.uplift"
"""The cube of linear sRGB."""
EMISSION = FOLDER / "emission.uplift"
"""The emission table of linear sRGB."""
PACKAGED = {"srgb": DEFAULT, "acescg": FOLDER / "acescg.uplift", "emission": EMISSION}
"""Files by name: cubes have that of their space in lower case."""


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


def names_emission_table(path: str | os.PathLike[str]) -> bool:
    """Whether a path or a name stands for an emission table.

    Parameters
    ----------
    path : path-like
        As of `find_file`.

    Returns
    -------
    bool
        False for other files, and for those that cannot be read.
    """
    return is_emission_table(find_file(path))
