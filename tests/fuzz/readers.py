"""Fuzz targets of the readers: seeds of each format, and what is done with a file that
is accepted.
"""

import copy
import dataclasses
import functools
import json
import tempfile
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from tests.atlas.atlas_texts import ORANGE, PLAIN
from tests.atlas.vendor_files import VENDORS, Files, sample
from tests.cube.cube_files import forge, header_length, with_header, with_header_length
from tests.fuzz.fuzzing import ROOT, Random, Seeds, Target, choose, mutate, mutated
from tests.fuzz.images import draw_image
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas, write_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import METHODS, map_to_gamut
from uplift.common.arrays import Array
from uplift.common.colour_science import colour_science
from uplift.common.errors import UpliftError
from uplift.common.files import file_digest
from uplift.cube.data import CubeData
from uplift.cube.file import read, summarise
from uplift.cube.schema import POINTS
from uplift.extras.colour.colour_source import ColourSource
from uplift.extras.colour.query import query_blocks
from uplift.extras.images.converter import ImageConverter, RowConverter
from uplift.extras.images.counts import Counts
from uplift.extras.images.reader import SurfaceReader
from uplift.extras.papers.palette.design import design, matrix
from uplift.extras.papers.palette.factor import standard_model
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.report.rebuild import recorded_atlas
from uplift.extras.scene.plan.files import FORMAT, read_plan, read_scene_file
from uplift.extras.texture.conversion import convert
from uplift.lab.chart.recommendation import Requirement, recommend_cube
from uplift.lab.chart.results import criteria, read_chart
from uplift.lattice.lattice import Lattice
from uplift.lattice.point_table import PointTable
from uplift.lookup.cube import load
from uplift.lookup.interpolate import MODES
from uplift.pipeline.options import Options

# --- atlases ---

ART_SEEDS = (
    PLAIN.encode(),
    ORANGE.encode(),
    PLAIN.replace("regular", "point sampled")
    .replace("{0.5, 0.25, 0.125, 0.0625}", "{{380, 0.5}, {500.5, 0.1}, {720, 1}}")
    .encode(),
    (ROOT / "atlases" / "macbeth.txt").read_bytes()[:2000],
)


def use_atlas(path: Path) -> None:
    """Use the atlas at ``path``. Raises `UpliftError` for invalid files, ValueError for
    invalid results.
    """
    atlas = read_atlas(path)
    values = resample(atlas, np.arange(380.0, 781.0, 5.0)).values
    if not ((values >= 0) & (values <= 1)).all():
        raise ValueError("reflectances outside [0, 1]")
    if atlas.entries:
        copy = path.with_suffix(".copy.txt")
        try:
            write_atlas(atlas, copy, force=True)
            if read_atlas(copy).names != atlas.names:
                raise ValueError("the written atlas has other names")
        except UpliftError as error:
            raise ValueError("the written atlas cannot be read") from error


@functools.cache
def _vendor_files() -> tuple[Files, ...]:
    colour_science()  # its import takes longer than a reader may
    macbeth = sample(read_atlas("macbeth"))
    return tuple(vendor.write(macbeth[: vendor.count]) for vendor in VENDORS)


def _vendor_file(random: Random, path: Path) -> None:
    """Mutate the files of an instrument, next to each other."""
    seeds = tuple(chain.from_iterable(each.values() for each in _vendor_files()))
    for name, content in choose(random, _vendor_files()).items():
        if random.random() < 0.9:
            content = mutate(content, random, seeds)
        if name == "Wavelengths.txt":
            path.with_name(name).write_bytes(content)
        else:
            path.with_suffix(".sli" * name.endswith(".sli")).write_bytes(content)


# --- colours, charts, palettes, scenes, plans ---

COLOUR_SEEDS = (
    b"r,g,b\n0.1,0.2,0.3\n0.5,0.5,0.5\n",
    b"#cc3319\n#fff\n123456\n",
    b"0.1 0.2 0.3 a name\r\n1;0;1\r\n",
    b"1e308,-1e308,5e-324\n1.4,0.3,-0.1\n1e300,0.5,1e-300\n",
)


def use_colours(path: Path) -> None:
    """Map the colours into the gamut and query them."""
    sensor = CUBE.data.sensor
    with path.open("rb") as file:
        for rgb in ColourSource().parse_table(file, path.name, sensor):
            for method in METHODS[1:]:
                mapped = map_to_gamut(rgb, sensor, method).rgb
                if not ((mapped >= 0) & (mapped <= 1)).all():
                    raise ValueError(f"{method}: colours outside [0, 1]")
                if not np.isfinite(CUBE.reflectance(mapped[:2])).all():
                    raise ValueError("reflectances that are not finite")


CHART = (ROOT / "uplift" / "lab" / "chart" / "measured.csv").read_bytes()


