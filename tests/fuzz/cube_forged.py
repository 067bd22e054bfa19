"""The cube loader against forgeries whose digest is right, so that the checks behind it are reached."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.cube.cube_files import forge
from tests.fuzz.cube_use import use
from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target
from uplift.cube import CubeData, read
from uplift.cube.file import POINT_TYPES
from uplift.lattice import Lattice, PointTable

Tensors = dict[str, NDArray[Any]]

NUMBERS = (
    np.nan,
    np.inf,
    -np.inf,
    -1.0,
    0.0,
    1.0,
    2.0,
    0.5,
    1e-300,
    5e-324,
    1e300,
    -1e300,
    1e-9,
    1 + 1e-9,
    255.0,
    1e9,
)
TYPES = (np.float64, np.float32, np.float16, np.int64, np.int32, np.int16, np.uint8, np.bool_, np.complex64)
VALUES = (
    None, True, False, 0, -1, 1, 3, 1 << 70, 10**400, 1e300, float("nan"), float("inf"), "", "moments",
    "sRGB", "D65", "\0",
    "\ud7ff", "ü" * 9999, [], [None], {}, {"name": "moments"}, ["debug"], ["errors"], "vision", 380.0, 1e-300,
)  # fmt: skip


def _coarse(data: CubeData) -> CubeData:
    """Every seventh node of the lattice: small, and a cube like any other."""
    lattice = Lattice(data.lattice.nodes[::7])
    kept = data.lattice.index(7 * lattice.position(np.arange(lattice.size)))
    arrays = {name: getattr(data.points, name) for name in POINT_TYPES}
    return replace(
        data,
        lattice=lattice,
        points=PointTable(**{name: None if array is None else array[kept] for name, array in arrays.items()}),
    )


SEEDS = tuple(_coarse(read(ROOT / "cubes" / f"{name}.uplift")) for name in ("moments-8-macbeth", "sigmoid-8"))


def _numbers(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Some numbers of an array."""
    name = _some(tensors, random)
    array = tensors[name] = tensors[name].copy()
    places = random.integers(max(array.size, 1), size=int(2 ** random.uniform(0, 10)))
    value = NUMBERS[random.integers(len(NUMBERS))]
    if array.size:
        with np.errstate(all="ignore"):
            array.flat[places] = np.asarray(value).astype(array.dtype)


def _noise(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """An array of any numbers of some scale."""
    name = _some(tensors, random)
    with np.errstate(all="ignore"):
        noise = random.normal(size=tensors[name].shape) * 10.0 ** random.integers(-12, 13)
        tensors[name] = noise.astype(tensors[name].dtype)


def _kind(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = _some(tensors, random)
    with np.errstate(all="ignore"):
        tensors[name] = tensors[name].astype(TYPES[random.integers(len(TYPES))])


def _shape(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = _some(tensors, random)
    array = np.atleast_1d(tensors[name])
    shapes = (
        array[:-1],
        array[:0],
        array[None],
        array.ravel(),
        array.T,
        array[:1],
        np.repeat(array, 2, axis=0),
        array.sum(),
    )
    tensors[name] = np.asarray(shapes[random.integers(len(shapes))])


def _missing(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    tensors.pop(_some(tensors, random))


def _fact(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """A value anywhere in the metadata, or a key taken away."""
    place: Any = metadata
    while True:
        key = _some(place, random)
        inner = place[key]
        if not inner or not isinstance(inner, dict | list) or random.random() < 0.4:
            break
        place = inner if isinstance(inner, dict) else dict(enumerate(inner))
    if random.random() < 0.1:
        del place[key]
    else:
        place[key] = VALUES[random.integers(len(VALUES))]


def _some(keys: Any, random: Random) -> Any:
    names = list(keys)
    return names[random.integers(len(names))]


WAYS = (_numbers, _noise, _kind, _shape, _missing, _fact)


def _write(random: Random, path: Path) -> None:
    def spoil(tensors: Tensors, metadata: dict[str, Any]) -> None:
        for _ in range(int(random.integers(1, 3))):
            WAYS[random.integers(len(WAYS))](tensors, metadata, random)

    forge(SEEDS[random.integers(len(SEEDS))], path, spoil)


TARGET = Target("cube, right digest", _write, use)
