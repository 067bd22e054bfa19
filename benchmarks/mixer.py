"""The exported mixer of RGB: rates in C and JavaScript, errors by size of the table,
and ramps, for docs/guides/mixer.md.
"""

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, Row, summary
from benchmarks.mixing import ARTISTS, DEFAULT, ways
from benchmarks.mixtures import Mixtures, by_spectra, draw_ramps, of_pairs, ramp_between
from benchmarks.programs import compile_c, numbers, program_version
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import decode
from uplift.extras.paint.bands import REALISED
from uplift.extras.paint.mixer_programs import write_mixer
from uplift.extras.paint.optics import average_areas
from uplift.extras.paint.pigments import dispersive
from uplift.extras.paint.rgb_mixer import DIM, make_mixer
from uplift.lookup.cube import Cube

FOLDER = Path(__file__).parent
COMPILERS = ("gcc", "clang")
FLAGS = (
    ("-O3", "-march=x86-64-v3", "-fno-math-errno"),
    ("-O3", "-march=x86-64-v3"),
    ("-O2",),
)
PAIRS = 20_000
"""As in mixer.c."""
FUNCTIONS = ("mix", "mix_srgb", "mix_bytes", "brush")
"""In the order of mixer.c."""
RUNS = 25
JUDGED = 4000
"""Random pairs that are compared with spectra."""
DIMS = (9, DIM, 33)
RAMPS = {
    "cobalt blue and Hansa yellow": ARTISTS,
    "red and white": ("#b01030", "#ffffff"),
    "blue and red": ("#002185", "#ff2702"),
    "green and purple": ("#20a040", "#803090"),
}
DRAWN = {
    "mean of sRGB codes": "mean of sRGB codes",
    "exported mixer": "exported mixer",
    DEFAULT: "uplift paints mix",
}
"""Ways of mixing, and their titles."""
STEPS = 13


def rates() -> Iterator[Row]:
    """Yield millions of mixtures a second by compiler and flags, and of Node.js."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rgb = decode(np.random.default_rng(1).random((PAIRS, 6)))
        pairs = folder / "pairs"
        rgb.astype(np.float32).tofile(pairs)
        header = folder / "paint.h"
        write_mixer(uplift.load(), header)
        for compiler in filter(shutil.which, COMPILERS):
            for flags in FLAGS:
                program = compile_c(
                    FOLDER / "mixer.c", folder, *flags, compiler=compiler
                )
                seconds = numbers(program, pairs, str(RUNS))
                millions = [1e-6 / each for each in seconds]
                yield {
                    "program": program_version(compiler),
                    "flags": " ".join(flags),
                    "bytes": header.stat().st_size,
                    **dict(zip(FUNCTIONS, millions, strict=True)),
                }
        write_mixer(uplift.load(), folder / "paint.mjs", style="mixer-js")
        shutil.copy(FOLDER / "mixer.mjs", folder)
        (seconds,) = numbers("node", folder / "mixer.mjs", pairs, str(RUNS))
        version = f"Node.js {program_version('node')}"
        yield {"program": version, "flags": "", "mix": 1e-6 / seconds}


def random_mixtures(cube: Cube) -> tuple[Mixtures, Array]:
    """Return mixtures of random pairs of colours, even in codes, by spectra, and their
    colours before they are clipped to [0, 1].

    Pairs with a colour that no reflectance has are left out.
    """
    sensor = cube.data.sensor
    random = np.random.default_rng(2)
    pairs = decode(random.random((JUDGED, 2, 3)))
    missed = np.abs(sensor.rgb(cube.reflectance(pairs)) - pairs).max(axis=(1, 2))
    kept = missed < REALISED
    share = random.random(JUDGED)[kept]
    shares = np.stack([1 - share, share], axis=1)
    rgb = by_spectra(cube, dispersive(sensor))(pairs[kept], shares)
    return of_pairs(pairs[kept], shares, np.clip(rgb, 0, 1)), rgb


def errors() -> Iterator[Row]:
    """Yield the errors of random mixtures by the mean of linear RGB, and by tables of
    several sizes and of a wide gamut.
    """
    for name, dims in (("srgb", DIMS), ("acescg", (DIM,))):
        cube = uplift.load(name)
        sensor = cube.data.sensor
        mixtures, _ = random_mixtures(cube)
        mean = mixtures.errors(average_areas, sensor)
        yield {"cube": name, "nodes": None, **summary(mean)}
        for dim in dims:
            mixer = make_mixer(cube, dim)
            mixed = mixtures.errors(mixer.mix_all, sensor)
            yield {
                "cube": name,
                "nodes": dim,
                "kB": mixer.table.nbytes / 1e3,
                **summary(mixed),
            }


def clipped() -> Row:
    """Return the share of random mixtures that leave the gamut, and how far."""
    _, rgb = random_mixtures(uplift.load())
    outside = np.maximum(rgb - 1, -rgb).max(axis=1)
    return {"share": (outside > 0).mean(), "furthest": outside.max()}


def ramps() -> None:
    """Draw ramps between pairs of colours."""
    mixers = ways(uplift.load())
    drawn = {}
    for pair, codes in RAMPS.items():
        for way, title in DRAWN.items():
            drawn[f"{pair}: {title}"] = ramp_between(*codes, mixers[way], STEPS)
    draw_ramps(drawn, DOCS / "mixing" / "mixer.png")


QUESTIONS = {
    "rates": rates,
    "errors": errors,
    "clipped": clipped,
    "ramps": ramps,
}
