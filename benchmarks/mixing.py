"""Mixing models: criteria, assumed scattering, times and pictures, for docs/mixing.md."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, REFERENCE, record
from benchmarks.mixing_criteria import CRITERIA, SHARES, evaluate
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import colour_science
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.design.mixing import Ingredients, Medium, dispersive, make_coat, optics, overpainter, pigments
from uplift.design.mixing.coats import ramp
from uplift.design.mixing.pigments import CONSTANT, SQUARE_ROOT, Pigment, PowerOfReflectance, Scattering, from_opaque
from uplift.design.mixing.theories import hsl_to_rgb, mixers, spectral_models
from uplift.lab.timing import Spread, time_calls
from uplift.lookup import Cube
from uplift.viz.plots import Strip, plot_strips

BLUES = ("ultramarine", "cobalt", "cerulean", "phthalo blue")


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

    @property
    def components(self) -> Array:
        """Colours (n, 2, 3) of both paints of each mixture."""
        return np.asarray(self.paints[self.pairs])


def acrylics(first: tuple[str, ...] = (), second: str = "") -> Mixtures:
    """Return the mixtures of paint_mixtures.csv.

    Only those of a paint whose name starts with one of ``first`` with a paint whose name ends in ``second``; by default
    all.
    """

    def wanted(one: str, other: str) -> bool:
        return (not first or one.startswith(first)) and other.endswith(second)

    table = _rows("paint_mixtures.csv")
    masstones = {row[0]: [float(x) for x in row[3:]] for row in table if row[0] == row[1]}
    index = {name: number for number, name in enumerate(masstones)}
    kept = [row for row in table if row[0] != row[1] and (wanted(*row[:2]) or wanted(row[1], row[0]))]
    return Mixtures(
        np.array(list(masstones.values())),
        np.array([[index[row[0]], index[row[1]]] for row in kept]),
        _shares([row[2] for row in kept]),
        np.array([[float(x) for x in row[3:]] for row in kept]),
    )


def three_bands(name: str) -> Mixtures:
    """Return the mixtures of all pairs of a set of paints_rgb.csv, whose three bands are taken as linear RGB."""
    values = np.array([row[1:] for row in _rows("paints_rgb.csv") if row[0] == name], dtype=float)
    K, S = values[:, :3], values[:, 3:]
    pairs = np.array(list(itertools.combinations(range(len(K)), 2)))
    mixtures = [Pigment(K[pairs], S[pairs]).mix(share).opaque_reflectance() for share in SHARES]
    return Mixtures(
        Pigment(K, S).opaque_reflectance(),
        np.concatenate([pairs] * len(SHARES)),
        np.repeat(SHARES, len(pairs), axis=0),
        np.concatenate(mixtures),
    )


def published(tool: str, cube: Cube) -> Mixtures:
    """Return the mixtures that a tool publishes (published_mixtures.csv)."""
    kept = [row for row in _rows("published_mixtures.csv") if row[0] == tool]
    linear = cube.decode(np.array([[codes(row[column]) for column in (1, 2, 4)] for row in kept]))
    pairs = np.arange(2 * len(kept)).reshape(-1, 2)
    return Mixtures(linear[:, :2].reshape(-1, 3), pairs, _shares([row[3] for row in kept]), linear[:, 2])


def codes(text: str) -> list[int]:
    """Return the three 8-bit codes of '#rrggbb'."""
    return [int(text[i : i + 2], 16) for i in (1, 3, 5)]


def _shares(second: list[str]) -> Array:
    share = np.array(second, dtype=float)
    return np.stack([1 - share, share], axis=1)


def _rows(name: str) -> list[list[str]]:
    """Return the fields of a table without comments and header."""
    lines = (REFERENCE / name).read_text(encoding="utf-8").splitlines()
    return [line.split(",") for line in lines if not line.startswith("#")][1:]


STEPS = 11
PAIRS = {
    "blue-yellow": ("#005fa0", "#ffd200"),
    "atlas-blue-yellow": ("blue", "yellow"),
    "red-white": ("#b01030", "#ffffff"),
    "red-green": ("#d02020", "#20a040"),
}
"""Names of entries, or codes."""
DRAWN = (
    "pigments",
    "pigments in oil",
    "pigments, S = √R",
    "pigments, S = 1",
    "dyes",
    "average",
    "ryb",
    "phosphors",
    "product",
)
"""Shares are the thickness of filters and products, so that a ramp ends at its colours."""


def draw(cube: Cube, smooth: Cube, folder: Path) -> None:
    """Write a picture for each pair of colours, one of coats, and one that compares other tools, by ``smooth``."""
    folder.mkdir(exist_ok=True)
    for name, pair in PAIRS.items():
        rgb = np.array([colour(cube, word) for word in pair])
        plot_strips(_ramps(cube, rgb), folder / f"{name}.png", force=True)
    plot_strips(_coat_strips(cube), folder / "thickness.png", force=True)
    plot_strips(_tools(smooth), folder / "tools.png", force=True)


def colour(cube: Cube, word: str) -> Array:
    """Return the linear RGB (3,) of an entry or of '#rrggbb'."""
    if word.startswith("#"):
        return cube.decode([int(word[i : i + 2], 16) for i in (1, 3, 5)])
    return np.asarray(cube.data.atlas.rgb[cube.data.atlas.names.index(word)], dtype=float)


def _ramps(cube: Cube, rgb: Array) -> list[Strip]:
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    parts = ramp(np.ones(2), STEPS)
    return [_strip(cube, by_name[name].title, by_name[name].mix(rgb, parts)) for name in DRAWN]


def _tools(cube: Cube) -> list[Strip]:
    """Return the ramp of two artists' paints by RGB, by us before and now, and as other tools publish it."""
    steps = published("coloraide", cube)
    ends = steps.paints[:2]
    parts = np.concatenate([[[1, 0]], steps.shares, [[0, 1]]])
    by_name = {mixer.name: mixer for mixer in mixers(cube)}
    mixbox = published("mixbox", cube).expected[:1]
    encoded = np.clip(cube.decode(parts @ cube.encode(ends)), 0, 1)
    ramps = {
        "mean of sRGB codes": encoded,
        "uplift mix --scattering root, the default before": by_name["pigments, S = √R"].mix(ends, parts),
        "uplift mix, the default now": by_name["pigments"].mix(ends, parts),
        "coloraide's spectral, after spectral.js (published)": np.concatenate([ends[:1], steps.expected, ends[1:]]),
        "Mixbox 1:1 (published)": np.concatenate([ends[:1], mixbox, ends[1:]]),
    }
    return [_strip(cube, title, rgb) for title, rgb in ramps.items()]


