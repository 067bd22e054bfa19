"""Fuzz targets of the readers: seeds of each format, and what is done with a file that
is accepted.
"""

import copy
import csv
import dataclasses
import functools
import io
import json
import tempfile
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageCms

from tests.atlas.vendor_files import VENDORS, Files, sample
from tests.cube.cube_files import forge, header_length, with_header, with_header_length
from tests.extras.texture.exr_bytes import attribute, exr_bytes
from tests.extras.texture.image_bytes import BT2020, hdr_bytes, tiff_bytes
from tests.fuzz.fuzzing import ROOT, Random, Seeds, Target, choose, mutate, mutated
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas, write_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import METHODS, map_to_gamut
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
from uplift.lookup.cube import Cube, load
from uplift.lookup.interpolate import MODES
from uplift.pipeline.options import Options

# --- atlases ---

ART_ENTRY = """Entry ID:   %s
Description           :  "a card"
Type                  :  reflectance spectrum
Sampling information
Type                  :  %s
Maximum sample value  :  1.0
ASCII sample data
{%s}
"""
REGULAR = (
    "regular\nStart : 400.0 nm\nIncrement : 100.0 nm",
    "0.5, 0.25, 0.125, 0.0625",
)
SAMPLED = ("point sampled", "{380, 0.5}, {500.5, 0.1}, {720, 1}")
ART_ENTRIES = tuple(
    (ART_ENTRY % (name, *rest)).encode()
    for name, *rest in (("grey", *REGULAR), ("other", *SAMPLED))
)
ART_HEADER = b"ART measurement archive version 1.1\nArchive content: cards\n"
ART_SHIPPED = (ROOT / "atlases" / "macbeth.txt").read_bytes()
ART_SEEDS = (
    ART_HEADER + b"".join(ART_ENTRIES),
    *ART_ENTRIES,
    ART_SHIPPED[: ART_SHIPPED.index(b"Entry ID", 2000)],
)
TABLE_ROWS = b"name,400,500,600,700\ngrey,0.5,0.25,0.125,0.0625\n\"a, 'b'\",1,0,1,0\n"
TABLE_SEEDS = (
    TABLE_ROWS,
    TABLE_ROWS.replace(b"\n", b"\r\n"),
    b"\xef\xbb\xbf" + TABLE_ROWS,
    b"nm;grey;other\n380;0,5;0,1\n500;0,25;0,2\n700;0,125;0,3\n720;0,1;0,4\n",
    b"\tred\tblue\n400 nm\t50\t1\n550 nm\t25\t2\n700 nm\t12.5\t99\n",
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
    """Mutate a file of an instrument."""
    files = choose(random, _vendor_files())
    seeds = tuple(chain.from_iterable(each.values() for each in _vendor_files()))
    # The header is the file to read.
    spectra = [data for name, data in files.items() if name.endswith(".sli")]
    content, *others = [data for data in files.values() if data not in spectra]
    if random.random() < 0.95:
        content = mutate(content, random, seeds)
    path.write_bytes(content)
    for data in others:
        path.with_name("Wavelengths.txt").write_bytes(data)
    for data in spectra:
        if random.random() < 0.3:
            data = mutate(data, random, seeds)
        path.with_suffix(".sli").write_bytes(data)


# --- colours, charts, palettes, scenes, plans ---

COLOUR_SEEDS = (
    b"r,g,b\n0.1,0.2,0.3\n0.5,0.5,0.5\n",
    b"#cc3319\n#fff\n123456\n",
    b"0.1 0.2 0.3 a name\r\n1;0;1\r\n",
    b"1e308,-1e308,5e-324\n1.4,0.3,-0.1\n1e300,0.5,1e-300\n",
)


@functools.cache
def _cube() -> Cube:
    return load(ROOT / "cubes" / "moments-8-macbeth.uplift")


def use_colours(path: Path) -> None:
    """Map the colours into the gamut and query them."""
    cube = _cube()
    with path.open("rb") as file:
        for rgb in ColourSource().parse_table(file, path.name, cube.data.sensor):
            for method in METHODS[1:]:
                mapped = map_to_gamut(rgb, cube.data.sensor, method).rgb
                if not ((mapped >= 0) & (mapped <= 1)).all():
                    raise ValueError(f"{method}: colours outside [0, 1]")
            clipped = map_to_gamut(rgb, cube.data.sensor, "clip").rgb
            if not np.array_equal(clipped, np.clip(rgb, 0, 1)):
                raise ValueError("clipping changed another channel")
            if not np.isfinite(cube.reflectance(clipped[:8])).all():
                raise ValueError("reflectances that are not finite")


@functools.cache
def _chart() -> Seeds:
    """The heading, two other methods and three cubes of the shipped table."""
    text = (ROOT / "uplift" / "lab" / "chart" / "measured.csv").read_text(
        encoding="utf-8"
    )
    heading, *rows = csv.reader(text.splitlines())
    first = [bool(row[heading.index("build")]) for row in rows].index(True)
    kept = io.StringIO()
    csv.writer(kept).writerows([heading, *rows[:2], *rows[first : first + 3]])
    return (kept.getvalue().encode(),)


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
quantile = 0.9
encoding = "auto"
space = "sRGB"
illuminant = "D65"
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

RGB = np.array(
    [[0.2, 0.3, 0.4], [0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5], [0.9, 0.0, 0.1]]
)
LIGHT = observer.light("FL11")
WAVELENGTHS = np.array([300.0, 380.0, 555.5, 780.0, 1000.0])
LENGTHS = (0, 1, 7, 8, 1 << 20, 1 << 31, 1 << 40, (1 << 63) - 1, (1 << 64) - 1)
FLOATS = (
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
DTYPES = (
    np.float64,
    np.float32,
    np.float16,
    np.int64,
    np.int32,
    np.int16,
    np.uint8,
    np.bool_,
    np.complex64,
)
VALUES = (
    None, True, False, 0, -1, 1, 3, 1 << 40, 1 << 70, 10**400, 5e-324, 1e-13, 1e300,
    float("nan"), float("inf"), "",
    "grey", "moments", "D65", "../macbeth.txt", "/etc/shadow", "/proc/kmsg", "\0", "\n",
    "\x1b]0;t\x07", "\u202e",
    "=1+1", "ü" * 9999, "x" * 100_000, ["grey"] * 65, ["grey"] * 100_000, [], [None],
    {}, {"name": "moments"}, ["x"],
    [1 << 40] * 3, "BF16", "F8_E4M3", "BOOL",
)  # fmt: skip
CUBE_FILES = tuple(
    ROOT / "cubes" / f"{name}.uplift" for name in ("moments-8-macbeth", "sigmoid-8")
)


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
            near = size + int(random.integers(-9, 10))
            length = near if random.random() < 0.5 else choose(random, LENGTHS)
            content = with_header_length(content, length)
        case _:
            content = with_header(content, mutate(header, random, (header,)))
    path.write_bytes(content)


def _change_array(
    tensors: dict[str, Any], metadata: dict[str, Any], random: Random
) -> None:
    """Change numbers, type or shape of an array, or remove it."""
    name = choose(random, list(tensors))
    array = np.array(tensors[name])
    match random.integers(5):
        case 0 if array.size:
            places = random.integers(array.size, size=int(2 ** random.uniform(0, 10)))
            array.flat[places] = np.asarray(choose(random, FLOATS)).astype(array.dtype)
        case 1:
            scale = 10.0 ** random.integers(-12, 13)
            array = (random.normal(size=array.shape) * scale).astype(array.dtype)
        case 2:
            array = array.astype(choose(random, DTYPES))
        case 3:
            array = np.atleast_1d(array)
            others = (
                array[:-1],
                array[:0],
                array[:1],
                array[None],
                array.T,
                array.ravel(),
                array.repeat(2, 0),
            )
            array = choose(random, (*others, array.sum()))
        case 4:
            del tensors[name]
            return
    tensors[name] = np.asarray(array)


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


def _change_metadata(
    tensors: dict[str, Any], metadata: dict[str, Any], random: Random
) -> None:
    """Replace, remove or add a value anywhere in the metadata, sometimes a
    nested one.
    """
    place, key = choose(random, list(_places(metadata)))
    value = copy.deepcopy(choose(random, VALUES))
    draw = random.random()
    depth = choose(random, (1, 2, 3, 20, 33, 300)) if random.random() < 0.2 else 0
    for _ in range(depth):
        value = {"a": value} if random.random() < 0.5 else [value]
    if draw < 0.1:
        del place[key]
    else:
        place["grey" if draw < 0.2 and isinstance(place, dict) else key] = value


def _forged(random: Random, path: Path) -> None:
    """Change a cube under a valid digest."""
    forge(choose(random, CUBES), path, functools.partial(change_content, random))


def change_content(
    random: Random, tensors: dict[str, Any], metadata: dict[str, Any]
) -> None:
    """Change one or two arrays or values."""
    with np.errstate(all="ignore"):
        for _ in range(int(random.integers(1, 3))):
            act = choose(random, (_change_array, _change_metadata))
            act(tensors, metadata, random)


# --- images ---


@functools.cache
def _images() -> Seeds:
    codes = np.random.default_rng(0).integers(0, 256, (6, 7, 4), dtype=np.uint8)
    profile = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    images = []
    for kind, depth, options in (
        ("PNG", 4, {}),
        ("PNG", 3, {"icc_profile": profile}),
        ("JPEG", 3, {"icc_profile": profile}),
        ("TIFF", 3, {"compression": "tiff_deflate"}),
        ("TIFF", 4, {"compression": "raw"}),
    ):
        buffer = io.BytesIO()
        Image.fromarray(codes[..., :depth]).save(buffer, kind, **options)
        images.append(buffer.getvalue())
    tags = {
        318: (5, BT2020[6:]),
        319: (5, BT2020[:6]),
        301: (3, list(range(0, 65536, 257))),
    }
    exif = {0xA001: (3, [65535])}, {1: (2, b"R03\0")}
    images.append(tiff_bytes(codes, tags, "<", *exif))
    buffer = io.BytesIO()
    Image.fromarray(codes[..., :3]).save(
        buffer, "JPEG", exif=b"Exif\0\0" + tiff_bytes(None, tags, ">", *exif)
    )
    images.append(buffer.getvalue())
    images.append(
        hdr_bytes(codes[..., :3], 128, f"PRIMARIES= {' '.join(map(str, BT2020))}\n")
    )
    images.append(
        exr_bytes(
            [b"X", b"Y", b"Z", b"A"], attribute(b"whiteLuminance", b"float", bytes(4))
        )
    )
    text = attribute(b"owner", b"string", b"someone") + attribute(
        b"chromaticities", b"chromaticities", bytes(32)
    )
    return (*images, exr_bytes(), exr_bytes([b"R", b"G", b"B", b"A", b"Z"], text))


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
    mutated("atlas table", use_atlas, lambda: TABLE_SEEDS),
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
