"""The exported mixer of RGB: rates in C and JavaScript, errors and ramps, for
docs/guides/mixer.md.
"""

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

import uplift
from benchmarks import DOCS, ROOT, Row, record
from benchmarks.mixing import (
    ARTISTS,
    BLUES,
    Mixtures,
    acrylics,
    colour,
    mix,
    published,
    three_bands,
)
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import decode, encode, hex_codes, to_display_codes
from uplift.extras.pages.plots import Strip, plot_strips
from uplift.extras.paint import dispersive
from uplift.extras.paint.bands import REALISED
from uplift.extras.paint.mixer_programs import write_mixer
from uplift.extras.paint.pigments import from_opaque
from uplift.extras.paint.rgb_mixer import DIM, RgbMixer, make_mixer
from uplift.lab.timing import environment
from uplift.lookup import Cube

COMPILERS = ("gcc", "clang")
FLAGS = {
    "vectorised": ("-O3", "-march=x86-64-v3", "-fno-math-errno"),
    "with errno": ("-O3", "-march=x86-64-v3"),
    "plain": ("-O2",),
}
PAIRS = 20_000
"""As in mixer.c."""
RUNS = 25
JUDGED = 4000
"""Random pairs that are compared with spectra."""
DIMS = (9, 17, 33)
MODULE = """
import { readFileSync } from "node:fs";
import { mix } from "./paint.mjs";
const numbers = new Float32Array(new Uint8Array(readFileSync("pairs")).buffer);
const pairs = Array.from({ length: numbers.length / 6 }, (_, i) =>
  [Array.from(numbers.subarray(6 * i, 6 * i + 3)),
   Array.from(numbers.subarray(6 * i + 3, 6 * i + 6)), (i % 100) / 99]);
let best = Infinity;
let sum = 0;
for (let run = 0; run < RUNS; ++run) {
  const begin = performance.now(); // CPU times count the compiler's threads
  for (const pair of pairs) sum += mix(pair[0], pair[1], pair[2])[0];
  best = Math.min(best, performance.now() - begin);
}
console.log((best * 1e-3) / pairs.length, sum > 0);
"""
RAMPS = (
    ("cobalt blue and Hansa yellow", ARTISTS),
    ("red and white", ("#b01030", "#ffffff")),
    ("blue and red", ("#002185", "#ff2702")),
    ("green and purple", ("#20a040", "#803090")),
)
STEPS = 13

MixRgb = Callable[[Mixtures], Array]
"""From mixtures to their linear RGB (n, 3)."""


# --- rates ---


