"""Expected errors on measured materials of the colours that a cube has under a light.

A cube with the left-out entries of its atlas states those of materials like the
entries. Without them, each family of measured materials of the library is predicted by
a cube that does not know it (docs/prior.md).
"""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry import Sensor, delta_e_spectra, in_unit_cube, observer
from uplift.colorimetry.illuminants import Illuminant
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.fit import shipped_library
from uplift.lookup import Cube
from uplift.lookup.errors_under_lights import evidence
from uplift.pipeline.build import build
from uplift.pipeline.options import recorded_options

DIM = 16
"""Nodes along each axis of the cubes that do not know a family."""
NOT_MEASURED = ("otsu2018",)
"""Families of the library that stand for measurements, and are none."""
BOUND = 0.95
REPEATED = (
    "model",
    "coefficients",
    "warp",
    "space",
    "illuminant",
    "observer",
    "shortest",
    "longest",
    "step",
    "prior",
)
"""Options of a cube that decide its spectra without an atlas."""


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


def material_error(cube: Cube, light: Illuminant) -> MaterialError:
    """Return the expected error of a cube's colours under a light.

    The cube has an XYZ sensor. Without left-out entries several small cubes are built,
    which takes seconds.
    """
    sensor = cube.data.sensor
    lit = observer.light(light, sensor.observer, *sensor.range)
    try:
        measured, predicted = evidence(cube.data)
        like_atlas = True
    except OptionError:
        measured, predicted = left_out_families(cube)
        like_atlas = False
    errors = delta_e_spectra(lit, predicted, measured)
    mean = float(errors.mean())
    return MaterialError(
        mean, float(np.quantile(errors, BOUND)), len(errors), like_atlas
    )


def left_out_families(cube: Cube) -> tuple[Array, Array]:
    """Return reflectances (M, N) of the families, measured and predicted by cubes that
    do not know the family.
    """
    provenance = cube.data.provenance
    known = {family["name"] for family in provenance.get("families", ())}
    recorded = recorded_options(provenance["options"])
    options = {name: recorded[name] for name in REPEATED if name in recorded}
    unknown = recorded["leave_out"]
    measured = []
    predicted = []
    for family in shipped_library(NOT_MEASURED):
        rows, rgb = _inside(cube.data.sensor, family.measured)
        unaware = cube
        if family.name in known:
            leave_out = (*unknown, family.name)
            unaware = build(dim=DIM, leave_out=leave_out, **options)
        measured.append(rows)
        predicted.append(unaware.reflectance(rgb, cube.data.sensor.wavelengths))
    return np.concatenate(measured), np.concatenate(predicted)


def _inside(sensor: Sensor, measured: Array) -> tuple[Array, Array]:
    """Return spectra at the wavelengths of a sensor and their RGB, of those inside its
    space.
    """
    at = sensor.wavelengths
    spectra = np.stack([np.interp(at, observer.grid(), row) for row in measured])
    rgb = sensor.rgb(spectra)
    rows = in_unit_cube(rgb)
    return spectra[rows], np.clip(rgb[rows], 0, 1)
