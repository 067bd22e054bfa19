"""Cubes of 32³: entries at their own colours, holdout tests, seeds and smoothness."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np

import uplift
from benchmarks.fidelity.between import limit, limit_kernel, split
from benchmarks.fidelity.materials import (
    SENSOR,
    TESTED_ON,
    Materials,
    as_record,
    entries,
    errors,
    large,
    materials,
    spectra,
    spectra_of,
)
from benchmarks.fidelity.start import solved
from uplift.atlas import Atlas, Entry
from uplift.colorimetry.delta_e import lab_jacobian
from uplift.common.arrays import Array
from uplift.cube import contents
from uplift.fit.families import families_with
from uplift.lab.study.held_out import HALF, NO_ATLAS, SIGMOID, HoldoutSplit, holdout
from uplift.lookup import Cube
from uplift.models import Moments
from uplift.report.measures import compute_smoothness

DIM, COARSE = 32, 16
COUNTS = (9, 13, 17)
SPLITS = 3
CUBES = (HALF, NO_ATLAS, SIGMOID)
"""Methods of `holdout` on this page; the page of held-out materials has the others."""


Splits = dict[tuple[str, int], tuple[HoldoutSplit, ...]]


def measure() -> dict[str, Any]:
    """Build the cubes and evaluate them."""
    splits: Splits = {
        (name, count): holdout(spectra(name), SPLITS, dim=DIM, coefficients=count, leave_out=shipped(name))
        for name in large()
        for count in COUNTS
    }
    return {
        "dim": DIM,
        "entries": [row for name in (*TESTED_ON, "rawtoaces") for row in at_entries(name)],
        "halves": [row for key in splits for row in halves(*key, splits[key])],
        "shares": [shares(*key, splits[key]) for key in splits],
        "seed_starts": [row for name in large() for dim in (DIM, COARSE) for row in seed_starts(name, dim)],
        "smoothness": [
            neighbour_steps(name, count) for name in (None, "macbeth", "rawtoaces", *large()[2:]) for count in (9, 17)
        ],
    }


def build(name: str | None, **options: object) -> Cube:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        return uplift.build(spectra(name) if name else None, **{"dim": DIM, **options})


def shipped(name: str) -> tuple[str, ...]:
    """Return the shipped families that must not shape a prior that is tested on an atlas."""
    return families_with(materials(name).measured)


def at_entries(name: str) -> Iterator[dict[str, Any]]:
    """Yield the errors of cubes at the colours of their entries, and the size of the cubes' arrays."""
    some = materials(name)
    cubes = {f"9 coefficients, entries {count}": build(name, entry_coefficients=count) for count in COUNTS}
    cubes |= {
        "17 coefficients": build(name, coefficients=17),
        "9, without the atlas": build(None),
        "sigmoid": build(name, model="sigmoid"),
    }
    for label, cube in cubes.items():
        size = sum(array.nbytes for array in contents(cube.data)[0].values())
        yield {
            "atlas": name,
            "cube": label,
            "megabytes": size / 1e6,
            **errors(cube.reflectance(some.rgb), some),
        }


def halves(name: str, count: int, splits: tuple[HoldoutSplit, ...]) -> Iterator[dict[str, Any]]:
    """Yield the errors of every cube at the held-out half, and the limits once per atlas."""
    for method in CUBES:
        means = np.array([split.errors[method].means() for split in splits])
        mean, std = as_record(means.mean(axis=0)), as_record(means.std(axis=0))
        both = {key: {"mean": mean["errors"][key], "std": std["errors"][key]} for key in mean["errors"]}
        rms = {"mean": mean["rms"], "std": std["rms"]}
        yield {"atlas": name, "coefficients": count, "cube": method, "rms": rms, "errors": both}
    if count == COUNTS[-1]:
        length, nugget = limit_kernel(name)
        label = f"*limit:* length {length:g}, nugget {nugget:g}"
        yield {"atlas": name, "coefficients": None, "cube": label, **as_record(limit(name, length, nugget))}


def shares(name: str, count: int, splits: tuple[HoldoutSplit, ...]) -> dict[str, Any]:
    """Return the errors relative to the sigmoid, and the light under which the atlas helps least."""
    ours, sigmoid, plain = (
        np.array([split.errors[method].means() for split in splits]).mean(axis=0)
        for method in (HALF, SIGMOID, NO_ATLAS)
    )
    share, against = as_record(ours / sigmoid), as_record(ours / plain)["errors"]
    worst = max(against, key=against.__getitem__)
    return {
        "atlas": name,
        "coefficients": count,
        "rms": share["rms"],
        "A": share["errors"]["A"],
        "FL11": share["errors"]["FL11"],
        "worst": {"ratio": against[worst], "light": worst},
    }


def seed_starts(name: str, dim: int) -> Iterator[dict[str, Any]]:
    """Yield the errors of cubes by their seeds, for the half of an atlas that they do not know and near entries."""
    some = materials(name)
    kept, queried = (some.take(rows) for rows in split(some, 0))
    tests = {"the other half": queried, "shades of entries": shades(kept), "colours near entries": near(kept)}
    for label, corners in {"entry and prior, the default": False, "the entry": True}.items():
        cube = build_from(kept, dim=dim, seed_corners=corners, leave_out=shipped(name))
        for test, requested in tests.items():
            yield {
                "atlas": name,
                "dim": dim,
                "share": cube.data.provenance["prior"]["corner_share"],
                "start": label,
                "queried": test,
                **errors(cube.reflectance(requested.rgb), requested),
            }


def build_from(some: Materials, **options: object) -> Cube:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uplift.UpliftWarning)
        grid = tuple(SENSOR.wavelengths)
        atlas = Atlas(tuple(Entry(str(row), grid, tuple(values)) for row, values in enumerate(some.measured)))
        return uplift.build(atlas, **{"dim": DIM, **options})


def shades(some: Materials) -> Materials:
    """Scale materials by 0.5 to 1, then move their colours like `near`."""
    scale = np.random.default_rng(1).uniform(0.5, 1, (len(some.rgb), 1))
    return near(Materials(some.name, some.measured * scale, some.rgb * scale))


def near(some: Materials) -> Materials:
    """Change the colours of materials by a random 2 ΔE*ab, and their spectra as little as is necessary."""
    model = Moments(17)
    own = entries(model, some)
    sensitivity = lab_jacobian(SENSOR.xyz(some.rgb), SENSOR.light.white) @ SENSOR.xyz(np.eye(3)).T
    step = 2 * unit_vectors(len(some.rgb))
    rgb = some.rgb + np.linalg.solve(sensitivity, step[..., None])[..., 0]
    inside = SENSOR.contains(rgb)
    rgb = np.clip(rgb[inside], 0, 1)
    spectra = solved(model, own.multipliers[inside], rgb)
    change = spectra - spectra_of(model, own.multipliers[inside])
    return Materials(some.name, some.measured[inside] + change, rgb)


def unit_vectors(count: int) -> Array:
    vectors = np.random.default_rng(2).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def neighbour_steps(name: str | None, count: int) -> dict[str, Any]:
    """Return the rms difference between the spectra of neighbouring nodes."""
    steps = compute_smoothness(build(name, coefficients=count).data).differences
    return {
        "atlas": name or "none",
        "coefficients": count,
        "mean": float(steps.mean()),
        "p99": float(np.quantile(steps, 0.99)),
        "max": float(steps.max()),
    }