def _coat_strips(cube: Cube) -> list[Strip]:
    """Return strips of paints on white and on black and of dyes, with doubling thickness."""
    thickness = [0, *(2.0 ** np.arange(-4, 3))]
    spectra = cube.reflectance(np.array([colour(cube, word) for word in ("#b01030", "#ffd200", "#005fa0")]))
    strips = []
    for name, spectrum in zip(("red", "yellow", "blue"), spectra, strict=True):
        colorant, scattering = Ingredients(spectrum[None]), dispersive(cube.data.sensor)
        for ground, on in ((1.0, "white"), (0.0, "black")):
            media = [Medium(x, scattering=scattering) for x in thickness]
            coats = [make_coat("pigment", colorant, [1], medium).over(np.full(81, ground)) for medium in media]
            title = f"{name} paint on {on}, {', '.join(f'{x:.3g}' for x in thickness)} units thick"
            strips.append(_strip(cube, title, cube.data.sensor.rgb(coats)))
        coats = [make_coat("dye", colorant, [1], Medium(x)).over(1.0) for x in thickness]
        strips.append(_strip(cube, f"{name} dye on white, the same thicknesses", cube.data.sensor.rgb(coats)))
    return strips


def _strip(cube: Cube, title: str, rgb: Array) -> Strip:
    return Strip(title, to_display_codes(rgb, cube.data.sensor) / 255)


ARTISTS = ("#002185", "#fcd200")
"""Cobalt blue and Hansa yellow, as Mixbox's table has them."""
GREEN_MARGIN = 0.01
"""Excess of G over R and B, in linear RGB, that counts as green."""


