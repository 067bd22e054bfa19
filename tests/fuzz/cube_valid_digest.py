"""Fuzz target: the cube reader, with invalid content and a valid digest, which reaches the validation of content."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.cube.cube_files import forge
from tests.fuzz.mutate import Random
from tests.fuzz.target import ROOT, Target
from tests.fuzz.use_cube import use_cube
from uplift.cube import CubeData, read
from uplift.cube.file import POINTS
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
    """Keep every seventh node of the lattice, which makes a small valid cube."""
    lattice = Lattice(data.lattice.nodes[::7])
    kept = data.lattice.index(7 * lattice.position(np.arange(lattice.size)))
    arrays = {name: getattr(data.points, name) for name in POINTS}
    return replace(
        data,
        lattice=lattice,
        points=PointTable(**{name: None if array is None else array[kept] for name, array in arrays.items()}),
    )


SEEDS = tuple(_coarse(read(ROOT / "cubes" / f"{name}.uplift")) for name in ("moments-8-macbeth", "sigmoid-8"))


def _numbers(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace some numbers of an array."""
    name = _choose(tensors, random)
    array = tensors[name] = tensors[name].copy()
    places = random.integers(max(array.size, 1), size=int(2 ** random.uniform(0, 10)))
    value = NUMBERS[random.integers(len(NUMBERS))]
    if array.size:
        with np.errstate(all="ignore"):
            array.flat[places] = np.asarray(value).astype(array.dtype)


def _noise(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace an array by noise of a random scale."""
    name = _choose(tensors, random)
    with np.errstate(all="ignore"):
        noise = random.normal(size=tensors[name].shape) * 10.0 ** random.integers(-12, 13)
        tensors[name] = noise.astype(tensors[name].dtype)


def _type(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = _choose(tensors, random)
    with np.errstate(all="ignore"):
        tensors[name] = tensors[name].astype(TYPES[random.integers(len(TYPES))])


def _shape(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = _choose(tensors, random)
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
    tensors.pop(_choose(tensors, random))


def _metadata(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace a value anywhere in the metadata, or remove a key."""
    place: Any = metadata
    while True:
        key = _choose(place, random)
        inner = place[key]
        if not inner or not isinstance(inner, dict | list) or random.random() < 0.4:
            break
        place = inner if isinstance(inner, dict) else dict(enumerate(inner))
    if random.random() < 0.1:
        del place[key]
    else:
        place[key] = VALUES[random.integers(len(VALUES))]


def _choose(keys: Any, random: Random) -> Any:
    names = list(keys)
    return names[random.integers(len(names))]


MUTATIONS = (_numbers, _noise, _type, _shape, _missing, _metadata)


def _generate(random: Random, path: Path) -> None:
    def change(tensors: Tensors, metadata: dict[str, Any]) -> None:
        for _ in range(int(random.integers(1, 3))):
            MUTATIONS[random.integers(len(MUTATIONS))](tensors, metadata, random)

    forge(SEEDS[random.integers(len(SEEDS))], path, change)


TARGET = Target("cube, valid digest", _generate, use_cube)
