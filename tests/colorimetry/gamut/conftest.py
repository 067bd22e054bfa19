"""Gamuts of displays, and colours outside them."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.common.arrays import Array

P3 = Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.3127, 0.3290))
ACESCG = Primaries((0.713, 0.293), (0.165, 0.830), (0.128, 0.044), (0.32168, 0.33767))
GAMUTS = {"sRGB": SRGB, "P3": P3, "ACEScg": ACESCG}


@pytest.fixture(params=[*GAMUTS, "a cube's"])
def gamut(request):
    """Gamuts of displays by primaries, and of a cube by its sensor."""
    return GAMUTS.get(request.param) or observer.sensor("sRGB", "A")


@pytest.fixture(scope="session")
def outside() -> Array:
    """(n, 3) linear RGB, all outside [0, 1]: slightly, far, too bright, too dark, too saturated, and combinations."""
    rng = np.random.default_rng(0)
    near = np.clip(rng.normal(0.5, 0.5, (3000, 3)), 0, 1) + rng.normal(0, 1e-3, (3000, 3))
    found = [near, rng.normal(0.5, 1, (4000, 3)), 20 * rng.random((1000, 3)), -rng.random((100, 3))]
    grey = np.linspace(-1, 3, 41)[:, None].repeat(3, axis=1)
    rgb = np.concatenate([*found, grey, 3 * np.eye(3), -np.eye(3), 2 - 2 * np.eye(3)])
    return rgb[((rgb < 0) | (rgb > 1)).any(axis=1)]
