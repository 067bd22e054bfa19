"""Mixing models: assumed scattering, times and pictures, and criteria, for
docs/mixing.md.
"""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from operator import itemgetter
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, Row, read_reference, record
from benchmarks.painters import SHARES, criteria
from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.pages.plots import Strip, plot_strips
from uplift.extras.paint import dispersive
from uplift.extras.paint.coats import ramp
from uplift.extras.paint.pigments import (
    CONSTANT,
    SQUARE_ROOT,
    Pigment,
    PowerOfReflectance,
    Scattering,
    from_opaque,
)
from uplift.extras.paint.theories import mixers, spectral_models
from uplift.lab.timing import TimingStats, time_laps
from uplift.lookup import Cube

BLUES = ("ultramarine", "cobalt", "cerulean", "phthalo blue")
ARTISTS = ("#002185", "#fcd200")
"""Cobalt blue and Hansa yellow, as Mixbox's table has them."""
MIXTURES = 20_000
LAP = 0.02
"""Shortest duration of a run in seconds."""
RUNS = 5
CHECKED = 20
PAIRS = {
    "blue-yellow": ("#005fa0", "#ffd200"),
    "atlas-blue-yellow": ("blue", "yellow"),
    "red-white": ("#b01030", "#ffffff"),
    "red-green": ("#d02020", "#20a040"),
}
"""Names of entries, or codes."""
STEPS = 11
DRAWN = (
    "pigments", "pigments in oil", "pigments, S = √R", "pigments, S = 1", "dyes",
    "average", "ryb", "phosphors",
    "product",
)  # fmt: skip
"""Shares are the thickness of filters and products, so that a ramp ends at its colours.
"""


# --- rules for S on mixtures of known paints ---


@dataclass(frozen=True, eq=False)
class Mixtures:
    """Colours in linear RGB of n mixtures of two paints.

    ``paints`` (p, 3): colours of the paints.
    ``pairs`` (n, 2): indices of the paints of each mixture.
    ``shares`` (n, 2): their shares.
    ``expected`` (n, 3): measured colours.
    """

    paints: Array
    pairs: Array
    shares: Array
    expected: Array


def acrylics(first: tuple[str, ...] = ("",), second: str = "") -> Mixtures:
    """Return the mixtures of paint_mixtures.csv.

    Only those of a paint whose name starts with one of ``first`` with a paint whose
    name ends in ``second``; by default all.
    """
    paints = []
    kept = []
    mixed = []
    for row in read_reference("paint_mixtures.csv"):
        pair = row["first"], row["second"]
        if pair[0] == pair[1]:
            paints.append(row)
        elif any(
            name.startswith(first) and other.endswith(second)
            for name, other in (pair, pair[::-1])
        ):
            kept.append(row)
            mixed.append(pair)
    names = [paint["first"] for paint in paints]
    pairs = [list(map(names.index, pair)) for pair in mixed]
    return Mixtures(
        _numbers(paints, "rgb"), np.array(pairs), _shares(kept), _numbers(kept, "rgb")
    )


def three_bands(name: str) -> Mixtures:
    """Return the mixtures of all pairs of a set of paints_rgb.csv, whose three bands
    are taken as linear RGB.
    """
    rows = [row for row in read_reference("paints_rgb.csv") if row["set"] == name]
    K = _numbers(rows, ("Kr", "Kg", "Kb"))
    S = _numbers(rows, ("Sr", "Sg", "Sb"))
    pairs = np.array(list(itertools.combinations(range(len(K)), 2)))
    mixtures = [
        Pigment(K[pairs], S[pairs]).mix(share).opaque_reflectance() for share in SHARES
    ]
    return Mixtures(
        Pigment(K, S).opaque_reflectance(),
        np.concatenate([pairs] * len(SHARES)),
        np.repeat(SHARES, len(pairs), axis=0),
        np.concatenate(mixtures),
    )


