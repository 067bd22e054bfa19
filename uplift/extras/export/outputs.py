"""Files that an export writes."""

from pathlib import Path

from uplift.common.arrays import StrPath

SECOND_SUFFIXES = {
    "film": ".toml",
    "mixer-glsl": ".bin",
    "file": ".bin",
}
"""Suffixes of second files by format; of programs, by the form of their table."""


def output_files(path: StrPath, form: str) -> list[Path]:
    """Return all files of an export in a format, or of a program whose table has a
    form: ``path`` first.
    """
    path = Path(path)
    if form in SECOND_SUFFIXES:
        return [path, path.with_suffix(SECOND_SUFFIXES[form])]
    return [path]
