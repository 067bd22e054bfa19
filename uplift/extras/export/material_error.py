"""Expected errors on measured materials of the colours that a cube has under a light.

A cube with the left-out entries of its atlas states those of materials like the
entries, another those of families that it was not to know (docs/prior.md).
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.colorimetry.illuminants import Illuminant
from uplift.lookup.cube import Cube
from uplift.lookup.errors_under_lights import evidence, has_evidence

BOUND = 0.95


@dataclass(frozen=True)
class MaterialError:
    """Errors under a light, ΔE00 from the colours of measured materials."""

    mean: float
    bound: float
    """95 % of the materials are within it."""
    count: int
    like_atlas: bool
    """Whether the materials are entries of the atlas, or families of the library."""

    def __str__(self) -> str:
        materials = "like its atlas" if self.like_atlas else "of unknown families"
        return (
            f"expected ΔE00 of materials {materials}: mean {self.mean:.2g}, 95 % "
            f"within {self.bound:.2g}"
        )


def material_error(cube: Cube, light: Illuminant) -> MaterialError | None:
    """Return the expected error of a cube's colours under a light.

    The cube has an XYZ sensor; None for one without left-out materials.
    """
    if not has_evidence(cube.data):
        return None
    sensor = cube.data.sensor
    lit = observer.light(light, sensor.observer, *sensor.range)
    known = evidence(cube.data)
    errors = delta_e_spectra(lit, known.left_out, known.measured)
    bound = float(np.quantile(errors, BOUND))
    return MaterialError(float(errors.mean()), bound, len(errors), known.family is None)
