"""Composite models: a smooth part in few coefficients, and spikes.

Sun, Drew & Fracchia 1999, "Representing spectral functions by a composite model of smooth and spiky components for
efficient full-spectrum photorealism"; Kment 2011, section 5.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.representations.representation import Representation
from uplift.scene.representations.spikes import Spikes, heights_at, spike_xyz, split_spikes


class CompositeCode(NamedTuple):
    """Code (n, C) of the smooth part, and the spikes."""

    smooth: Array
    spikes: Spikes


@dataclass(frozen=True, eq=False)
class Composite:
    """Smooth part in another representation, and spikes steeper than a threshold.

    In a product, a spike meets the spike and the smooth part of the other spectrum at its position.

    Parameters
    ----------
    name, family : str
        See `Representation`.
    smooth : Representation
        Representation of the smooth part, whose codes are arrays (n, C).
    decoder : ndarray, shape (C, 81)
        ``code @ decoder`` is the smooth part at 5 nm.
    threshold : float
        Largest relative gradient of the smooth part between samples of the 5 nm table.
    """

    name: str
    family: str
    smooth: Representation
    decoder: Array
    threshold: float

    def encode_light(self, power: Array) -> CompositeCode:
        rest, spikes = split_spikes(power, self.threshold)
        return CompositeCode(self.smooth.encode_light(rest), spikes)

    def encode_surface(self, reflectance: Array) -> CompositeCode:
        rest, spikes = split_spikes(reflectance, self.threshold)
        return CompositeCode(self.smooth.encode_surface(rest), spikes)

    def multiply(self, light: CompositeCode, surface: CompositeCode) -> CompositeCode:
        positions = np.union1d(light.spikes.positions, surface.spikes.positions)
        of_light, of_surface = heights_at(light.spikes, positions), heights_at(surface.spikes, positions)
        below_light, below_surface = (code.smooth @ self.decoder[:, positions] for code in (light, surface))
        heights = of_light * (below_surface + of_surface) + below_light * of_surface
        return CompositeCode(self.smooth.multiply(light.smooth, surface.smooth), Spikes(positions, heights))

    def xyz(self, light: CompositeCode) -> Array:
        return self.smooth.xyz(light.smooth) + light.spikes.heights @ spike_xyz()[light.spikes.positions]

    def storage(self, code: CompositeCode) -> Array:
        return self.smooth.storage(code.smooth) + code.spikes.storage
