"""All mixing models of RGB by name: spectral ones, by uplifting with a cube, and RGB heuristics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.mixing import (
    additive,
    amy,
    duntley,
    dyes,
    filters,
    kubelka_munk,
    phosphors,
    pigments,
    ryb,
    scattering,
    surface,
)
from uplift.design.mixing.pigments import Pigment
from uplift.design.mixing.scattering import Scattering
from uplift.lookup import Cube

Mix = Callable[[Array, Array], Array]
"""From components (n, K) and parts (…, n) to the mixture (…, K)."""


@dataclass(frozen=True, eq=False)
class Mixer:
    """A mixing model.

    Parameters
    ----------
    name : str
        Name for programs.
    title : str
        Name for readers.
    mix : callable
        From linear RGB (n, 3) and parts (..., n) to linear RGB (..., 3), which may leave the gamut.
    """

    name: str
    title: str
    mix: Mix


OIL = surface.normal_incidence(1.5)


def spectral_models(sensor: Sensor) -> dict[str, tuple[str, Mix]]:
    """Return the models of spectra (title, function) at the wavelengths of a sensor, by name."""
    assumed = scattering.dispersive(sensor)
    return {
        "pigments": ("Kubelka–Munk", _pigments(assumed)),
        "pigments in oil": ("Kubelka–Munk, in oil (index 1.5)", partial(_mix_in_oil, assumed)),
        "pigments, S = √R": ("Kubelka–Munk, S = √R", _pigments(scattering.SQUARE_ROOT)),
        "pigments, S = 1": ("Kubelka–Munk, S = 1", _pigments(scattering.CONSTANT)),
        "pigments, Amy": ("Amy's approximation", _pigments(assumed, amy.opaque_reflectance)),
        "pigments, Duntley": ("Duntley, in directed light", partial(_mix_in_directed_light, assumed)),
        "dyes": ("dyes on white", _mix_dyes),
        "filters": ("filters", filters.stack),
    }


def _pigments(
    assumed: Scattering, opaque_reflectance: Callable[[Pigment], Array] = kubelka_munk.opaque_reflectance
) -> Mix:
    return lambda spectra, parts: opaque_reflectance(pigments.from_opaque(spectra, assumed).mix(parts))


def _mix_in_oil(assumed: Scattering, spectra: Array, parts: Array) -> Array:
    internal = np.clip(OIL.remove(spectra), 0, 1)
    return OIL.apply(_pigments(assumed)(internal, parts))


def _mix_in_directed_light(assumed: Scattering, spectra: Array, parts: Array) -> Array:
    return duntley.directed_reflectance(_pigments(assumed)(duntley.diffuse_reflectance(spectra), parts))


def _mix_dyes(spectra: Array, parts: Array) -> Array:
    absorption = dyes.mix(dyes.from_reflectance(spectra), parts)
    return dyes.reflectance_on_ground(dyes.transmittance(absorption), 1.0)


RGB: dict[str, tuple[str, Mix]] = {
    "average": ("average of RGB", additive.average_areas),
    "product": ("product of RGB", filters.stack),
    "ryb": ("RYB-HSL", lambda rgb, parts: ryb.mix(np.clip(rgb, 0, 1), parts)),
}
"""Models of RGB (title, function), by name: Fishkin 1983, eq. 8.3, 9.2 and section 10.4."""


def mixers(cube: Cube) -> tuple[Mixer, ...]:
    """Return all mixing models.

    Parameters
    ----------
    cube : Cube
        The cube that uplifts RGB for the spectral models. Results are under its illuminant.

    Returns
    -------
    tuple of Mixer
        Spectral models, RGB heuristics, and phosphor curves.
    """
    spectral = [
        Mixer(name, title, _uplifted(cube, mix)) for name, (title, mix) in spectral_models(cube.data.sensor).items()
    ]
    heuristics = [Mixer(name, title, mix) for name, (title, mix) in RGB.items()]
    return (*spectral, *heuristics, Mixer("phosphors", "phosphor curves", phosphors.make_monitor().mix))


def _uplifted(cube: Cube, mix: Mix) -> Mix:
    return lambda rgb, parts: cube.data.sensor.rgb(mix(cube.reflectance(rgb), parts))
