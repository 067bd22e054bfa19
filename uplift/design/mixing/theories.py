"""All mixing models of RGB by name: spectral ones, by uplifting with a cube, and RGB heuristics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.design.mixing.amounts import as_shares, average_areas, stack_filters, weighted_sum
from uplift.design.mixing.coats import dye_absorption, dye_transmittance
from uplift.design.mixing.duntley import diffuse_reflectance, directed_reflectance
from uplift.design.mixing.heuristics import make_monitor, mix_ryb
from uplift.design.mixing.layers import Surface
from uplift.design.mixing.pigments import CONSTANT, SQUARE_ROOT, Pigment, Scattering, dispersive, from_opaque
from uplift.lookup import Cube

Mix = Callable[[Array, Array], Array]  # from components (..., n, K) and parts (..., n) to the mixture (..., K)
OIL = Surface.of_index(1.5)


@dataclass(frozen=True, eq=False)
class Mixer:
    """A mixing model."""

    name: str  # for programs
    title: str  # for readers
    mix: Mix  # from linear RGB (n, 3) and parts (..., n) to linear RGB (..., 3), which may leave the gamut


def mixers(cube: Cube) -> tuple[Mixer, ...]:
    """Return the spectral models, for colours uplifted by a cube, and the RGB heuristics."""
    sensor = cube.data.sensor

    def uplifted(mix: Mix) -> Mix:
        return lambda rgb, parts: sensor.rgb(mix(cube.reflectance(rgb), parts))

    heuristics = {
        "average": ("average of RGB", average_areas),  # Fishkin 1983, eq. 8.3
        "product": ("product of RGB", stack_filters),  # eq. 9.2
        "ryb": ("RYB-HSL", lambda rgb, parts: mix_ryb(np.clip(rgb, 0, 1), parts)),  # section 10.4
        "phosphors": ("phosphor curves", make_monitor().mix),  # chapter 7
    }
    return (
        *(Mixer(name, title, uplifted(mix)) for name, (title, mix) in spectral_models(sensor).items()),
        *(Mixer(name, title, mix) for name, (title, mix) in heuristics.items()),
    )


def spectral_models(sensor: Sensor) -> dict[str, tuple[str, Mix]]:
    """Return the models of spectra (title, function) at the wavelengths of a sensor, by name."""
    kubelka_munk = _paints(dispersive(sensor))

    def in_oil(spectra: Array, parts: Array) -> Array:
        return OIL.apply(kubelka_munk(np.clip(OIL.remove(spectra), 0, 1), parts))

    def in_directed_light(spectra: Array, parts: Array) -> Array:
        return directed_reflectance(kubelka_munk(diffuse_reflectance(spectra), parts))

    return {
        "pigments": ("Kubelka–Munk", kubelka_munk),
        "pigments in oil": ("Kubelka–Munk, in oil (index 1.5)", in_oil),
        "pigments, S = √R": ("Kubelka–Munk, S = √R", _paints(SQUARE_ROOT)),
        "pigments, S = 1": ("Kubelka–Munk, S = 1", _paints(CONSTANT)),
        "pigments, Amy": ("Amy's approximation", _paints(dispersive(sensor), Pigment.amy_opaque_reflectance)),
        "pigments, Duntley": ("Duntley, in directed light", in_directed_light),
        "dyes": ("dyes on white", _mix_dyes),
        "filters": ("filters", stack_filters),
    }


def _paints(scattering: Scattering, reflectance: Callable[[Pigment], Array] = Pigment.opaque_reflectance) -> Mix:
    return lambda spectra, parts: reflectance(from_opaque(spectra, scattering).mix(parts))


def _mix_dyes(spectra: Array, parts: Array) -> Array:
    absorption = weighted_sum(dye_absorption(spectra), as_shares(parts))
    return dye_transmittance(absorption, 1.0) ** 2
