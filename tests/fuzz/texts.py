"""Fuzz targets of the readers of text: seeds, tokens of the format, and what is done with a file that is accepted."""

from __future__ import annotations

import csv
import dataclasses
import functools
import io
import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from uplift_cli.colours import ColourReader

from tests.atlas.vendor_files import VENDORS, Files, sample
from tests.fuzz.mutate import NUMBERS, Random, choose, mutate
from tests.fuzz.target import ROOT, Target
from uplift.atlas import read_atlas, resample, write_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import METHODS, map_to_gamut
from uplift.common.colour_science import colour_science
from uplift.common.errors import UpliftError
from uplift.design.palette import FactorModel, design, matrix, read_palette, standard_model
from uplift.io.scene_colours import file_digest
from uplift.lab.chart.table import Requirement, all_panels, read_chart, recommend_cube
from uplift.lookup import Cube, load
from uplift.pipeline.options import Options, check_memory
from uplift.scene.plan import read_plan, read_scene_file
from uplift.scene.plan.plan_file import FORMAT

SAMPLES = ROOT / "uplift" / "samples" / "files"
GRID = np.arange(380.0, 781.0, 5.0)


def text_target(
    name: str, use: Callable[[Path], object], tokens: tuple[bytes, ...], seeds: Callable[[], Any]
) -> Target:
    """Make a target of mutated seeds, of which one in twenty stays as it is."""

    def generate(random: Random, path: Path) -> None:
        content = choose(random, seeds())
        path.write_bytes(content if random.random() < 0.05 else mutate(content, random, (*tokens, *NUMBERS)))

    return Target(name, generate, use)


# --- atlases ---


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


ART_ENTRY = b"""Entry ID:   %s
---------------------------------------------------------------------------
Description           :  "a card"
Type                  :  reflectance spectrum
Fluorescence data     :  no
Sampling information
--------------------
Type                  :  %s
Maximum sample value  :  1.0
ASCII sample data
-----------------
{%s}
"""
ART_ENTRIES = (
    ART_ENTRY % (b"grey", b"regular\nStart : 400.0 nm\nIncrement : 100.0 nm", b"0.5, 0.25, 0.125, 0.0625"),
    ART_ENTRY % (b"other", b"point sampled", b"{380, 0.5}, {500.5, 0.1}, {720, 1}"),
)
ART_HEADER = b"ART measurement archive version 1.1\nArchive content: cards\n"
ART_SHIPPED = (ROOT / "atlases" / "macbeth.txt").read_bytes()
ART_SEEDS = (ART_HEADER + b"".join(ART_ENTRIES), *ART_ENTRIES, ART_SHIPPED[: ART_SHIPPED.index(b"Entry ID", 2000)])
ART_TOKENS = (
    b"Entry ID:", b"Type", b"reflectance spectrum", b"emission spectrum", b"regular", b"point sampled",
    b"yes", b"no",
    b"Fluorescence data", b"Maximum sample value", b"Start", b"Increment", b"Sampling information",
    b"<hr/>", b"1.2",
    b"ASCII sample data", b"{", b"}", b"{{", b"}}", b", ", b":", b"\n", b"\r", b"\t", b"\0",
    b"\xef\xbb\xbf", b"\xe2\x80\xa8",
    b"\xff", b" nm", b"{" * 999, b"\n" * 999, b"Entry ID: grey\n", b'"',
)  # fmt: skip

TABLE_ROWS = b"name,400,500,600,700\ngrey,0.5,0.25,0.125,0.0625\n\"a, 'b'\",1,0,1,0\n"
TABLE_SEEDS = (
    TABLE_ROWS,
    TABLE_ROWS.replace(b"\n", b"\r\n"),
    b"\xef\xbb\xbf" + TABLE_ROWS,
    b"nm;grey;other\n380;0,5;0,1\n500;0,25;0,2\n700;0,125;0,3\n720;0,1;0,4\n",
    b"\tred\tblue\n400 nm\t50\t1\n550 nm\t25\t2\n700 nm\t12.5\t99\n",
)
TABLE_TOKENS = (
    b",", b";", b"\t", b"\n", b"\r\n", b"\r", b'"', b'""', b"'", b"nm", b" nm", b"name", b"grey", b"400", b"700", b"\0",
    b"\xff", b"\xe2\x80\xa8", b"," * 999, b"\n" * 999, b'"' * 999, b"a" * 200_000, b"grey,0.5,0.5,0.5,0.5\n",
)  # fmt: skip

