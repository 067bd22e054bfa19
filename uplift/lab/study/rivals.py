"""Methods that compete with cubes without an atlas, and know the same spectra."""

from collections.abc import Collection, Sequence

import numpy as np

from uplift.colorimetry import Light, delta_e_2000, in_unit_cube, lab
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.extras.report.measures import delta_e_under
from uplift.fit import shipped_library
from uplift.lab.study.burns2019 import reconstruct
from uplift.lab.study.colour_maps import DEGREES, fit_map
from uplift.lab.study.local_linear import local_linear
from uplift.lab.study.metamer_mean import metamer_mean

LIBRARY_REGRESSION = "local-linear regression of the library"
METAMER_MEAN = "mean of metamers"
BURNS = "Burns 2019"
"""Names of methods that have spectra."""
MAPS = tuple(DEGREES)
"""Names of methods that map colours."""
RIVALS = (*MAPS, LIBRARY_REGRESSION, METAMER_MEAN, BURNS)


def library_spectra(leave_out: Collection[str]) -> Array:
    """Reflectances (E, 81) of the shipped library without some families, by name."""
    families = shipped_library(leave_out)
    return np.concatenate([np.zeros((0, 81)), *(each.measured for each in families)])


def rival_errors(
    data: CubeData, known: Array, measured: Array, lights: Sequence[Light]
) -> dict[str, Array]:
    """ΔE00 (n, L) under lights, by method, of the colours of reflectances (n, N).

    Methods are given their colours under the illuminant of a cube, and know other
    reflectances (E, N).
    """
    build = data.sensor.light
    xyz = measured @ build.xyz.T
    errors = {}
    for name, degree in DEGREES.items():
        of_lights = []
        for light in lights:
            mapped = fit_map(degree, build, light, known)(xyz / build.white)
            actual = lab(measured @ light.xyz.T, light.white)
            of_lights.append(delta_e_2000(lab(mapped, np.ones(3)), actual))
        errors[name] = np.stack(of_lights, axis=1)
    in_space = in_unit_cube(data.sensor.rgb(known))
    rgb = np.clip(data.sensor.rgb(measured), 0, 1)
    spectra = {
        LIBRARY_REGRESSION: local_linear(data, known[in_space], rgb),
        METAMER_MEAN: metamer_mean(data, known, rgb),
        BURNS: reconstruct(build.xyz, xyz),
    }
    for name, reflectances in spectra.items():
        errors[name] = delta_e_under(lights, reflectances, measured)
    return errors
