"""Every way of mixing RGB by name, to be set side by side: through a cube's spectra, and the heuristics without."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from uplift.common.arrays import Array
from uplift.design.mixing import additive, amy, dyes, filters, kubelka_munk, phosphors, pigments, ryb, surface
from uplift.lookup import Cube

Mix = Callable[[Array, Array], Array]
"""From what is mixed (n, K) and parts (…, n) to the mixture (…, K)."""


@dataclass(frozen=True, eq=False)
class Mixer:
    """``mix`` takes linear RGB (n, 3) and parts (…, n) to linear RGB (…, 3), which may leave the space."""

    name: str
    title: str
    mix: Mix


OIL = surface.perpendicular(1.5)
SPECTRAL: dict[str, tuple[str, Mix]] = {
    "pigments": (
        "Kubelka–Munk, S = √R",
        lambda spectra, parts: kubelka_munk.hiding(pigments.of_hiding(spectra).mixed(parts)),
    ),
    "pigments in oil": (
        "Kubelka–Munk, S = √R, in oil (index 1.5)",
        lambda spectra, parts: OIL.seen(
            kubelka_munk.hiding(pigments.of_hiding(np.clip(OIL.beneath(spectra), 0, 1)).mixed(parts))
        ),
    ),
    "pigments, one constant": (
        "Kubelka–Munk, S = 1",
        lambda spectra, parts: kubelka_munk.hiding(pigments.of_hiding(spectra, 0).mixed(parts)),
    ),
    "pigments, Amy": (
        "Amy's approximation",
        lambda spectra, parts: amy.hiding(pigments.of_hiding(spectra).mixed(parts)),
    ),
    "dyes": (
        "dyes on white",
        lambda spectra, parts: dyes.in_contact(
            dyes.transmittance(dyes.mixed(dyes.of_reflectance(spectra), parts)), 1.0
        ),
    ),
    "filters": ("filters", filters.stacked),
}
"""From spectra to a spectrum."""

RGB: dict[str, tuple[str, Mix]] = {
    "average": ("average of RGB", additive.dots),
    "product": ("product of RGB", filters.stacked),
    "ryb": ("RYB-HSL", lambda rgb, parts: ryb.mixed(np.clip(rgb, 0, 1), parts)),
}
"""Without spectra: (8.3), (9.2) and 10.4."""


def mixers(cube: Cube) -> tuple[Mixer, ...]:
    """All of them; the spectral ones uplift by ``cube``, and answer under its illuminant."""
    ours = [Mixer(name, title, _through(cube, mix)) for name, (title, mix) in SPECTRAL.items()]
    theirs = [Mixer(name, title, mix) for name, (title, mix) in RGB.items()]
    screen = phosphors.monitor()
    return (*ours, *theirs, Mixer("phosphors", "phosphor curves", screen.filtered))


def _through(cube: Cube, mix: Mix) -> Mix:
    return lambda rgb, parts: cube.data.sensor.rgb(mix(cube.reflectance(rgb), parts))
