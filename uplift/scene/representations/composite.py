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
from uplift.scene.representations import fourier_coefficients, riemann_sums
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.spikes import Spikes, split_spikes, spread, triangles

SUN_THRESHOLD, ENHANCED_THRESHOLD = 0.3, 0.2


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

    def encode_light(self, power: Array) -> Parts:
        rest, spikes = split_spikes(power, self.threshold)
        return Parts(self.smooth.encode_light(rest), spikes)

    def encode_surface(self, reflectance: Array) -> Parts:
        rest, spikes = split_spikes(reflectance, self.threshold)
        return Parts(self.smooth.encode_surface(rest), spikes)

    def multiply(self, light: Parts, surface: Parts) -> Parts:
        places = np.union1d(light.spikes.places, surface.spikes.places)
        one, other = spread(light.spikes, places), spread(surface.spikes, places)
        below_one, below_other = (parts.smooth @ self.decoder[:, places] for parts in (light, surface))
        heights = one * (below_other + other) + below_one * other
        return Parts(self.smooth.multiply(light.smooth, surface.smooth), Spikes(places, heights))

    def xyz(self, light: Parts) -> Array:
        return self.smooth.xyz(light.smooth) + light.spikes.heights @ triangles()[light.spikes.places]

    def storage(self, code: Parts) -> Array:
        return self.smooth.storage(code.smooth) + code.spikes.storage


def sun_composite(count: int) -> Composite:
    """Sun's, with ``count`` real Fourier coefficients."""
    waves = fourier_coefficients.fourier_coefficients(count)
    return Composite(f"CS{count}", "Sun's composite", waves, waves.waves[:, ::TABLE_STRIDE], SUN_THRESHOLD)


def enhanced_riemann(count: int) -> Composite:
    """Kment's, with ``count`` Riemann sums; a spike meets the mean of the cell that it lies in."""
    means = riemann_sums.cell_overlaps(count)[:, ::TABLE_STRIDE]
    return Composite(
        f"RE{count}", "enhanced Riemann sums", riemann_sums.riemann_sums(count), means, ENHANCED_THRESHOLD
    )
