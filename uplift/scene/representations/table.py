"""Lights as 5 nm tables, for representations that compress reflectances only."""

from __future__ import annotations

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.models.model import Model, reflectance
from uplift.scene.representations.dense import TABLE_STRIDE
from uplift.scene.representations.samples import row_sizes
from uplift.scene.representations.spikes import spike_xyz


class TabulatedProducts:
    """Base of models of reflectance: lights and products are tables (n, 81).

    A product evaluates the model at the 81 wavelengths of the light. It is not encoded again: no renderer does so, and
    the sigmoid could not represent it.
    """

    model: Model

    def encode_light(self, power: Array) -> Array:
        return power[:, ::TABLE_STRIDE]

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * reflectance(self.model, surface, observer.grid())

    def xyz(self, light: Array) -> Array:
        return light @ spike_xyz()

    def storage(self, code: Array) -> Array:
        return row_sizes(code)
