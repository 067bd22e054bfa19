"""Everything that a cube file holds, as numpy arrays by name."""

from __future__ import annotations

import json
import os

import numpy as np

from uplift.common.files import atomic_write
from uplift.cube import CubeData, contents


def write_npz(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write the arrays of docs/cube-file.md under their names, and say how many.

    Beside them lie ``multipliers`` (n, C) of the points and ``atlas.multipliers`` (E, C), from which spectra are
    evaluated at once; ``atlas.names`` (E,); and ``metadata``, the JSON text. Nothing is pickled. Raises `OutputError`.
    """
    tensors, metadata = contents(data)
    arrays = tensors | {
        "multipliers": data.model.from_storage(data.points.coefficients[data.points.present]),
        "atlas.multipliers": data.model.from_storage(data.atlas.coefficients),
        "atlas.names": np.array(data.atlas.names, dtype=np.str_),
        "metadata": np.array(json.dumps(metadata, ensure_ascii=False)),
    }
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return len(arrays)
