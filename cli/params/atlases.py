"""Atlases that are read one by one, each under the name of its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.atlas import Atlas

LOCAL = "atlases/*.txt"
DEFAULT_ATLASES = f"{LOCAL} if there are any, or else the shipped atlases"
"""Default of ``--atlas``, as the help states it."""


def read_atlases(files: tuple[str, ...]) -> dict[str, Atlas]:
    """Return atlases by the stems of their file names; without files, the default ones. Raises `AtlasError`."""
    from uplift.atlas import read_atlas
    from uplift.common.errors import AtlasError

    atlases: dict[str, Atlas] = {}
    for file in files or _default_files():
        name = Path(file).stem
        if name in atlases:
            raise AtlasError(
                f"another atlas has the name '{name}' too",
                code="duplicate-atlas",
                path=file,
                hint="rename one of the files",
            )
        atlases[name] = read_atlas(file)
    return atlases


def _default_files() -> list[Path]:
    from uplift.atlas import shipped_atlases

    return sorted(Path().glob(LOCAL)) or [shipped.path for shipped in shipped_atlases()]
