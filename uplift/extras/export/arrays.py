"""Cubes as arrays: the contents of a cube file as npz."""

import json
from pathlib import Path

import numpy as np

from uplift.common.arrays import StrPath
from uplift.common.files import atomic_write
from uplift.common.text import pluralise
from uplift.cube.data import CubeData
from uplift.cube.file import contents
from uplift.lookup.cube import Cube


def export_npz(cube: Cube, path: Path, style: str, *, force: bool) -> str:
    """Write all arrays."""
    return pluralise(write_npz(cube.data, path, force=force), "array")


def write_npz(data: CubeData, path: StrPath, *, force: bool = False) -> int:
    """Write a cube as an ``.npz`` file without pickled objects; return the number of
    arrays.

    The file has the arrays of docs/cube-file.md under their names. In addition, it has
    ``multipliers`` (n, C) of the nodes in ``model`` and ``atlas.multipliers`` (E, K) of
    the entries in ``entry_model``, from which spectra are evaluated directly,
    ``atlas.names`` (E,), the same of the entries outside the RGB space as
    ``outside.…``, if there are any, and ``metadata``, the JSON text with both models.
    """
    tensors, metadata = contents(data)
    arrays = tensors | {
        "multipliers": data.model.from_storage(
            data.points.coefficients[data.points.present]
        ),
        "metadata": np.array(json.dumps(metadata, ensure_ascii=False, allow_nan=False)),
    }
    for prefix, table in (("atlas", data.atlas), ("outside", data.atlas.outside)):
        if table is not None:
            arrays[f"{prefix}.multipliers"] = table.spectra.multipliers
            arrays[f"{prefix}.names"] = np.array(table.names, dtype=np.str_)
    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        np.savez(file, allow_pickle=False, **arrays)
    return len(arrays)