VENDOR_TOKENS = (
    b"BEGIN_DATA_FORMAT", b"END_DATA_FORMAT", b"BEGIN_DATA", b"END_DATA", b"SPECTRAL_NORM", b"SPEC_400", b"nm", b"R",
    b"##TITLE=", b"##XUNITS=", b"##NPOINTS=", b"##XYDATA=(X++(Y..Y))", b"##XYPOINTS=(XY..XY)", b"##END=", b"LINK",
    b"##DATATYPE=LINK\n", b"%J1T", b"ENVI", b"samples", b"lines", b"bands", b"data type", b"wavelength", b"{", b"}",
    b"spectra names", b"<cc:Object>", b"</cc:Object>", b"<a>" * 99, b"<!DOCTYPE a>", b"<!ENTITY a 'b'>", b"&a;",
    b'StartWL="', b'Increment="', b"<SpectralQuantity>", b"sep=|\n", b"#", b"\0", b"\xff\xfe", b"\t", b";", b",", b'"',
    b"\n", b"PK\x03\x04", b"PK\x05\x06", b"a" * 99_999,
)  # fmt: skip


@functools.cache
def _vendor_files() -> tuple[Files, ...]:
    colour_science()  # its import takes longer than a reader may
    macbeth = sample(read_atlas("macbeth"))
    return tuple(vendor.write(macbeth[: vendor.count]) for vendor in VENDORS)