def _sets(cube: Cube) -> dict[str, Mixtures]:
    return {
        "acrylics": acrylics(),
        "blues": acrylics(BLUES, "yellow"),
        "watercolours": three_bands("curtis1997"),
        "photographed": three_bands("lindemeier2020"),
        "mixbox": published("mixbox", cube),
    }


def _rules(cube: Cube) -> dict[str, Scattering | None]:
    """Return the rules by title; None averages RGB."""
    best = dispersive(cube.data.sensor)
    return {
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


def mix(cube: Cube, mixtures: Mixtures, rule: Scattering | None) -> Array:
    """Return the colours (n, 3) of mixtures from the colours of their paints, in linear RGB in [0, 1]."""
    if rule is None:
        return np.asarray((mixtures.shares[:, None] @ mixtures.components)[:, 0])
    spectra = pigments.from_opaque(cube.reflectance(mixtures.paints), rule)
    return _mix(cube, mixtures, spectra)


def _mix(cube: Cube, mixtures: Mixtures, paints: pigments.Pigment) -> Array:
    pairs = pigments.Pigment(paints.absorption[mixtures.pairs], paints.scattering[mixtures.pairs])
    found = pairs.mix(mixtures.shares).opaque_reflectance()
    return np.clip(cube.data.sensor.rgb(found), 0, 1)


def _mix_errors(cube: Cube, mixtures: Mixtures, rule: Scattering | None) -> dict[str, float]:
    found = mix(cube, mixtures, rule)
    difference = delta_e_rgb(cube.data.sensor, mixtures.expected, found)
    return {
        "delta_e": float(difference.mean()),
        "rms": float(np.sqrt(np.mean((found - mixtures.expected) ** 2))),
    }


def _greens(cube: Cube, pair: Array, rule: Scattering | None) -> list[dict[str, Any]]:
    """Mix a blue and a yellow at 1:3, 1:1 and 3:1."""
    one = Mixtures(pair, np.array([[0, 1]] * 3), SHARES[::-1], np.zeros((3, 3)))
    return [
        {"green": bool(g > max(r, b) + GREEN_MARGIN), "code": _hex(cube, np.array([r, g, b]))}
        for r, g, b in mix(cube, one, rule)
    ]


def _hex(cube: Cube, rgb: Array) -> str:
    return "#" + "".join(f"{round(code):02x}" for code in cube.encode(rgb).tolist())


INDICES = (1.33, 1.48, 1.5, 1.66)
"""Water, light oil, glass and linseed oil, heavy oil."""


MIXTURES, PIXELS, COLOURS = 20_000, 1_000_000, 1_000_000
RUNS = 5
CHECKED = 20


def mixtures(cube: Cube) -> list[dict[str, Any]]:
    """Return nanoseconds per mixture of two, from RGB to RGB and between spectra."""
    rng = np.random.default_rng(0)
    rgb, parts = rng.random((MIXTURES, 2, 3)), rng.random((MIXTURES, 2)) + 0.1
    spectra = cube.reflectance(rgb)
    rows, spectral_mixers = [], spectral_models(cube.data.sensor)
    for mixer in mixers(cube):
        _check(mixer.mix, rgb, parts)
        between = spectral_mixers.get(mixer.name)
        spectral = _ns(partial(between[1], spectra, parts), MIXTURES) if between else None
        rows.append({"mixer": mixer.title, "rgb": _ns(partial(mixer.mix, rgb, parts), MIXTURES), "spectra": spectral})
    return rows


def _check(mix: Callable[[Array, Array], Array], rgb: Array, parts: Array) -> None:
    """Raise `RuntimeError` unless a batch gives the same results as single mixtures."""
    batch = mix(rgb[:CHECKED], parts[:CHECKED])
    expected = np.array([mix(one, share) for one, share in zip(rgb[:CHECKED], parts[:CHECKED], strict=True)])
    if not np.allclose(batch, expected, atol=1e-9):
        raise RuntimeError("wrong result: nothing to time")


def images(cube: Cube) -> list[dict[str, Any]]:
    """Return nanoseconds of a coat over an image, and of HSL to RGB."""
    rng = np.random.default_rng(0)
    spectrum = cube.reflectance(colour(cube, "red"))
    scattering = dispersive(cube.data.sensor)
    coat = make_coat("pigment", Ingredients(spectrum[None]), [1], Medium(0.5, scattering=scattering))
    brush = overpainter(cube, coat, threads=1)
    image = rng.random((PIXELS, 3)).astype(np.float32)
    expected = cube.data.sensor.rgb(coat.over(cube.reflectance(image[:CHECKED])))
    if np.abs(brush.paint(image)[:CHECKED] - expected).max() > 1e-5:
        raise RuntimeError("wrong result: nothing to time")
    colours = rng.random((COLOURS, 3))
    peer = colour_science().HSL_to_RGB
    if not np.allclose(hsl_to_rgb(colours), peer(colours)):
        raise RuntimeError("wrong result: nothing to time")
    spectra = cube.reflectance(image[:MIXTURES])
    paint = partial(_over, from_opaque(spectrum[None], scattering), spectra)
    operations: dict[str, tuple[Callable[[], object], int]] = {
        "coat over a painting, RGB to RGB": (lambda: brush.paint(image), PIXELS),
        "Kubelka–Munk layer on a ground, 81 wavelengths": (paint, MIXTURES),
        "HSL to RGB (5.3.5)": (lambda: hsl_to_rgb(colours), COLOURS),
        "HSL to RGB, colour-science": (lambda: peer(colours), COLOURS),
    }
    return [{"operation": name, "ns": _ns(function, count)} for name, (function, count) in operations.items()]


def _over(paint: Pigment, grounds: Array) -> Array:
    thickness = np.linspace(0.01, 3, len(grounds))
    return paint.mix([1]).layer(thickness).over(grounds)


def _ns(function: Callable[[], object], count: int) -> Spread:
    """Return CPU nanoseconds per item, warm."""
    function()
    _, cpu = time_calls(function, RUNS)
    return cpu.scaled(1e9 / count)


def compare_scattering(smooth: Cube, atlas: Cube) -> dict[str, Any]:
    """Compare rules for S on the measured sets and on published mixtures, uplifted by ``smooth``.

    ``atlas`` is the cube that uplifts the ColorChecker's blue and yellow.
    """
    sets = _sets(smooth)
    artists = np.array([smooth.decode(codes(text)) for text in ARTISTS])
    patches = np.array([colour(atlas, name) for name in ("blue", "yellow")])
    rows = [
        {
            "rule": title,
            **{name: _mix_errors(smooth, one, rule) for name, one in sets.items()},
            "artists": _greens(smooth, artists, rule),
            "patches": _greens(atlas, patches, rule),
        }
        for title, rule in _rules(smooth).items()
    ]
    return {"scatterings": rows, "set_sizes": {name: len(one.pairs) for name, one in sets.items()}}


def criteria(cube: Cube) -> dict[str, Any]:
    """Evaluate every mixer by every criterion of section 10.4."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    rows = []
    for mixer in mixers(cube):
        values = evaluate(mixer, cube.data.sensor, coloured)
        verdicts = [
            {"obeys": value <= criterion.limit, "value": value + 0.0}
            for criterion, value in zip(CRITERIA, values, strict=True)
        ]
        rows.append({"mixer": mixer.title, "verdicts": verdicts})
    titles = [{"title": one.title, "measure": one.measure, "limit": one.limit} for one in CRITERIA]
    return {"patches": len(coloured), "criteria_titles": titles, "criteria": rows}


def surface_record(index: float) -> dict[str, float]:
    """Return the reflectance at normal incidence (9.3), for diffuse light (10.9), and for diffuse light from inside."""
    return {
        "index": index,
        "perpendicular": float(optics.fresnel_reflectance(index)),
        "diffuse": float(optics.diffuse_reflectance(index)),
        "internal": float(optics.internal_reflectance(index)),
    }


def main() -> None:
    """Measure, draw and store."""
    cube, smooth = uplift.load(CUBES / "moments-16-macbeth.uplift"), uplift.load()
    draw(cube, smooth, DOCS / "mixing")
    record(
        "mixing",
        **criteria(cube),
        **compare_scattering(smooth, cube),
        surfaces=[surface_record(index) for index in INDICES],
        runs=RUNS,
        mixtures=MIXTURES,
        pixels=PIXELS,
        colours=COLOURS,
        mixture_times=mixtures(cube),
        pixel_times=images(cube),
    )


if __name__ == "__main__":
    main()
