"""Light paths over two or three materials, with wavelengths that were fitted to single materials."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.wavelengths import METHODS, evaluate, make_setup

COUNTS = (6, 8, 12)
PATHS = 400
LIGHTS = ("D65", "FL11")


def bounces(materials: Array) -> list[dict[str, Any]]:
    """Return mean ΔE00 of random paths over one to three held-out materials."""
    odd = np.arange(len(materials)) % 2 == 1
    fitted = make_setup(materials[~odd], LIGHTS)
    rng = np.random.default_rng(1)
    draws = [rng.choice(materials[odd], PATHS) for _ in range(3)]
    paths = [make_setup(np.prod(draws[: length + 1], axis=0), LIGHTS) for length in range(3)]
    rows = []
    for count in COUNTS:
        samplings = {name: method(fitted, count) for name, method in METHODS.items()}
        for length, path in enumerate(paths, 1):
            errors = {name: float(evaluate(path, sampling).mean) for name, sampling in samplings.items()}
            rows.append({"count": count, "materials": length, "errors": errors})
    return rows
