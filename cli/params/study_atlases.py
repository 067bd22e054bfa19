"""The atlases that a study is made on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.atlas import Atlas

SHIPPED = "atlases/*.txt"


def read_each(files: tuple[str, ...]) -> dict[str, Atlas]:
    """Atlases by the names of their files. Raises `AtlasError`."""
    from uplift.atlas import read_atlas
    from uplift.common.errors import AtlasError

    paths = [Path(file) for file in files] or sorted(Path().glob(SHIPPED))
    if not paths:
        raise AtlasError(f"there are no {SHIPPED} here", hint="name atlases with --atlas FILE")
    atlases: dict[str, Atlas] = {}
    for path in paths:
        if path.stem in atlases:
            raise AtlasError(
                f"a second atlas is called '{path.stem}'", path=path, hint="rename one of the two"
            )
        atlases[path.stem] = read_atlas(path)
    return atlases
