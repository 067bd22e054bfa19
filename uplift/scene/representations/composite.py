"""Composite models: a smooth part in few numbers, and the spikes upon it. Sun's (CS) and Kment's (RE).

Sun, Drew & Fracchia 1999, "Representing spectral functions by a composite model of smooth and spiky components for
efficient full-spectrum photorealism": Fourier coefficients. Kment 2011, 5.5: Riemann sums in their place, "enhanced
Riemann summations". The thresholds of the segmentation are those of Kment 2011, 6.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.representations import fourier, riemann
from uplift.scene.representations.dense import TABLE
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.spikes import Spikes, split, spread, triangles

SUN, ENHANCED = 0.3, 0.2


class Parts(NamedTuple):
    """A code: that of the smooth part, (n, C), and the spikes."""

    smooth: Array
    spikes: Spikes


@dataclass(frozen=True, eq=False)
class Composite:
    """Spikes steeper than ``threshold`` beside the smooth part as ``smooth`` holds it.

    ``decoder`` (C, 81) takes codes of the smooth part to the 5 nm table. In a product a spike meets what the other
    spectrum has at its place: its spike, and there its smooth part.
    """

    name: str
    family: str
    smooth: Representation
    decoder: Array
    threshold: float

    def light(self, power: Array) -> Parts:
        rest, spikes = split(power, self.threshold)
        return Parts(self.smooth.light(rest), spikes)

    def surface(self, reflectance: Array) -> Parts:
        rest, spikes = split(reflectance, self.threshold)
        return Parts(self.smooth.surface(rest), spikes)

    def product(self, light: Parts, surface: Parts) -> Parts:
        places = np.union1d(light.spikes.places, surface.spikes.places)
        one, other = spread(light.spikes, places), spread(surface.spikes, places)
        below_one, below_other = (parts.smooth @ self.decoder[:, places] for parts in (light, surface))
        heights = one * (below_other + other) + below_one * other
        return Parts(self.smooth.product(light.smooth, surface.smooth), Spikes(places, heights))

    def xyz(self, light: Parts) -> Array:
        return self.smooth.xyz(light.smooth) + light.spikes.heights @ triangles()[light.spikes.places]

    def floats(self, code: Parts) -> Array:
        return self.smooth.floats(code.smooth) + code.spikes.floats


def sun(count: int) -> Composite:
    """Sun's, with ``count`` real Fourier coefficients."""
    waves = fourier.fourier(count)
    return Composite(f"CS{count}", "Sun's composite", waves, waves.waves[:, ::TABLE], SUN)


def enhanced(count: int) -> Composite:
    """Kment's, with ``count`` Riemann sums; a spike meets the mean of the cell that it lies in."""
    means = riemann.cells(count)[:, ::TABLE]
    return Composite(f"RE{count}", "enhanced Riemann sums", riemann.riemann(count), means, ENHANCED)