@functools.cache
def _chart() -> Seeds:
    """The heading and the first cube of each method of the shipped table."""
    heading, *rows = CHART.splitlines(keepends=True)
    methods = {row.split(b"-")[0]: row for row in reversed(rows)}
    return (b"".join([heading, *methods.values()]),)


def use_chart(path: Path) -> None:
    """Compute what pictures of the chart show, and recommend a cube."""
    chart = read_chart(path)
    for criterion in chain.from_iterable(criteria(batch) for batch in chart.batches):
        criterion.front(chart.measured)
    recommend_cube(chart, Requirement(time_ns=1e5))


SAMPLES = ROOT / "uplift" / "samples" / "files"
PALETTE_SEEDS = tuple(
    (SAMPLES / f"{name}.toml")
    .read_bytes()
    .replace(b"paints.csv", bytes(SAMPLES / "paints.csv"))
    for name in ("constant", "engine", "light", "metamers", "vanish")
)
_model = functools.cache(lambda count: standard_model(observer.sensor(), count))


def use_palette(path: Path) -> None:
    """Design the palette. Raises `UpliftError` for invalid files, ValueError for
    invalid spectra.
    """
    palette = read_palette(path)
    result = design(palette, _model(palette.count))
    matrix(result)
    if not (
        np.isfinite(result.powers).all() and np.isfinite(result.reflectances).all()
    ):
        raise ValueError("spectra that are not finite")


SOURCES = {
    "texture.png": ROOT / "docs" / "mixing" / "mixer.png",
    "atlas.txt": ROOT / "atlases" / "macbeth.txt",
}
"""Texture and atlas by their names in the folder of a scene or a plan."""
SCENE_FILE = b"""# a kitchen
textures = ["texture.png", "*.png"]
atlases = "atlas.txt"
lights = ["D65", "FL11"]
tolerance = 0.5
space = "sRGB"
"""


@functools.cache
def _plan() -> Seeds:
    """Make the part of a plan that its reader uses."""
    texture, atlas = (
        [{"path": name, "digest": file_digest(path)}] for name, path in SOURCES.items()
    )
    scene = {"encoding": "auto", "textures": texture, "atlases": atlas}
    plan = {
        "format": FORMAT,
        "scene": scene,
        "build": dataclasses.asdict(Options(dim=8)),
        "cells": "sparse",
    }
    return (
        json.dumps(plan, indent=40).encode(),
    )  # mostly blanks, so that some mutations leave it valid


# --- cubes ---

RGB = np.array([[0.2, 0.3, 0.4], [0, 0, 0], [1, 1, 1], [0.9, 0.0, 0.1]])
LIGHT = observer.light("FL11")
WAVELENGTHS = np.array([300.0, 380.0, 555.5, 780.0, 1000.0])
FLOATS = (np.nan, np.inf, -1.0, 0.0, 2.0, 0.5, 5e-324, 1e300, 1 + 1e-9, 255.0)
VALUES = (
    *FLOATS, None, True, 0, 3, 1 << 70, 10**400, 1e-13, "", "grey", "moments", "D65",
    "/etc/shadow", "\x1b]0;t\x07", "x" * 100_000, ["grey"] * 65, [], {}, [1 << 40] * 3,
    "BF16", "BOOL", functools.reduce(lambda value, _: [value], range(300)),
)  # fmt: skip
CUBE_FILES = tuple(
    ROOT / "cubes" / f"{name}.uplift" for name in ("moments-8-macbeth", "sigmoid-8")
)
CUBE = load(CUBE_FILES[0])


def _coarse(data: CubeData) -> CubeData:
    """Keep every seventh node of the lattice, which makes a small valid cube."""
    lattice = Lattice(data.lattice.nodes[::7])
    kept = data.lattice.index(7 * lattice.position(np.arange(lattice.size)))
    arrays = {name: getattr(data.points, name) for name in POINTS}
    kept_arrays = {
        name: array[kept] for name, array in arrays.items() if array is not None
    }
    points = PointTable(**kept_arrays)
    return dataclasses.replace(data, lattice=lattice, points=points)


CUBES = tuple(_coarse(read(path)) for path in CUBE_FILES)


def use_cube(path: Path) -> None:
    """Query a cube in every mode, summarise it, prepare its rebuild, write it and read
    it again.
    """
    cube = load(path)
    for mode in MODES:
        reflectance = cube.reflectance(RGB, WAVELENGTHS, mode)
        if not ((reflectance >= 0) & (reflectance <= 1)).all():
            raise ValueError(f"{mode}: reflectances outside [0, 1]")
    lights = [None] if cube.data.atlas.left_out is None else [None, LIGHT]
    for light in lights:
        errors = cube.standard_error(RGB, light)
        if errors is not None and not np.isfinite(errors).all():
            raise ValueError("standard errors that are not finite")
    if not all(
        np.isfinite(block.round_trip).all() for block in query_blocks(cube, RGB)
    ):
        raise ValueError("round trips that are not finite")
    json.dumps(summarise(cube.data), allow_nan=False)
    recorded_atlas(cube.data, path)
    copy = path.with_suffix(".copy")
    try:
        cube.save(copy, force=True)
        load(copy)
    except UpliftError as error:
        raise ValueError("the written cube cannot be read") from error