def _in_archive(content: bytes, random: Random) -> bytes:
    """Mutate a file inside of an archive, whose checksums stay valid."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    name = list(parts)[random.integers(len(parts))]
    parts[name] = mutate(parts[name], random, VENDOR_TOKENS)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in parts.items():
            archive.writestr(each, data)
    return buffer.getvalue()


def _vendor_file(random: Random, path: Path) -> None:
    seeds = _vendor_files()
    (name, content), *others = seeds[random.integers(len(seeds))].items()
    if others and name.endswith(".sli"):  # the header is the file to read
        (name, content), others = others[0], [(name, content)]
    if content.startswith(b"PK") and random.random() < 0.8:
        content = _in_archive(content, random)
    elif random.random() < 0.95:
        content = mutate(content, random, VENDOR_TOKENS)
    path.write_bytes(content)
    for _, data in others:
        path.with_suffix(".sli").write_bytes(mutate(data, random, VENDOR_TOKENS) if random.random() < 0.3 else data)


# --- colours, charts, palettes, scenes, plans ---

COLOUR_SEEDS = (
    b"r,g,b\n0.1,0.2,0.3\n0.5,0.5,0.5\n",
    b"#cc3319\n#fff\n123456\n",
    b"0.1 0.2 0.3 a name\r\n1;0;1\r\n",
    b"1e308,-1e308,5e-324\n1.4,0.3,-0.1\n1e300,0.5,1e-300\n",
)
COLOUR_TOKENS = (
    b",", b";", b"\t", b" ", b"\n", b"\r", b"\r\n", b"#", b'"', b"\0", b"\xff", b"\xef\xbb\xbf", b"\xe2\x80\xa8",
    b"\xef\xbc\x91", b"0" * 70_000, b"," * 999, b"\n" * 999, b"1e999", b"5e-324", b"-1e308",
)  # fmt: skip


@functools.cache
def _cube() -> Cube:
    return load(ROOT / "cubes" / "moments-8-macbeth.uplift")


def use_colours(path: Path) -> None:
    cube = _cube()
    with path.open("rb") as file:
        for rgb in ColourReader(cube.data.sensor).parse_table(file, path.name):
            for method in METHODS[1:]:
                mapped = map_to_gamut(rgb, cube.data.sensor, method).rgb
                if not ((mapped >= 0) & (mapped <= 1)).all():
                    raise ValueError(f"{method}: colours outside [0, 1]")
            clipped = map_to_gamut(rgb, cube.data.sensor, "clip").rgb
            if not np.array_equal(clipped, np.clip(rgb, 0, 1)):
                raise ValueError("clipping changed another channel")
            if not np.isfinite(cube.reflectance(clipped[:8])).all():
                raise ValueError("reflectances that are not finite")


CHART_TOKENS = (
    b",",
    b"\n",
    b'"',
    b'""',
    b"\0",
    b"\xff",
    b"measured",
    b"not installed",
    b"_mean",
    b"_p99",
    b"x" * 200_000,
)


@functools.cache
def _chart() -> tuple[bytes]:
    """The heading, two other methods and three cubes of the shipped table."""
    text = (ROOT / "uplift" / "lab" / "chart" / "measured.csv").read_text(encoding="utf-8")
    heading, *rows = csv.reader(text.splitlines())
    first = [bool(row[heading.index("build")]) for row in rows].index(True)
    kept = io.StringIO()
    csv.writer(kept).writerows([heading, *rows[:2], *rows[first : first + 3]])
    return (kept.getvalue().encode(),)


def use_chart(path: Path) -> None:
    """Compute what pictures of the chart show, and recommend a cube."""
    chart = read_chart(path)
    for panel in all_panels(chart):
        for result in panel.front(chart):
            panel.labels(result)
            if panel.whiskers:
                panel.whisker(result)
    recommend_cube(chart, Requirement(time_ns=1e5))


PALETTE_SEEDS = tuple(
    (SAMPLES / f"{name}.toml").read_bytes().replace(b"paints.csv", bytes(SAMPLES / "paints.csv"))
    for name in ("constant", "engine", "light", "metamers", "vanish")
)
PALETTE_TOKENS = (
    b"lights", b"materials", b"colours", b"free", b"apart", b"design", b"bounds", b"illuminant", b"planck",
    b"luminance", b"atlas", b"entry", b"rgb", b"cube", b"weight", b"low", b"high", b"smoothness", b"model-error",
    b"coefficients", b"delta-e", b"day", b"lamp", b"true", b"false", b"#808080", b"[0.5, 0.2, 0.1]", b"D65",
    b"FL11", b"[", b"]", b"{", b"}", b"[[", b"=", b",", b'"', b"'", b"\n", b"\0", b"\xff", b"#", b"[" * 100_000,
    b"a." * 2000,
)  # fmt: skip


@functools.cache
def _model(count: int) -> FactorModel:
    return standard_model(observer.sensor(), count)


def use_palette(path: Path) -> None:
    """Design the palette. Raises `UpliftError` for invalid files, ValueError for invalid spectra."""
    palette = read_palette(path)
    result = design(palette, _model(palette.count))
    matrix(result)
    if not (np.isfinite(result.powers).all() and np.isfinite(result.reflectances).all()):
        raise ValueError("spectra that are not finite")


ATLAS, TEXTURE = ROOT / "atlases" / "macbeth.txt", ROOT / "docs" / "plan" / "page.png"
SCENE_FILE = f"""# a kitchen
textures = ["{TEXTURE}", "{TEXTURE.parent}/*.png"]
atlases = "{ATLAS}"
lights = ["D65", "FL11"]
tolerance = 0.5
quantile = 0.9
""".encode()
SCENE_TOKENS = (
    b"textures", b"atlases", b"lights", b"tolerance", b"quantile", b"encoding", b"space", b"illuminant", b"observer",
    b"format", b"scene", b"build", b"cells", b"path", b"digest", b"dim", b"axis", b"coefficients", b"D65", b"sRGB",
    b"..", b"/", b"*", b"**", b"[", b"]", b"{", b"}", b"[[", b"=", b":", b",", b'"', b"'", b'"""', b"\\", b"\\u0000",
    b"true", b"null", b"\n", b"\0", b"\xff", b"#", b"[" * 100_000, b'{"a":' * 20_000, b"a." * 2000,
)  # fmt: skip


