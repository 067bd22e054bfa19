"""Chromaticities, signs and brightness of the answers of an emission table, and surfaces under its white lights."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab, lab_of
from uplift.colorimetry.lights import Lamps
from uplift.common.arrays import Array
from uplift.lights.fit import unit_xyz
from uplift.lights.lattice import DENOMINATOR, chromaticity
from uplift.lights.lookup import EmissionTable
from uplift.lights.prior import relit_delta_e

TYPES = ("float64", "float32")
GREY = 0.18
"""Reflectance of a grey surface."""


def spokes(table: EmissionTable, directions: int, steps: int) -> Array:
    """Return u′v′ (directions · steps, 2) from white to the spectral locus, both included."""
    angle = np.arange(directions) * 2 * np.pi / directions
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rim = direction / table.data.lattice.polar(direction)[2][:, None]
    share = np.linspace(0, 1, steps)
    return np.asarray((table.data.lattice.white + rim[:, None] * share[:, None]).reshape(-1, 2))


def exactness(table: EmissionTable, uv: Array) -> Iterator[dict[str, Any]]:
    """Yield the largest difference in u′v′ and the smallest power at chromaticities (n, 2), by type."""
    radiometry = _radiometry(table)
    for dtype in TYPES:
        power = table.spectrum_of_xyz(unit_xyz(uv), dtype=dtype)
        apart = np.linalg.norm(chromaticity(power.astype(float) @ radiometry) - uv, axis=1)
        yield {
            "type": dtype,
            "colours": len(uv),
            "uv_error": float(apart.max()),
            "min_power": float(power.min()),
        }


def mixtures(table: EmissionTable) -> dict[str, Any]:
    """Return how far answers are from mixtures of two wavelengths in equal parts: in u′v′, and ΔE00.

    ΔE00 is relative to white of the luminance of the colour.
    """
    radiometry = _radiometry(table)
    visible = radiometry[radiometry @ DENOMINATOR > 0]
    single = visible / (visible @ DENOMINATOR)[:, None]
    first, second = np.triu_indices(len(single))
    xyz = (single[first] + single[second]) / 2
    back = table.spectrum_of_xyz(xyz) @ radiometry
    white = table.xyz(np.ones(3)) * xyz[:, 1:2]
    return {
        "colours": len(xyz),
        "uv_error": float(np.linalg.norm(chromaticity(back) - chromaticity(xyz), axis=1).max()),
        "delta_e": float(delta_e_2000(lab_of(xyz, white), lab_of(back, white)).max()),
    }


def round_trips(table: EmissionTable, levels: tuple[float, ...], count: int) -> Iterator[dict[str, Any]]:
    """Yield the errors of RGB → spectrum → RGB by brightness, relative to white of the luminance of the colour."""
    rng = np.random.default_rng(0)
    for level in levels:
        rgb = level * rng.random((count, 3))
        xyz = table.xyz(rgb)
        white = table.xyz(np.ones(3)) * xyz[:, 1:2]
        row: dict[str, Any] = {"level": level}
        for dtype in TYPES:
            back = table.xyz(table.rgb(table.spectrum(rgb, dtype=dtype)))
            row[dtype] = float(delta_e_2000(lab_of(xyz, white), lab_of(back, white)).max())
        yield row


def white_lights(
    table: EmissionTable, lamps: Lamps, names: tuple[str, ...], reflectances: Array
) -> Iterator[dict[str, Any]]:
    """Yield how far answers at the chromaticities of lamps are from the lamps, and grey surfaces from grey."""
    radiometry = _radiometry(table)
    for name in names:
        lamp = lamps.power[lamps.names.index(name)][None]
        answer = table.spectrum(table.rgb(lamp))
        grey = lab(GREY * answer @ radiometry, lamp @ radiometry)
        yield {
            "lamp": name,
            "spectrum": float(np.abs(answer - lamp).max() / lamp.max()),
            "grey": float(np.hypot(grey[0, 1], grey[0, 2])),
            "checker": float(relit_delta_e(lamp, answer, reflectances, radiometry).mean()),
        }
    white = table.spectrum(np.ones((1, 3)))
    d65 = lamps.power[lamps.names.index("D65")][None]
    grey_rgb = table.rgb(GREY * white)[0]
    yield {
        "lamp": "RGB (1, 1, 1), to D65",
        "spectrum": float(np.abs(white - d65).max() / d65.max()),
        "grey": float(np.ptp(grey_rgb)),
        "checker": float(relit_delta_e(d65, white, reflectances, radiometry).mean()),
    }


def _radiometry(table: EmissionTable) -> Array:
    return np.asarray(table.data.cmfs / table.data.cmfs[:, 1].sum())
