"""Lights as renderers hold them beside compact reflectances: the 5 nm table, at which surfaces are evaluated."""

from __future__ import annotations

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.models.model import Model, reflectance
from uplift.scene.representations.dense import TABLE_STRIDE, hat_functions, xyz_weights
from uplift.scene.representations.samples import row_sizes


class TabulatedProducts:
    """What models of reflectance share: only ``surface`` is compact, lights and products are (n, 81).

    A product evaluates the model at the 81 wavelengths of the light. It is not made a model again: no renderer does,
    and the sigmoid could not hold it.
    """

    model: Model

    def encode_light(self, power: Array) -> Array:
        return power[:, ::TABLE_STRIDE]

    def multiply(self, light: Array, surface: Array) -> Array:
        return light * reflectance(self.model, surface, observer.grid())

    def xyz(self, light: Array) -> Array:
        return light @ (hat_functions(observer.grid()) @ xyz_weights())

    def storage(self, code: Array) -> Array:
        return row_sizes(code)
