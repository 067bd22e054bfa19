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
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Mask
from uplift.lookup import Cube
from uplift.report.measures import check_calibration

SPLITS = 3
"""Random splits. Each half predicts the other, so that every material is known and queried equally often."""
COUNTS = (9, 17)
KNOWN = ("macbeth", "cie2017")
"""Atlases of the cubes that are queried for other sets."""
MIN_COLOURS = 10
"""Fewer colours are not listed."""
Pair = tuple[Cube, Materials]


def measure() -> dict[str, Any]:
    """Query halves of atlases, then other sets."""
    halves = {key: other_halves(*key) for key in product(large(), COUNTS)}
    others = {
        (known, name): [(build(known, leave_out=shipped(name)), materials(name))]
        for known in KNOWN
        for name in large()
        if name != known
    }
    own_light = [quartiles(name, count, pairs) for (name, count), pairs in halves.items()]
    own_light += [
        quartiles(f"{known}, queried for {name}", COUNTS[0], pairs)
        for (known, name), pairs in others.items()
        if known == KNOWN[0]
    ]
    return {
        "light_splits": SPLITS,
        "standard_errors": own_light,
        "light_errors": [
            {"atlas": name, "coefficients": count, "covered": covered(pairs)} for (name, count), pairs in halves.items()
        ],
        "other_families": [row for key, pairs in others.items() for row in across(*key, pairs)],
    }


def other_halves(name: str, count: int) -> list[Pair]:
    """Return cubes of halves of an atlas, and the other halves."""
    pairs = []
    for seed in range(SPLITS):
        halves = [materials(name).take(rows) for rows in split(materials(name), seed)]
        for kept, queried in (halves, halves[::-1]):
            pairs.append((build_from(kept, coefficients=count, leave_out=shipped(name)), queried))
    return pairs


def quartiles(label: str, count: int, pairs: list[Pair]) -> dict[str, Any]:
    """Return the coverage under the light of the nodes, overall and by quartile of the standard error."""
    light = observer.light(pairs[0][0].data.error_illuminant)
    parts = [_errors(cube, some, light) for cube, some in pairs]
    actual, predicted, bound = (np.concatenate(part) for part in zip(*parts, strict=True))
    coverage = check_calibration(actual, predicted, bound)
    assert coverage is not None
    within = np.stack([actual <= predicted, actual <= bound], axis=1)
    by_size = np.array_split(predicted.argsort(kind="stable"), 4)
    return {
        "atlas": label,
        "coefficients": count,
        "all": [coverage.actual, coverage.predicted],
        "within_error": coverage.within_error,
        "within_bound": coverage.within_bound,
        "quartiles": [within[rows].mean(axis=0).tolist() for rows in by_size],
    }


def across(known: str, name: str, pairs: list[Pair]) -> Iterator[dict[str, Any]]:
    """Yield the coverage of another set, of colours that are like the atlas and of those that are not."""
    ((cube, some),) = pairs
    unlike = cube.unlike_atlas(some.rgb)
    for label, rows in {"like the atlas": ~unlike, "unlike the atlas": unlike}.items():
        if rows.sum() >= MIN_COLOURS:
            share, found = float(rows.mean()), covered(pairs, rows)
            yield {"atlas": known, "queried": name, "colours": label, "share": share, "covered": found}


def covered(pairs: list[Pair], rows: Mask | None = None) -> dict[str, list[float]]:
    """Return, by light, the shares of errors within the standard error and within the error bound."""
    chosen = slice(None) if rows is None else rows
    return {
        name: np.concatenate([_within(cube, some, name) for cube, some in pairs])[chosen].mean(axis=0).tolist()
        for name in HELD_OUT_LIGHTS
    }


def _within(cube: Cube, some: Materials, light: str) -> Array:
    actual, predicted, bound = _errors(cube, some, observer.light(light))
    return np.stack([actual <= predicted, actual <= bound], axis=1)


def _errors(cube: Cube, some: Materials, light: Light) -> tuple[Array, Array, Array]:
    """Return actual errors (n,), standard errors and error bounds."""
    actual = delta_e_spectra(light, cube.reflectance(some.rgb), some.measured)
    predicted, bound = cube.standard_error(some.rgb, light), cube.error_bound(some.rgb, light)
    assert predicted is not None
    assert bound is not None
    return actual, predicted, bound
