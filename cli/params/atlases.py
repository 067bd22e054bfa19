"""Atlases that are read one by one, each under the name of its file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.atlas import Atlas

SHIPPED = "atlases/*.txt"


def read_atlases(files: tuple[str, ...]) -> dict[str, Atlas]:
    """Return atlases by the stems of their file names; without files, those in ``atlases``. Raises `AtlasError`."""
    from uplift.atlas import read_atlas
    from uplift.common.errors import AtlasError

    paths = [Path(file) for file in files] or sorted(Path().glob(SHIPPED))
    if not paths:
        raise AtlasError(
            f"no file matches {SHIPPED}", code="no-atlases", hint="name atlases with --atlas FILE"
        )
    atlases: dict[str, Atlas] = {}
    for path in paths:
        if path.stem in atlases:
            raise AtlasError(
                f"another atlas has the name '{path.stem}' too",
                code="duplicate-atlas",
                path=path,
                hint="rename one of the files",
            )
        atlases[path.stem] = read_atlas(path)
    return atlases
