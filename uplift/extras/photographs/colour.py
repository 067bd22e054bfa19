"""One colour that is known under several lights, for `uplift.extras.colour.query`."""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.extras.photographs.answers import Photographs
from uplift.extras.photographs.errors import light_errors
from uplift.lookup.errors_under_lights import light_errors as errors_of_cube


@dataclass(frozen=True, eq=False)
class PhotographedColour:
    """A colour with its linear RGB (3 L,) in further photographs."""

    photographs: Photographs
    others: Array

    def spectra(self, rgb: Array, wavelengths: Array) -> Array:
        """Reflectance (n, N) at linear RGB (n, 3)."""
        others = np.tile(self.others, (len(rgb), 1))
        return self.photographs.answer(rgb, others, wavelengths=wavelengths).spectra

    def errors(self, rgb: Array, light: Light) -> Array:
        """Standard errors and error bounds (n, 2) under a light; those of the cube if
        the photographs contradict each other.
        """
        if self.contradicts(rgb):
            return errors_of_cube(self.photographs.cube.data, light)(rgb)
        return light_errors(self.photographs, light)(rgb)

    def contradicts(self, rgb: Array) -> bool:
        """Whether a photograph contradicts linear RGB (n, 3)."""
        others = np.tile(self.others, (len(rgb), 1))
        return bool(self.photographs.answer(rgb, others).contradicts.any())
