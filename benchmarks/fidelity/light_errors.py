"""Standard errors under every light: how many of the actual errors they cover."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from benchmarks.fidelity.between import split
from benchmarks.fidelity.cubes import build, build_from, shipped
from benchmarks.fidelity.materials import Materials, large, materials
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array, Mask
from uplift.lookup import Cube

SPLITS = 6
"""Random splits. Each half predicts the other, so that every material is known and queried equally often."""
COUNTS = (9, 17)
KNOWN = ("macbeth", "cie2017")
"""Atlases of the cubes that are queried for other sets."""
MIN_COLOURS = 10
"""Fewer colours are not listed."""
Pair = tuple[Cube, Materials]


def measure() -> dict[str, Any]:
    """Query halves of atlases, then other sets."""
    return {
        "light_splits": SPLITS,
        "light_errors": [coverage(name, count) for name, count in product(large(), COUNTS)],
        "other_families": [
            row for known in KNOWN for name in large() if name != known for row in across(known, name)
        ],
    }


def coverage(name: str, count: int) -> dict[str, Any]:
    """Return the coverage of the other halves of an atlas."""
    pairs = []
    for seed in range(SPLITS):
        halves = [materials(name).take(rows) for rows in split(materials(name), seed)]
        for kept, queried in (halves, halves[::-1]):
            pairs.append((build_from(kept, coefficients=count, leave_out=shipped(name)), queried))
    return {"atlas": name, "coefficients": count, "covered": covered(pairs)}


def across(known: str, name: str) -> Iterator[dict[str, Any]]:
    """Yield the coverage of another set, of colours that are like the atlas and of those that are not."""
    cube, some = build(known, leave_out=shipped(name)), materials(name)
    unlike = cube.unlike_atlas(some.rgb)
    for label, rows in {"like the atlas": ~unlike, "unlike the atlas": unlike}.items():
        if rows.sum() >= MIN_COLOURS:
            share, found = float(rows.mean()), covered([(cube, some)], rows)
            yield {"atlas": known, "queried": name, "colours": label, "share": share, "covered": found}


def covered(pairs: list[Pair], rows: Mask | None = None) -> dict[str, list[float]]:
    """Return, by light, the shares of errors within the standard error and within the error bound."""
    chosen = slice(None) if rows is None else rows
    return {
        name: np.concatenate([_within(cube, some, name) for cube, some in pairs])[chosen]
        .mean(axis=0)
        .tolist()
        for name in HELD_OUT_LIGHTS
    }


def _within(cube: Cube, some: Materials, light: str) -> Array:
    actual = delta_e_spectra(observer.light(light), cube.reflectance(some.rgb), some.measured)
    radii = [cube.standard_error(some.rgb, light), cube.error_bound(some.rgb, light)]
    return np.stack([actual <= radius for radius in radii], axis=1)