def published(tool: str, cube: Cube) -> Mixtures:
    """Return the mixtures that a tool publishes (published_mixtures.csv)."""
    kept = [
        row for row in read_reference("published_mixtures.csv") if row["tool"] == tool
    ]
    paints = []
    for row in kept:
        paints += [colour(cube, row["first"]), colour(cube, row["second"])]
    expected = [colour(cube, row["mixture"]) for row in kept]
    pairs = np.arange(len(paints)).reshape(-1, 2)
    return Mixtures(np.array(paints), pairs, _shares(kept), np.array(expected))


def colour(cube: Cube, word: str) -> Array:
    """Return the linear RGB (3,) of an entry or of '#rrggbb'."""
    if word.startswith("#"):
        return cube.decode(list(bytes.fromhex(word[1:])))
    return cube.data.atlas.rgb[cube.data.atlas.names.index(word)]


def _numbers(rows: list[dict[str, str]], columns: Sequence[str]) -> Array:
    return np.array(list(map(itemgetter(*columns), rows)), float)


def _shares(rows: list[dict[str, str]]) -> Array:
    share = _numbers(rows, ["share"])
    return np.stack([1 - share, share], axis=1)


def mix(cube: Cube, mixtures: Mixtures, rule: Scattering | None) -> Array:
    """Return the colours (n, 3) of mixtures from those of their paints, in linear RGB
    in [0, 1]; None averages RGB.
    """
    if rule is None:
        return (mixtures.shares[:, None] @ mixtures.paints[mixtures.pairs])[:, 0]
    paints = from_opaque(cube.reflectance(mixtures.paints), rule)
    pairs = Pigment(
        paints.absorption[mixtures.pairs], paints.scattering[mixtures.pairs]
    )
    mixed = pairs.mix(mixtures.shares).opaque_reflectance()
    return np.clip(cube.data.sensor.rgb(mixed), 0, 1)


def compare_scattering(smooth: Cube, atlas: Cube) -> Row:
    """Compare rules for S on the measured sets and on published mixtures, uplifted by
    ``smooth``.

    ``atlas`` is the cube that uplifts the ColorChecker's blue and yellow.
    """
    best = dispersive(smooth.data.sensor)
    rules = {
        "mean of linear RGB": None,
        "1": CONSTANT,
        "R^½": SQUARE_ROOT,
        "R^¾": PowerOfReflectance(0.75),
        "R^0.9": PowerOfReflectance(0.9),
        "Y^½": replace(best, exponent=0.5, weight=0.0),
        "Y^¾": replace(best, weight=0.0),
        "Y": replace(best, exponent=1.0, weight=0.0),
        "Y^½ exp(h / 4)": replace(best, exponent=0.5),
        "Y^¾ exp(h / 4)": best,
        "Y exp(h / 4)": replace(best, exponent=1.0),
    }
    sets = {
        "acrylics": acrylics(),
        "blues": acrylics(BLUES, "yellow"),
        "watercolours": three_bands("curtis1997"),
        "photographed": three_bands("lindemeier2020"),
        "mixbox": published("mixbox", smooth),
    }
    rows = []
    for title, rule in rules.items():
        row = {"rule": title}
        for name, mixtures in sets.items():
            mixed = mix(smooth, mixtures, rule)
            delta_e = delta_e_rgb(smooth.data.sensor, mixtures.expected, mixed)
            rms = np.sqrt(np.mean((mixed - mixtures.expected) ** 2))
            row[name] = {"delta_e": delta_e.mean(), "rms": rms}
        row["artists"] = _greens(smooth, ARTISTS, rule)
        row["patches"] = _greens(atlas, ("blue", "yellow"), rule)
        rows.append(row)
    return {
        "scatterings": rows,
        "set_sizes": {name: len(mixtures.pairs) for name, mixtures in sets.items()},
    }