def _corrupted(random: Random, path: Path) -> None:
    """Mutate bytes anywhere, or in the header, or change its length."""
    content = choose(random, CUBE_FILES).read_bytes()
    size = header_length(content)
    header = content[8 : 8 + size]
    match random.integers(3):
        case 0:
            content = mutate(content, random, (header,))
        case 1:
            length = choose(random, (0, size - 8, size, size + 1, (1 << 64) - 1))
            content = with_header_length(content, length)
        case _:
            content = with_header(content, mutate(header, random, (header,)))
    path.write_bytes(content)


def _changed_array(array: Array, random: Random) -> Array:
    """Change numbers, type or shape of an array."""
    dtype = choose(random, ("f8", "f4", "f2", "i8", "i4", "u1", "?", "c8"))
    numbers = array.copy()
    if array.size:
        places = random.integers(array.size, size=int(2 ** random.uniform(0, 10)))
        numbers.flat[places] = np.asarray(choose(random, FLOATS)).astype(array.dtype)
    scale = 10.0 ** random.integers(-12, 13)
    return choose(
        random,
        (
            numbers,
            (random.normal(size=array.shape) * scale).astype(array.dtype),
            array.astype(dtype),
            array[:-1],
            array[:0],
            array[None],
            array.T,
            array.repeat(2, 0),
            np.asarray(array.sum()),
        ),
    )


def _places(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield every container in ``value`` with each of its keys."""
    keys: Iterable[Any] = ()
    if isinstance(value, dict):
        keys = value
    elif isinstance(value, list):
        keys = range(len(value))
    for key in keys:
        yield value, key
        yield from _places(value[key])


def _forged(random: Random, path: Path) -> None:
    """Change a cube under a valid digest."""
    forge(choose(random, CUBES), path, functools.partial(change_content, random))


def change_content(
    random: Random, tensors: dict[str, Any], metadata: dict[str, Any]
) -> None:
    """Change, remove or add one or two arrays or values of the metadata, a hostile
    value or one from elsewhere.
    """
    for _ in range(int(random.integers(1, 3))):
        place, key = choose(random, list(_places(metadata)))
        other, taken = choose(random, list(_places(metadata)))
        name = choose(random, list(tensors))
        match random.integers(8):
            case 0 | 1 | 2:
                with np.errstate(all="ignore"):
                    array = np.atleast_1d(tensors[name])
                    tensors[name] = _changed_array(array, random)
            case 3:
                del tensors[name]
            case 4:
                del place[key]
            case 5:
                place[key] = copy.deepcopy(other[taken])
            case _:
                place[key] = copy.deepcopy(choose(random, VALUES))


# --- images ---


@functools.cache
def _images() -> Seeds:
    """Valid images of all formats, with statements about their colours."""
    seeds = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(30):
            random = np.random.default_rng(number)
            seeds.append(draw_image(random, Path(folder)).path.read_bytes())
    return tuple(seeds)


def use_image(path: Path) -> None:
    """Convert to a texture."""
    same = RowConverter(
        reader=SurfaceReader(sensor=observer.sensor()),
        depth="half",
        header={},
        to_rows=ImageConverter(lambda band: ((band.rgb,), Counts())),
    )
    with tempfile.TemporaryDirectory(dir=path.parent) as out:
        convert(same, path, Path(out) / "out.exr")


def with_sources(path: Path) -> Path:
    """Link texture and atlas into the folder of a file."""
    for name, file in SOURCES.items():
        if not path.with_name(name).exists():
            path.with_name(name).symlink_to(file)
    return path


TARGETS = (
    mutated("atlas text", use_atlas, lambda: ART_SEEDS),
    Target("atlas of an instrument", _vendor_file, use_atlas),
    mutated("colour table", use_colours, lambda: COLOUR_SEEDS),
    mutated("chart table", use_chart, _chart),
    mutated("palette", use_palette, lambda: PALETTE_SEEDS),
    mutated(
        "scene file",
        lambda path: read_scene_file(with_sources(path)).sensor(),
        lambda: (SCENE_FILE,),
    ),
    mutated("plan", lambda path: read_plan(with_sources(path)), _plan),
    Target("cube, corrupted bytes", _corrupted, use_cube),
    Target("cube, valid digest", _forged, use_cube),
    mutated("image", use_image, _images),
)
READERS = {target.name: target for target in TARGETS}