@functools.cache
def _plan() -> tuple[bytes]:
    """Make the part of a plan that its reader uses."""
    texture, atlas = ([{"path": str(path), "digest": file_digest(path)}] for path in (TEXTURE, ATLAS))
    plan = {
        "format": FORMAT,
        "scene": {"encoding": "auto", "textures": texture, "atlases": atlas},
        "build": dataclasses.asdict(Options(dim=8)),
        "cells": "sparse",
    }
    return (json.dumps(plan, indent=40).encode(),)  # mostly blanks, so that some mutations leave it valid


# --- options of a build ---

FIELDS = [field.name for field in dataclasses.fields(Options)]
LITERALS = (
    "nan", "inf", "-inf", "1e999", "1e308", "5e-324", "1e-12", "-1", "0", "1", "2", "9", "17", "64", "0.1", "0.5",
    "true", "null", "[]", "{}", '"auto"', '"D65"', '["D65"]', '["D65", "A"]', '["D65", 3]', '"srgb"', '"linear"',
    '"moments"', '"sigmoid"', '"none"', '"vision"', '"\\u0000"', '"\\ud800"', "9" * 400, "9" * 5000,
)  # fmt: skip
TYPES = (np.float32, np.float64, np.int64, np.bool_, complex)
"""Types that callers of the library may pass."""


def _options(random: Random, path: Path) -> None:
    names = random.choice(FIELDS, size=int(random.integers(1, 3)), replace=False)
    values = [LITERALS[random.integers(len(LITERALS))] for _ in names]
    types = [int(random.integers(3 * len(TYPES))) for _ in names]
    lines = [f"{name}\t{kind}\t{value}" for name, value, kind in zip(names, values, types, strict=True)]
    path.write_text("\n".join(lines), encoding="utf-8")


def _parse(value: str, kind: int) -> Any:
    try:
        parsed = json.loads(value)
    except ValueError:  # numbers that JSON or Python does not have
        parsed = float(value) if len(value) < 4300 else 10**5000
    if kind < len(TYPES) and isinstance(parsed, int | float):
        try:
            with np.errstate(all="ignore"):
                return TYPES[kind](parsed)
        except (OverflowError, ValueError):
            return parsed
    return tuple(parsed) if isinstance(parsed, list) else parsed


def use_options(path: Path) -> None:
    """Create the options; those that are accepted must be JSON values and be the same when read back."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").split("\n")]
    options = Options(**{name: _parse(value, int(kind)) for name, kind, value in rows})
    check_memory(options)
    recorded = json.loads(json.dumps(dataclasses.asdict(options), allow_nan=False))
    if Options(**{**recorded, "lights": tuple(recorded["lights"])}) != options:
        raise ValueError("other options when read back")


TARGETS = (
    text_target("atlas text", use_atlas, ART_TOKENS, lambda: ART_SEEDS),
    text_target("atlas table", use_atlas, TABLE_TOKENS, lambda: TABLE_SEEDS),
    Target("atlas of an instrument", _vendor_file, use_atlas),
    text_target("colour table", use_colours, COLOUR_TOKENS, lambda: COLOUR_SEEDS),
    text_target("chart table", use_chart, CHART_TOKENS, _chart),
    text_target("palette", use_palette, PALETTE_TOKENS, lambda: PALETTE_SEEDS),
    text_target("scene file", lambda path: read_scene_file(path).light_sources(), SCENE_TOKENS, lambda: (SCENE_FILE,)),
    text_target("plan", read_plan, SCENE_TOKENS, _plan),
    Target("build options", _options, use_options),
)
