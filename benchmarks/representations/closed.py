"""Riemann sums over closed cells, the literal reading of eq. 5.3 of Kment 2011: samples on a border count twice."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from benchmarks.representations.thesis import Printed
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.lab.comparison.measure import error_statistics
from uplift.lab.comparison.scene import Scene
from uplift.scene.representations.composite import ENHANCED_THRESHOLD, Composite, enhanced_riemann
from uplift.scene.representations.samples import (
    TABLE_STRIDE,
    SampleRepresentation,
    riemann_sums,
    wavelengths,
    xyz_weights,
)

COUNTS = (8, 16, 32)


def measure(scene: Scene, thesis: Mapping[tuple[str, str], Printed]) -> list[dict[str, Any]]:
    """Return mean ΔE00 of plain and enhanced sums with disjoint and with closed cells, and of the thesis."""
    pairs: list[tuple[Any, Any]] = [(riemann_sums(count), closed(count)) for count in COUNTS]
    pairs += [(enhanced_riemann(count), enhanced(count)) for count in COUNTS]
    return [
        {
            "lights": part.name,
            "name": one.name,
            "disjoint": error_statistics(one, scene, part).mean,
            "closed": error_statistics(other, scene, part).mean,
            "thesis": thesis[part.name, one.name].mean,
        }
        for part in scene.sets
        for one, other in pairs
    ]


def closed(count: int) -> SampleRepresentation:
    """Return means over closed cells; XYZ by the colour-matching functions at 5 nm, shared between cells."""
    inside = _cells(count)
    encoder = np.zeros((len(wavelengths()), count))
    encoder[::TABLE_STRIDE] = (inside / inside.sum(axis=1, keepdims=True)).T
    weights = (inside / inside.sum(axis=0)) @ (xyz_weights()[::TABLE_STRIDE] * TABLE_STRIDE)
    return SampleRepresentation(f"RS{count}", "Riemann sums, closed cells", encoder, weights)


def enhanced(count: int) -> Composite:
    """Return enhanced sums over the same cells; a spike on a border is multiplied by the mean of both."""
    inside = _cells(count)
    family = "enhanced Riemann sums, closed cells"
    return Composite(f"RE{count}", family, closed(count), inside / inside.sum(axis=0), ENHANCED_THRESHOLD)


def _cells(count: int) -> Array:
    """Return (count, 81) whether a sample of the 5 nm table lies in a cell."""
    edges = np.linspace(observer.START, observer.END, count + 1)
    low, high = edges[:-1, None] - 1e-9, edges[1:, None] + 1e-9
    return ((observer.grid() >= low) & (observer.grid() <= high)).astype(float)
