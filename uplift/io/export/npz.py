"""The contents of a cube file as named numpy arrays."""

from __future__ import annotations

import json
import os

import numpy as np

from uplift.common.files import atomic_write
from uplift.cube import CubeData, contents


def write_npz(data: CubeData, path: str | os.PathLike[str], *, force: bool = False) -> int:
    """Write a cube as an ``.npz`` file without pickled objects; return the number of arrays.

    The file has the arrays of docs/cube-file.md under their names. In addition, it has ``multipliers`` (n, C) of the
    nodes in ``model`` and ``atlas.multipliers`` (E, K) of the entries in ``entry_model``, from which spectra are
    evaluated directly, ``atlas.names`` (E,), and ``metadata``, the JSON text with both models.
    """
    tensors, metadata = contents(data)
    arrays = tensors | {
        "multipliers": data.model.from_storage(data.points.coefficients[data.points.present]),
        "atlas.multipliers": data.entry_spectra.multipliers,
        "atlas.names": np.array(data.atlas.names, dtype=np.str_),
        "metadata": np.array(json.dumps(metadata, ensure_ascii=False, allow_nan=False)),
    }
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return len(arrays)
