"""Light that meets two or three materials on its way, seen through wavelengths that were fitted to single ones."""

from __future__ import annotations

import numpy as np

from benchmarks.page import table
from uplift.common.arrays import Array
from uplift.scene.wavelengths import METHODS, evaluate, make_setup

COUNTS = (6, 8, 12)
PATHS = 400


def bounces(materials: Array, lights: tuple[str, ...]) -> str:
    """Mean ΔE00 after one to three unseen materials: products of random ones."""
    odd = np.arange(len(materials)) % 2 == 1
    fitted = make_setup(materials[~odd], lights)
    rng = np.random.default_rng(1)
    met = [rng.choice(materials[odd], PATHS) for _ in range(3)]
    paths = [make_setup(np.prod(met[: length + 1], axis=0), lights) for length in range(3)]
    rows = []
    for count in COUNTS:
        samplings = {name: method(fitted, count) for name, method in METHODS.items()}
        for length, path in enumerate(paths, 1):
            means = (f"{evaluate(path, sampling).mean:.3f}" for sampling in samplings.values())
            rows.append([str(count), str(length), *means])
    return table(
        f"Several bounces under {', '.join(lights)}",
        f"Mean ΔE00 of {PATHS} random paths that meet one, two or three unseen materials; fitted to single ones.",
        ["wavelengths", "materials met", *METHODS],
        rows,
    )
