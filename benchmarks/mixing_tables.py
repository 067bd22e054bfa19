"""Which way of mixing obeys what, how near supposed scattering comes to paints, and what surfaces throw back."""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np

from benchmarks.mixing_pictures import colour
from benchmarks.page import table
from benchmarks.timing import ROOT
from uplift.common.arrays import Array
from uplift.design.mixing import kubelka_munk, pigments, surface
from uplift.design.mixing.criteria import CRITERIA, SHARES, Verdict, judge
from uplift.design.mixing.mixers import mixers
from uplift.design.mixing.pigments import Pigment
from uplift.lookup import Cube

PAINTS = ROOT / "tests" / "reference" / "paints_rgb.csv"
GRADINGS = (0.0, 0.25, 0.5, 0.75, 0.9, 1.0)


def criteria(cube: Cube) -> str:
    """Every mixer by every criterion."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    head = ["", *(f"{one.title} ({one.measure} ≤ {one.limit:g})" for one in CRITERIA)]
    rows = [[mixer.title, *map(_told, judge(mixer, cube.data.sensor, coloured))] for mixer in mixers(cube)]
    words = (
        f"The criteria of 10.4, on the {len(coloured)} coloured patches of the ColorChecker with black and "
        "white at 1:3, 1:1 and 3:1, and on full colours of sRGB: blue and orange, red and green, yellow and"
        " purple at 1:1, blue and yellow at the best of 1:3, 1:1 and 3:1. ● obeys, ○ breaks. Filters, "
        "products and phosphors are stacked, as the thesis has them: two of a kind are darker than one. "
        "Tints of paints, and of dyes all the more, turn their hue as real ones do; heuristics that are "
        "linear in RGB cannot, and cannot turn blue and yellow into green either. Amy's approximation holds"
        " for dark paints alone, and makes light ones half as light."
    )
    return table("Which model breaks which criterion", words, head, rows)


def _told(verdict: Verdict) -> str:
    return f"{'●' if verdict.obeys else '○'} {verdict.value + 0.0:.3g}"


def gradings(cube: Cube) -> str:
    """S = R^p against paints with measured K and S, mixed in pairs."""
    sets = list(_sets())
    head = ["p", *(f"rms error, {name}" for name in sets), "ColorChecker's blue and yellow, 1:3, 1:1, 3:1"]
    rows = [
        [f"{p:g}", *(f"{_error(name, p):.3f}" for name in sets), ", ".join(_greens(cube, p))]
        for p in GRADINGS
    ]
    rows.append(
        ["average of R", *(f"{_error(name, None):.3f}" for name in sets), ", ".join(_greens(cube, None))]
    )
    words = (
        "Of paints with known K and S, in three bands, the reflectance of all pairs at 1:3, 1:1 and 3:1 is "
        "worked out by Kubelka and Munk with both constants, and again from the paints' reflectances alone "
        "with S = R^p. The sets are twelve watercolours (Curtis et al. 1997, as painty has them) and fourteen "
        "measured paints (T. Lindemeier's painty, 2020): tests/reference/paints_rgb.csv. They are best at p"
        " = 0.9 and 0.75; S alike everywhere, the single-constant theory, errs two to three times as much. "
        "The last column is what becomes of criterion 5 with blue and yellow that are measured: above p = ½"
        f" it is lost. The default is p = {pigments.GRADING:g}; `--km-constants one` is p = 0."
    )
    return table("K and S from one reflectance", words, head, rows)


@cache
def _sets() -> dict[str, Pigment]:
    """Paints (n, 3) by set."""
    lines = [line.split(",") for line in PAINTS.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    names = dict.fromkeys(line[0] for line in lines[1:])
    values = {
        name: np.array([line[1:] for line in lines[1:] if line[0] == name], dtype=float) for name in names
    }
    return {name: Pigment(found[:, :3], found[:, 3:]) for name, found in values.items()}


def _error(name: str, p: float | None) -> float:
    paints = _sets()[name]
    pairs = np.array(list(itertools.combinations(range(len(paints.absorption)), 2)))
    expected = _hiding_mixtures(Pigment(paints.absorption[pairs], paints.scattering[pairs]))
    seen = kubelka_munk.hiding(paints)[pairs]
    return float(np.sqrt(np.mean((_mixtures(seen, p) - expected) ** 2)))


def _mixtures(seen: Array, p: float | None) -> Array:
    """Of reflectances (…, 2, N), at the shares of the criteria; None for their mean."""
    if p is None:
        return np.stack([np.tensordot(seen, share, axes=(-2, 0)) for share in SHARES])
    return _hiding_mixtures(pigments.of_hiding(seen, p))


def _hiding_mixtures(pair: Pigment) -> Array:
    return np.stack([kubelka_munk.hiding(pair.mixed(share)) for share in SHARES])


def _greens(cube: Cube, p: float | None) -> list[str]:
    spectra = cube.reflectance(np.array([colour(cube, "blue"), colour(cube, "yellow")]))
    found = cube.data.sensor.rgb(_mixtures(spectra, p)[::-1])
    return [("● " if g > max(r, b) + 0.01 else "○ ") + _hex(cube, np.array([r, g, b])) for r, g, b in found]


def _hex(cube: Cube, rgb: Array) -> str:
    return "#" + "".join(f"{round(code):02x}" for code in cube.encode(rgb).tolist())


def surfaces() -> str:
    """(9.3), (10.9) and from inside."""
    head = ["index", "perpendicular (9.3)", "from everywhere (10.9)", "diffuse, from inside"]
    rows = [
        [f"{n:g}", *(f"{of(n):.4f}" for of in (surface.fresnel, surface.diffuse, surface.inside))]
        for n in (1.33, 1.48, 1.5, 1.66)
    ]
    words = "Reflectance of a smooth surface against air: water, light oil, glass and linseed oil, heavy oil."
    return table("Surfaces", words, head, rows)
