"""Fuzz targets of the cube reader: corrupted bytes, and invalid content under a valid digest."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.cube.cube_files import forge, header_length, with_header, with_header_length
from tests.fuzz.campaign import ROOT, Target
from tests.fuzz.mutate import Random, choose, mutate
from uplift.colorimetry.observer import light
from uplift.common.errors import CubeFileError, UpliftError
from uplift.cube import CubeData, read
from uplift.cube.file import POINTS
from uplift.lattice import Lattice, PointTable
from uplift.lookup import MODES, load, query
from uplift.pipeline.options import Options, recorded_options
from uplift.pipeline.rebuild import recorded_atlas
from uplift.report.summary import summarise

Tensors = dict[str, NDArray[Any]]

FILES = tuple(ROOT / "cubes" / f"{name}.uplift" for name in ("moments-8-macbeth", "sigmoid-8"))
RGB = np.array([[0.2, 0.3, 0.4], [0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5], [0.9, 0.0, 0.1]])
LIGHT = light("FL11")
WAVELENGTHS = np.array([300.0, 380.0, 555.5, 780.0, 1000.0])
LENGTHS = (0, 1, 7, 8, 1 << 20, 1 << 31, 1 << 40, (1 << 63) - 1, (1 << 64) - 1)
FLOATS = (np.nan, np.inf, -np.inf, -1.0, 0.0, 1.0, 2.0, 0.5, 1e-300, 5e-324, 1e300, -1e300, 1e-9, 1 + 1e-9, 255.0, 1e9)
TYPES = (np.float64, np.float32, np.float16, np.int64, np.int32, np.int16, np.uint8, np.bool_, np.complex64)
VALUES = (
    None, True, False, 0, -1, 1, 3, 1 << 40, 1 << 70, 10**400, 5e-324, 1e-13, 1e300, float("nan"), float("inf"), "",
    "grey", "moments", "D65", "../macbeth.txt", "/etc/shadow", "/proc/kmsg", "\0", "\n", "\x1b]0;t\x07", "\u202e",
    "=1+1", "ü" * 9999, "x" * 100_000, ["grey"] * 65, ["grey"] * 100_000, [], [None], {}, {"name": "moments"}, ["x"],
    [1 << 40] * 3, "BF16", "F8_E4M3", "BOOL",
)  # fmt: skip
DEPTHS = (1, 2, 3, 20, 33, 300)


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


SEEDS = tuple(_coarse(read(path)) for path in FILES)


def use_cube(path: Path) -> None:
    """Query a cube in every mode, summarise it, prepare its rebuild, write it and read it again."""
    cube = load(path)
    for mode in MODES:
        reflectance = cube.reflectance(RGB, WAVELENGTHS, mode)
        if not ((reflectance >= 0) & (reflectance <= 1)).all():
            raise ValueError(f"{mode}: reflectances outside [0, 1]")
    lights = [None] if cube.data.atlas.left_out is None else [None, LIGHT]
    for errors in [cube.standard_error(RGB, each) for each in lights]:
        if errors is not None and not np.isfinite(errors).all():
            raise ValueError("standard errors that are not finite")
    if not all(np.isfinite(result.round_trip).all() for result in query(cube, RGB)):
        raise ValueError("round trips that are not finite")
    json.dumps(summarise(cube.data), allow_nan=False)
    recorded_atlas(cube.data, path)
    if options := cube.data.provenance.get("options"):
        try:
            Options(**recorded_options(options))
        except TypeError as error:  # an unknown option, which a rebuild reports
            raise CubeFileError("unknown options") from error
    copy = path.with_suffix(".copy")
    try:
        cube.save(copy, force=True)
        load(copy)
    except UpliftError as error:
        raise ValueError("the written cube cannot be read") from error
    finally:
        copy.unlink(missing_ok=True)


def _corrupted(random: Random, path: Path) -> None:
    """Mutate bytes anywhere, in the header or its length, or a value or key of the header, which stays JSON."""
    content = choose(random, FILES).read_bytes()
    size = header_length(content)
    header = content[8 : 8 + size]
    match random.integers(4):
        case 0:
            content = mutate(content, random, (header,))
        case 1:
            near = size + int(random.integers(-9, 10))
            content = with_header_length(content, near if random.random() < 0.5 else choose(random, LENGTHS))
        case 2:
            content = with_header(content, mutate(header, random, (header,)))
        case _:
            content = with_header(content, _changed_header(header, random))
    path.write_bytes(content)


def _changed_header(text: bytes, random: Random) -> bytes:
    """Repeat a key of the header, or change one value of an array."""
    header: dict[str, Any] = json.loads(text)
    name, other = choose(random, list(header)), choose(random, list(header))
    if random.random() < 0.3:
        return text.rstrip()[:-1] + f",{json.dumps(name)}:{json.dumps(header[other])}}}".encode()
    key = choose(random, list(header[name]))
    old, new = header[name][key], choose(random, VALUES)
    if isinstance(old, list) and old and random.random() < 0.7:
        old[random.integers(len(old))] = new
    else:
        header[name][key] = new
    return json.dumps(header).encode()


def _numbers(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace some numbers of an array."""
    name = choose(random, list(tensors))
    array = tensors[name] = tensors[name].copy()
    places = random.integers(max(array.size, 1), size=int(2 ** random.uniform(0, 10)))
    value = choose(random, FLOATS)
    if array.size:
        with np.errstate(all="ignore"):
            array.flat[places] = np.asarray(value).astype(array.dtype)


