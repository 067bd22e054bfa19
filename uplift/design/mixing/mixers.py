"""All mixing models of RGB by name: spectral ones, by uplifting with a cube, and RGB heuristics."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.design.mixing import additive, amy, dyes, filters, kubelka_munk, phosphors, pigments, ryb, surface
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


def _mix_in_oil(spectra: Array, parts: Array) -> Array:
    internal = np.clip(OIL.remove(spectra), 0, 1)
    return OIL.apply(kubelka_munk.opaque_reflectance(pigments.from_opaque(internal).mix(parts)))


def _mix_dyes(spectra: Array, parts: Array) -> Array:
    absorption = dyes.mix(dyes.from_reflectance(spectra), parts)
    return dyes.reflectance_on_ground(dyes.transmittance(absorption), 1.0)


OIL = surface.normal_incidence(1.5)
SPECTRAL: dict[str, tuple[str, Mix]] = {
    "pigments": (
        "Kubelka–Munk, S = √R",
        lambda spectra, parts: kubelka_munk.opaque_reflectance(pigments.from_opaque(spectra).mix(parts)),
    ),
    "pigments in oil": ("Kubelka–Munk, S = √R, in oil (index 1.5)", _mix_in_oil),
    "pigments, one constant": (
        "Kubelka–Munk, S = 1",
        lambda spectra, parts: kubelka_munk.opaque_reflectance(pigments.from_opaque(spectra, 0).mix(parts)),
    ),
    "pigments, Amy": (
        "Amy's approximation",
        lambda spectra, parts: amy.opaque_reflectance(pigments.from_opaque(spectra).mix(parts)),
    ),
    "dyes": ("dyes on white", _mix_dyes),
    "filters": ("filters", filters.stack),
}
"""Models of spectra (title, function), by name."""

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
    spectral = [Mixer(name, title, _uplifted(cube, mix)) for name, (title, mix) in SPECTRAL.items()]
    heuristics = [Mixer(name, title, mix) for name, (title, mix) in RGB.items()]
    return (*spectral, *heuristics, Mixer("phosphors", "phosphor curves", phosphors.make_monitor().mix))


def _uplifted(cube: Cube, mix: Mix) -> Mix:
    return lambda rgb, parts: cube.data.sensor.rgb(mix(cube.reflectance(rgb), parts))
