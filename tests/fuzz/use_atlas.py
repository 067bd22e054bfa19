"""Use of an atlas after reading: sample it as a build does, write it, and read it again."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from uplift.atlas import read_atlas, resample, write_atlas
from uplift.common.errors import UpliftError

GRID = np.arange(380.0, 781.0, 5.0)


def use_atlas(path: Path) -> None:
    """Use the atlas at ``path``. Raises `UpliftError` for invalid files, ValueError for invalid results."""
    atlas = read_atlas(path)
    values = resample(atlas, GRID).values
    if not ((values >= 0) & (values <= 1)).all():
        raise ValueError("reflectances outside [0, 1]")
    if not atlas.entries:
        return
    copy = path.with_suffix(".copy")
    try:
        write_atlas(atlas, copy)
        if read_atlas(copy).names != atlas.names:
            raise ValueError("the written atlas has other names")
    except UpliftError as error:
        raise ValueError("the written atlas cannot be read") from error
    finally:
        copy.unlink(missing_ok=True)
