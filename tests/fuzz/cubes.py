"""Fuzz targets of the cube reader: corrupted bytes, and invalid content under a valid digest."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.cube.cube_files import forge
from tests.fuzz.mutate import NUMBERS, Random, choose, mutate
from tests.fuzz.target import ROOT, Target
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
TOKENS = (
    b'"F64"', b'"F32"', b'"BF16"', b'"U8"', b'"BOOL"', b'"F8_E4M3"', b"[512,9]", b"[512]", b"[4294967296,4294967296]",
    b"[]", b"{", b"}", b"[", b"]", b'"', b"\\", b"\\u0000", b"\\ud800", b",", b":", b"null", b'"nodes"', b'"rgb"',
    b'"shape"', b'"dtype"', b'"data_offsets"', b'"__metadata__"', b'\\"digest\\"', b"[" * 5000, b'{"a":' * 5000, b"NaN",
    b"Infinity", b"true", b"\0", b"\xff", *NUMBERS,
)  # fmt: skip
LENGTHS = (0, 1, 7, 8, 1 << 20, 1 << 31, 1 << 40, (1 << 63) - 1, (1 << 64) - 1)
FLOATS = (np.nan, np.inf, -np.inf, -1.0, 0.0, 1.0, 2.0, 0.5, 1e-300, 5e-324, 1e300, -1e300, 1e-9, 1 + 1e-9, 255.0, 1e9)
TYPES = (np.float64, np.float32, np.float16, np.int64, np.int32, np.int16, np.uint8, np.bool_, np.complex64)
VALUES = (
    None, True, False, 0, -1, 1, 3, 1 << 40, 1 << 70, 10**400, 5e-324, 1e-13, 1e300, float("nan"), float("inf"), "",
    "grey", "moments", "D65", "../macbeth.txt", "/etc/shadow", "/proc/kmsg", "\0", "\n", "\x1b]0;t\x07", "\u202e",
    "=1+1", "ü" * 9999, "x" * 100_000, ["grey"] * 65, ["grey"] * 100_000, [], [None], {}, {"name": "moments"}, ["x"],
    [1 << 40] * 3,
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
    standard_error = cube.standard_error(RGB)
    if standard_error is not None and not np.isfinite(standard_error).all():
        raise ValueError("standard errors that are not finite")
    if cube.data.atlas.left_out is not None:
        errors = cube.standard_error(RGB, LIGHT)
        if errors is not None and not np.isfinite(errors).all():
            raise ValueError("standard errors under a light that are not finite")
    if not all(np.isfinite(result.round_trip).all() for result in query(cube, RGB)):
        raise ValueError("round trips that are not finite")
    json.dumps(summarise(cube.data), allow_nan=False)
    recorded_atlas(cube.data, path)
    if options := cube.data.provenance.get("options"):
        _recorded(options)
    copy = path.with_suffix(".copy")
    try:
        cube.save(copy, force=True)
        load(copy)
    except UpliftError as error:
        raise ValueError("the written cube cannot be read") from error
    finally:
        copy.unlink(missing_ok=True)


def _recorded(options: dict[str, Any]) -> Options:
    try:
        return Options(**recorded_options(options))
    except TypeError as error:  # an unknown option, which a rebuild reports
        raise CubeFileError("unknown options") from error


def _corrupted(random: Random, path: Path) -> None:
    """Mutate bytes anywhere, in the header or its length, or a value or key of the header, which stays JSON."""
    content = choose(random, FILES).read_bytes()
    size = int(struct.unpack("<Q", content[:8])[0])
    text, arrays = content[8 : 8 + size], content[8 + size :]
    kind = random.integers(4)
    if kind == 0:
        path.write_bytes(mutate(content, random, TOKENS))
        return
    if kind == 1:
        near = size + int(random.integers(-9, 10))
        path.write_bytes(struct.pack("<Q", near if random.random() < 0.5 else choose(random, LENGTHS)) + content[8:])
        return
    header = mutate(text, random, TOKENS) if kind == 2 else _changed_header(text, random)
    path.write_bytes(struct.pack("<Q", len(header)) + header + arrays)


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
    tensors.pop(choose(random, list(tensors)))


def _metadata(tensors: Tensors, metadata: dict[str, Any], random: Random) -> None:
    """Replace, remove or add a value anywhere in the metadata."""
    place: Any = metadata.get("provenance")
    if not isinstance(place, dict) or random.random() < 0.5:
        place = metadata
    while True:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        if not keys:
            break
        key = choose(random, keys)
        if isinstance(place[key], dict | list) and random.random() < 0.7:
            place = place[key]
        elif random.random() < 0.1:
            del place[key]
            return
        else:
            place[key] = _value(random)
            return
    if isinstance(place, dict):
        place["grey"] = _value(random)
    else:
        place.append(_value(random))


def _value(random: Random) -> Any:
    """Return one of `VALUES`, sometimes nested."""
    value = choose(random, VALUES)
    if random.random() < 0.2:
        for _ in range(choose(random, DEPTHS)):
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
