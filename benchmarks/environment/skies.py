"""Environments made of measured lamps: spectra per pixel, so that the truth is known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.observer import lamps
from uplift.common.arrays import Array

HEIGHT, WIDTH = 16, 32
"""Pixels of an environment, which has no sharp edges."""
DUSK, NIGHT, SUN = 1.0, 0.02, 60.0


@dataclass(frozen=True)
class Lamp:
    """A lamp of colour-science on an environment: a soft spot at ``(u, v)`` of ``size``, in shares of the height."""

    name: str
    u: float
    v: float
    size: float
    luminance: float


@dataclass(frozen=True)
class Sky:
    """A name, the light of the whole sphere and its luminance, and lamps."""

    name: str
    ambient: str
    luminance: float
    lamps: tuple[Lamp, ...]

    @property
    def lamp_names(self) -> tuple[str, ...]:
        """Names of all its lights."""
        return self.ambient, *(lamp.name for lamp in self.lamps)

    def power(self) -> Array:
        """Return the power (height, width, N) of luminance as stated, at the wavelengths of `lamps`."""
        known = lamps()
        spectra = dict(zip(known.names, known.power, strict=True))
        v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
        v, u = (v + 0.5) / HEIGHT, (u + 0.5) / HEIGHT
        total = self.luminance * np.ones((HEIGHT, WIDTH, 1)) * spectra[self.ambient]
        for lamp in self.lamps:
            across = np.minimum(np.abs(u - lamp.u), WIDTH / HEIGHT - np.abs(u - lamp.u))
            spot = np.exp(-(across**2 + (v - lamp.v) ** 2) / (2 * lamp.size**2))
            total = total + lamp.luminance * spot[..., None] * spectra[lamp.name]
        return np.asarray(total)


SKIES = (
    Sky(
        "street at dusk",
        "D75",
        0.15,
        (Lamp("C100S54 (HPS)", 0.3, 0.35, 0.05, SUN), Lamp("Mercury", 1.4, 0.4, 0.04, SUN / 4)),
    ),
    Sky(
        "office",
        "T8 Polylux 4000",
        0.3,
        (Lamp("D65", 0.2, 0.5, 0.12, 6.0), Lamp("F34/CW/RS/EW (Cool White FL)", 1.2, 0.15, 0.08, 20.0)),
    ),
    Sky(
        "shop",
        "PHOS-2",
        0.1,
        (Lamp("LED-B1", 0.4, 0.3, 0.04, SUN), Lamp("LED-RGB1", 1.1, 0.35, 0.06, SUN / 3)),
    ),
)
