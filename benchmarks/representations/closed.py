"""Riemann sums as eq. 5.3 of Kment 2011 reads at its word: a table's sample on a border counts in both cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.lab.comparison.measure import error_statistics
from uplift.lab.comparison.scene import Scene
from uplift.lab.comparison.statistics import Statistics
from uplift.scene.representations import enhanced_riemann
from uplift.scene.representations.composite import Composite
from uplift.scene.representations.dense import TABLE_STRIDE, wavelengths, xyz_weights
from uplift.scene.representations.riemann_sums import riemann_sums
from uplift.scene.representations.samples import SampleRepresentation

COUNTS = (8, 16, 32)


@dataclass(frozen=True)
class Closed:
    """The errors of a representation under a set of lights, by both readings."""

    lights: str
    name: str
    disjoint: Statistics
    closed: Statistics

    @property
    def key(self) -> tuple[str, str]:
        return self.lights, self.name


def both(scene: Scene) -> list[Closed]:
    """Plain and enhanced sums by both readings, under every set of lights."""
    pairs: list[tuple[Any, Any]] = [(riemann_sums(count), closed(count)) for count in COUNTS]
    pairs += [(enhanced_riemann.enhanced_riemann(count), enhanced(count)) for count in COUNTS]
    return [
        Closed(part.name, one.name, error_statistics(one, scene, part), error_statistics(other, scene, part))
        for part in scene.sets
        for one, other in pairs
    ]


def closed(count: int) -> SampleRepresentation:
    """Means over closed cells; XYZ by the colour-matching functions at 5 nm, each sample shared by its cells."""
    inside = _cells(count)
    encoder = np.zeros((len(wavelengths()), count))
    encoder[::TABLE_STRIDE] = (inside / inside.sum(axis=1, keepdims=True)).T
    weights = (inside / inside.sum(axis=0)) @ (xyz_weights()[::TABLE_STRIDE] * TABLE_STRIDE)
    return SampleRepresentation(f"RS{count}", "Riemann sums, closed cells", encoder, weights)


def enhanced(count: int) -> Composite:
    """The enhanced sums over the same cells; a spike on a border meets the mean of both."""
    inside = _cells(count)
    family = "enhanced Riemann sums, closed cells"
    return Composite(
        f"RE{count}", family, closed(count), inside / inside.sum(axis=0), enhanced_riemann.THRESHOLD
    )


def _cells(count: int) -> Array:
    """(count, 81) whether a sample of the 5 nm table lies in a cell."""
    edges = np.linspace(observer.START, observer.END, count + 1)
    low, high = edges[:-1, None] - 1e-9, edges[1:, None] + 1e-9
    return ((observer.grid() >= low) & (observer.grid() <= high)).astype(float)