def _noise(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace an array by noise of a random scale."""
    name = choose(random, list(tensors))
    with np.errstate(all="ignore"):
        noise = random.normal(size=tensors[name].shape) * 10.0 ** random.integers(-12, 13)
        tensors[name] = noise.astype(tensors[name].dtype)


def _type(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = choose(random, list(tensors))
    with np.errstate(all="ignore"):
        tensors[name] = tensors[name].astype(choose(random, TYPES))


def _shape(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    name = choose(random, list(tensors))
    array = np.atleast_1d(tensors[name])
    other = (
        array[:-1],
        array[:0],
        array[:1],
        array[None],
        array.T,
        array.ravel(),
        array.repeat(2, axis=0),
        array.sum(),
    )
    tensors[name] = np.asarray(choose(random, other))


def _missing(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    tensors.pop(choose(random, list(tensors)))


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every container in ``value`` with each of its keys."""
    for key in value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ():
        yield value, key
        yield from _places(value[key])


def _metadata(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace, remove or add a value anywhere in the metadata."""
    place, key = choose(random, list(_places(metadata)))
    draw = random.random()
    if draw < 0.1:
        del place[key]
    elif draw < 0.2 and isinstance(place, dict):
        place["grey"] = _value(random)
    else:
        place[key] = _value(random)


def _value(random: Random) -> Any:
    """Return one of `VALUES`, sometimes nested."""
    value = choose(random, VALUES)
    for _ in range(choose(random, DEPTHS) if random.random() < 0.2 else 0):
        value = {"a": value} if random.random() < 0.5 else [value]
    return value


CHANGES = (_numbers, _noise, _type, _shape, _missing)


def _forged(random: Random, path: Path, changes: tuple[Any, ...]) -> None:
    def change(tensors: Tensors, metadata: dict[str, Any]) -> None:
        for _ in range(int(random.integers(1, 3))):
            choose(random, changes)(tensors, metadata, random)

    forge(choose(random, SEEDS), path, change)


TARGETS = (
    Target("cube, corrupted bytes", _corrupted, use_cube),
    Target("cube, valid digest", lambda random, path: _forged(random, path, CHANGES), use_cube),
    Target("cube, metadata", lambda random, path: _forged(random, path, (_metadata,)), use_cube),
)
