"""Criteria of mixing models, accuracy of the assumed scattering, and reflectance of surfaces."""

from __future__ import annotations

import itertools
from functools import cache
from typing import Any

import numpy as np

from benchmarks.mixing.pictures import colour
from benchmarks.record import ROOT
from uplift.common.arrays import Array
from uplift.design.mixing import kubelka_munk, pigments, surface
from uplift.design.mixing.criteria import CRITERIA, SHARES, CriterionResult, evaluate
from uplift.design.mixing.mixers import mixers
from uplift.design.mixing.pigments import Pigment
from uplift.lookup import Cube

PAINTS = ROOT / "tests" / "reference" / "paints_rgb.csv"
GRADINGS = (0.0, 0.25, 0.5, 0.75, 0.9, 1.0)
INDICES = (1.33, 1.48, 1.5, 1.66)
"""Water, light oil, glass and linseed oil, heavy oil."""


def criteria(cube: Cube) -> dict[str, Any]:
    """Evaluate every mixer by every criterion of section 10.4."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    rows = []
    for mixer in mixers(cube):
        verdicts = evaluate(mixer, cube.data.sensor, coloured)
        rows.append({"mixer": mixer.title, "verdicts": [verdict_record(verdict) for verdict in verdicts]})
    titles = [{"title": one.title, "measure": one.measure, "limit": one.limit} for one in CRITERIA]
    return {"patches": len(coloured), "criteria_titles": titles, "criteria": rows}


def verdict_record(verdict: CriterionResult) -> dict[str, Any]:
    """Return whether a criterion holds, and the measured value."""
    return {"obeys": bool(verdict.passed), "value": float(verdict.value) + 0.0}


def gradings(cube: Cube) -> dict[str, Any]:
    """Compare S = R^p with paints of measured K and S, mixed in pairs; and tabulate the reflectance of surfaces."""
    rows = [
        {
            "p": "average of R" if p is None else f"{p:g}",
            "errors": {name: _error(name, p) for name in _sets()},
            "greens": _greens(cube, p),
        }
        for p in (*GRADINGS, None)
    ]
    return {"default_p": pigments.GRADING, "gradings": rows, "surfaces": [surface_record(n) for n in INDICES]}


@cache
def _sets() -> dict[str, Pigment]:
    """Return the paints (n, 3) of each set."""
    lines = [line.split(",") for line in PAINTS.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    names = dict.fromkeys(line[0] for line in lines[1:])
    values = {
        name: np.array([line[1:] for line in lines[1:] if line[0] == name], dtype=float) for name in names
    }
    return {name: Pigment(rows[:, :3], rows[:, 3:]) for name, rows in values.items()}


def _error(name: str, p: float | None) -> float:
    paints = _sets()[name]
    pairs = np.array(list(itertools.combinations(range(len(paints.absorption)), 2)))
    expected = _hiding_mixtures(Pigment(paints.absorption[pairs], paints.scattering[pairs]))
    reflectances = kubelka_munk.opaque_reflectance(paints)[pairs]
    return float(np.sqrt(np.mean((_mixtures(reflectances, p) - expected) ** 2)))


def _mixtures(reflectances: Array, p: float | None) -> Array:
    """Mix reflectances (…, 2, N) at the shares of the criteria; None for p averages them."""
    if p is None:
        return np.stack([np.tensordot(reflectances, share, axes=(-2, 0)) for share in SHARES])
    return _hiding_mixtures(pigments.from_opaque(reflectances, p))


def _hiding_mixtures(pair: Pigment) -> Array:
    return np.stack([kubelka_munk.opaque_reflectance(pair.mix(share)) for share in SHARES])


def _greens(cube: Cube, p: float | None) -> list[dict[str, Any]]:
    """Mix the ColorChecker's blue and yellow at 1:3, 1:1 and 3:1."""
    spectra = cube.reflectance(np.array([colour(cube, "blue"), colour(cube, "yellow")]))
    mixtures = cube.data.sensor.rgb(_mixtures(spectra, p)[::-1])
    return [
        {"green": bool(g > max(r, b) + 0.01), "code": _hex(cube, np.array([r, g, b]))} for r, g, b in mixtures
    ]


def _hex(cube: Cube, rgb: Array) -> str:
    return "#" + "".join(f"{round(code):02x}" for code in cube.encode(rgb).tolist())


def surface_record(index: float) -> dict[str, float]:
    """Return the reflectance at normal incidence (9.3), for diffuse light (10.9), and for diffuse light from inside."""
    return {
        "index": index,
        "perpendicular": float(surface.fresnel_reflectance(index)),
        "diffuse": float(surface.diffuse_reflectance(index)),
        "internal": float(surface.internal_reflectance(index)),
    }