def rates(cube: Cube) -> Row:
    """Return millions of mixtures a second by compiler and flags, and of Node.js, and
    the sizes of files by suffix.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rgb = decode(np.random.default_rng(1).random((PAIRS, 6)))
        write_mixer(cube, folder / "paint.h")
        write_mixer(cube, folder / "paint.mjs", style="mixer-js")
        write_mixer(cube, folder / "paint.glsl", style="mixer-glsl")
        sizes = {path.suffix[1:]: path.stat().st_size for path in folder.iterdir()}
        rgb.astype(np.float32).tofile(folder / "pairs")
        return {"c": list(_c_rates(folder)), "js": _js_rate(folder), "sizes": sizes}


def _c_rates(folder: Path) -> Iterator[Row]:
    source = ROOT / "benchmarks" / "mixer.c"
    for compiler in filter(shutil.which, COMPILERS):
        version = _output([compiler, "--version"], folder).splitlines()[0]
        for name, flags in FLAGS.items():
            command = [compiler, *flags, "-I.", str(source), "-o", "rates", "-lm"]
            subprocess.run(command, cwd=folder, check=True)
            printed = _output(["./rates", "pairs", str(RUNS)], folder).split()
            mix, srgb, codes, brush = (1e-6 / float(seconds) for seconds in printed)
            yield {
                "compiler": version,
                "flags": " ".join(flags),
                "kind": name,
                "mix": mix,
                "mix_srgb": srgb,
                "mix_bytes": codes,
                "brush": brush,
            }


def _js_rate(folder: Path) -> Row:
    (folder / "rates.mjs").write_text(MODULE.replace("RUNS", str(RUNS)))
    seconds, _ = _output(["node", "rates.mjs"], folder).split()
    version = _output(["node", "--version"], folder).strip()
    return {"version": version, "mix": 1e-6 / float(seconds)}


def _output(command: list[str], folder: Path) -> str:
    return subprocess.check_output(command, cwd=folder, text=True)


# --- errors ---


def random_mixtures(cube: Cube) -> tuple[Mixtures, Array]:
    """Return mixtures of random pairs of colours, even in codes, by spectra, and their
    colours before they are clipped to [0, 1].

    Pairs with a colour that no reflectance has are left out.
    """
    sensor = cube.data.sensor
    random = np.random.default_rng(2)
    pairs = decode(random.random((JUDGED, 2, 3)))
    spectra = cube.reflectance(pairs)
    missed = np.abs(sensor.rgb(spectra) - pairs).max(axis=(1, 2))
    kept = missed < REALISED
    share = random.random(JUDGED)[kept]
    shares = np.stack([1 - share, share], axis=1)
    paints = from_opaque(spectra[kept], dispersive(sensor))
    rgb = sensor.rgb(paints.mix(shares).opaque_reflectance())
    numbers = np.arange(2 * kept.sum()).reshape(-1, 2)
    paint_colours = pairs[kept].reshape(-1, 3)
    return Mixtures(paint_colours, numbers, shares, np.clip(rgb, 0, 1)), rgb


def by_mixer(mixer: RgbMixer) -> MixRgb:
    return lambda mixtures: mixer.mix_all(
        np.clip(mixtures.paints[mixtures.pairs], 0, 1), mixtures.shares
    )


def mean_codes(mixtures: Mixtures) -> Array:
    """Mix codes of the curve of sRGB."""
    codes = encode(mixtures.paints[mixtures.pairs])
    return decode((mixtures.shares[:, None] @ codes)[:, 0])


def of_spectra(cube: Cube, dims: tuple[int, ...]) -> Row:
    """Compare mixers with tables of several sizes with mixtures of whole spectra."""
    mixtures, unclipped = random_mixtures(cube)
    outside = np.maximum(unclipped - 1, -unclipped).max(axis=1)
    rows = []
    for dim in dims:
        mixer = make_mixer(cube, dim)
        errors = _errors(cube, mixtures, by_mixer(mixer))
        rows.append(_summary(errors) | {"dim": dim, "kB": mixer.table.nbytes / 1e3})
    averages = _errors(cube, mixtures, lambda given: mix(cube, given, None))
    return {
        "pairs": len(mixtures.pairs),
        "outside": np.mean(outside > 0),
        "furthest": outside.max(),
        "tables": rows,
        "average": _summary(averages),
    }


def _errors(cube: Cube, mixtures: Mixtures, mix_rgb: MixRgb) -> Array:
    return delta_e_rgb(cube.data.sensor, mixtures.expected, mix_rgb(mixtures))


def _summary(errors: Array) -> Row:
    return {
        "mean": errors.mean(),
        "p95": np.quantile(errors, 0.95),
        "largest": errors.max(),
    }


def of_paints(cube: Cube, mixer: RgbMixer) -> Row:
    """Compare ways of mixing with mixtures of known paints and published ones."""
    rule = dispersive(cube.data.sensor)
    ways: dict[str, MixRgb] = {
        "exported mixer": by_mixer(mixer),
        "`uplift mix`, whole spectra": lambda given: mix(cube, given, rule),
        "mean of linear RGB": lambda given: mix(cube, given, None),
        "mean of sRGB codes": mean_codes,
    }
    sets = {
        "acrylics": acrylics(),
        "blues": acrylics(BLUES, "yellow"),
        "watercolours": three_bands("curtis1997"),
        "photographed": three_bands("lindemeier2020"),
        "mixbox": published("mixbox", cube),
        "coloraide": published("coloraide", cube),
    }
    rows = []
    for title, way in ways.items():
        errors = {
            name: _errors(cube, mixtures, way).mean() for name, mixtures in sets.items()
        }
        green = way(_pair(cube, ARTISTS, np.array([0.5])))
        (code,) = hex_codes(green, cube.data.sensor)
        rows.append({"way": title, "green": code} | errors)
    return {
        "ways": rows,
        "set_sizes": {name: len(mixtures.pairs) for name, mixtures in sets.items()},
    }


def _pair(cube: Cube, words: tuple[str, ...], share: Array) -> Mixtures:
    """Return mixtures of two colours by shares of the second."""
    paints = np.array([colour(cube, word) for word in words])
    numbers = np.array([[0, 1]] * len(share))
    return Mixtures(paints, numbers, np.stack([1 - share, share], 1), np.empty(0))


# --- pictures ---


def draw(cube: Cube, mixer: RgbMixer, path: Path) -> None:
    """Write ramps between pairs of colours: mean of codes, mixer, and spectra."""
    rule = dispersive(cube.data.sensor)
    ways: dict[str, MixRgb] = {
        "mean of sRGB codes": mean_codes,
        "exported mixer": by_mixer(mixer),
        "uplift mix": lambda given: mix(cube, given, rule),
    }
    strips = []
    for pair, words in RAMPS:
        mixtures = _pair(cube, words, np.linspace(0, 1, STEPS))
        for title, way in ways.items():
            codes = to_display_codes(way(mixtures), cube.data.sensor) / 255
            strips.append(Strip(f"{pair}: {title}", codes))
    plot_strips(strips, path, force=True)


def main() -> None:
    """Measure, draw and store."""
    cube = uplift.load()
    mixer = make_mixer(cube)
    draw(cube, mixer, DOCS / "mixing" / "mixer.png")
    record(
        "mixer",
        environment=environment(),
        dim=DIM,
        rates=rates(cube),
        spectra=of_spectra(cube, DIMS),
        wide=of_spectra(uplift.load("acescg"), (DIM,)),
        **of_paints(cube, mixer),
    )