def _greens(cube: Cube, words: Sequence[str], rule: Scattering | None) -> Iterator[Row]:
    """Mix a blue and a yellow at 1:3, 1:1 and 3:1."""
    paints = np.array([colour(cube, word) for word in words])
    mixtures = Mixtures(paints, np.array([[0, 1]] * 3), SHARES[::-1], np.empty(0))
    for rgb in mix(cube, mixtures, rule):
        code = "#" + bytes(np.rint(cube.encode(rgb)).astype(np.uint8)).hex()
        yield {"green": rgb[1] > max(rgb[0], rgb[2]) + 0.01, "code": code}


# --- pictures ---


def draw(cube: Cube, smooth: Cube, folder: Path) -> None:
    """Write a picture for each pair of colours, and one of other tools."""
    folder.mkdir(exist_ok=True)
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    parts = ramp(np.ones(2), STEPS)
    for name, pair in PAIRS.items():
        rgb = np.array([colour(cube, word) for word in pair])
        drawn = [by_name[mixer] for mixer in DRAWN]
        strips = {mixer.title: mixer.mix(rgb, parts) for mixer in drawn}
        _plot(cube, strips, folder / f"{name}.png")
    _plot(smooth, _tools(smooth), folder / "tools.png")


def _plot(cube: Cube, strips: dict[str, Array], path: Path) -> None:
    drawn = [
        Strip(title, to_display_codes(rgb, cube.data.sensor) / 255)
        for title, rgb in strips.items()
    ]
    plot_strips(drawn, path, force=True)


def _tools(cube: Cube) -> dict[str, Array]:
    """Return the ramp of two artists' paints by RGB, by us, and by other tools."""
    steps = published("coloraide", cube)
    mixbox = published("mixbox", cube).expected[:1]
    ends = steps.paints[:2]
    parts = np.concatenate([[[1, 0]], steps.shares, [[0, 1]]])
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    return {
        "mean of sRGB codes": np.clip(cube.decode(parts @ cube.encode(ends)), 0, 1),
        "uplift mix --scattering root": by_name["pigments, S = √R"].mix(ends, parts),
        "uplift mix": by_name["pigments"].mix(ends, parts),
        "coloraide's spectral, after spectral.js (published)": np.concatenate(
            [ends[:1], steps.expected, ends[1:]]
        ),
        "Mixbox 1:1 (published)": np.concatenate([ends[:1], mixbox, ends[1:]]),
    }


# --- times ---


def mixture_times(cube: Cube) -> Iterator[Row]:
    """Yield nanoseconds per mixture of two, from RGB to RGB and between spectra."""
    rng = np.random.default_rng(0)
    rgb = rng.random((MIXTURES, 2, 3))
    parts = rng.random((MIXTURES, 2)) + 0.1
    spectra = cube.reflectance(rgb)
    spectral_mixers = spectral_models(cube.data.sensor)
    for mixer in mixers(cube):
        checked = rgb[:CHECKED], parts[:CHECKED]
        if not np.allclose(
            mixer.mix(*checked), list(map(mixer.mix, *checked)), 0, 1e-9
        ):
            raise RuntimeError(f"{mixer.title}: wrong result, nothing to time")
        times = _nanoseconds(mixer.mix, rgb, parts)
        between = spectral_mixers.get(mixer.name)
        of_spectra = between and _nanoseconds(between[1], spectra, parts)
        yield {"mixer": mixer.title, "rgb": times, "spectra": of_spectra}


def _nanoseconds(
    mix: Callable[[Array, Array], Array], colours: Array, parts: Array
) -> TimingStats:
    call = partial(mix, colours, parts)
    return time_laps(call, LAP, RUNS).scaled(1e9 / MIXTURES)


def main() -> None:
    """Measure, draw and store."""
    cube = uplift.load(CUBES / "moments-16-macbeth.uplift")
    smooth = uplift.load()
    draw(cube, smooth, DOCS / "mixing")
    record(
        "mixing",
        **criteria(cube),
        **compare_scattering(smooth, cube),
        runs=RUNS,
        mixtures=MIXTURES,
        mixture_times=mixture_times(cube),
    )
