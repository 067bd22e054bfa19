"""Fuzz targets of the readers of text: seeds of the format, and what is done with a file that is accepted."""

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
from tests.fuzz.campaign import ROOT, Target
from tests.fuzz.mutate import Random, Seeds, choose, mutate
from uplift.atlas import read_atlas, resample, write_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.gamut import METHODS, map_to_gamut
from uplift.common.colour_science import colour_science
from uplift.common.errors import UpliftError
from uplift.design.palette import design, matrix, read_palette, standard_model
from uplift.design.palette.factor import FactorModel
from uplift.io.scene_colours import file_digest
from uplift.lab.chart.table import Requirement, all_panels, read_chart, recommend_cube
from uplift.lookup import Cube, load
from uplift.pipeline.options import Options, check_memory
from uplift.scene.plan import read_scene_file
from uplift.scene.plan.plan_file import FORMAT, read_plan

SAMPLES = ROOT / "uplift" / "samples" / "files"
GRID = np.arange(380.0, 781.0, 5.0)


def text_target(name: str, use: Callable[[Path], object], seeds: Callable[[], Seeds]) -> Target:
    """Make a target of mutated seeds, of which one in twenty stays as it is."""

    def generate(random: Random, path: Path) -> None:
        content = choose(random, seeds())
        path.write_bytes(content if random.random() < 0.05 else mutate(content, random, seeds()))

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


ART_ENTRY = """Entry ID:   %s
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
REGULAR = ("regular\nStart : 400.0 nm\nIncrement : 100.0 nm", "0.5, 0.25, 0.125, 0.0625")
SAMPLED = ("point sampled", "{380, 0.5}, {500.5, 0.1}, {720, 1}")
ART_ENTRIES = tuple((ART_ENTRY % (name, *rest)).encode() for name, *rest in (("grey", *REGULAR), ("other", *SAMPLED)))
ART_HEADER = b"ART measurement archive version 1.1\nArchive content: cards\n"
ART_SHIPPED = (ROOT / "atlases" / "macbeth.txt").read_bytes()
ART_SEEDS = (ART_HEADER + b"".join(ART_ENTRIES), *ART_ENTRIES, ART_SHIPPED[: ART_SHIPPED.index(b"Entry ID", 2000)])
TABLE_ROWS = b"name,400,500,600,700\ngrey,0.5,0.25,0.125,0.0625\n\"a, 'b'\",1,0,1,0\n"
TABLE_SEEDS = (
    TABLE_ROWS,
    TABLE_ROWS.replace(b"\n", b"\r\n"),
    b"\xef\xbb\xbf" + TABLE_ROWS,
    b"nm;grey;other\n380;0,5;0,1\n500;0,25;0,2\n700;0,125;0,3\n720;0,1;0,4\n",
    b"\tred\tblue\n400 nm\t50\t1\n550 nm\t25\t2\n700 nm\t12.5\t99\n",
)


@functools.cache
def _vendor_files() -> tuple[Files, ...]:
    colour_science()  # its import takes longer than a reader may
    macbeth = sample(read_atlas("macbeth"))
    return tuple(vendor.write(macbeth[: vendor.count]) for vendor in VENDORS)


def _in_archive(content: bytes, random: Random) -> bytes:
    """Mutate a file inside of an archive, whose checksums stay valid."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    name = choose(random, list(parts))
    changed = parts | {name: mutate(parts[name], random, tuple(parts.values()))}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for each, data in changed.items():
            archive.writestr(each, data)
    return buffer.getvalue()


def _vendor_file(random: Random, path: Path) -> None:
    files = choose(random, _vendor_files())
    seeds = tuple(content for each in _vendor_files() for content in each.values())
    spectra = [data for name, data in files.items() if name.endswith(".sli")]  # the header is the file to read
    (content,) = [data for name, data in files.items() if not name.endswith(".sli")]
    if content.startswith(b"PK") and random.random() < 0.8:
        content = _in_archive(content, random)
    elif random.random() < 0.95:
        content = mutate(content, random, seeds)
    path.write_bytes(content)
    for data in spectra:
        path.with_suffix(".sli").write_bytes(mutate(data, random, seeds) if random.random() < 0.3 else data)


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


@functools.cache
def _chart() -> Seeds:
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
encoding = "auto"
space = "sRGB"
illuminant = "D65"
""".encode()


@functools.cache
def _plan() -> Seeds:
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
    values = [choose(random, LITERALS) for _ in names]
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
    text_target("atlas text", use_atlas, lambda: ART_SEEDS),
    text_target("atlas table", use_atlas, lambda: TABLE_SEEDS),
    Target("atlas of an instrument", _vendor_file, use_atlas),
    text_target("colour table", use_colours, lambda: COLOUR_SEEDS),
    text_target("chart table", use_chart, _chart),
    text_target("palette", use_palette, lambda: PALETTE_SEEDS),
    text_target("scene file", lambda path: read_scene_file(path).light_sources(), lambda: (SCENE_FILE,)),
    text_target("plan", read_plan, _plan),
    Target("build options", _options, use_options),
)
