"""The surface between air and vehicle: what it throws back of the light that comes, and of the light that leaves.

Outside, light falls perpendicularly (Fresnel, 9.3) or from everywhere (Duntley, 10.9); inside it is diffuse.
Saunderson's correction (10.10) leads from a reflectance as Kubelka and Munk have it, inside, to the one that is
seen, and back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError


def fresnel(index: float) -> float:
    """Reflectance of a perpendicular beam (9.3), from either side; ``index`` of refraction against air's, 1 or more."""
    return ((_index(index) - 1) / (index + 1)) ** 2


def diffuse(index: float) -> float:
    """Reflectance of light from everywhere, falling on the denser side: Fresnel's, integrated (10.9).

    S. Q. Duntley 1942, J. Opt. Soc. Am. 32(2). The thesis prints 8n + 1² where 6 (n + 1)² belongs; the tests
    integrate.
    """
    n = _index(index)
    if n == 1:
        return 0.0
    n2, n4 = n**2, n**4
    return float(
        0.5
        + (n - 1) * (3 * n + 1) / (6 * (n + 1) ** 2)
        + n2 * (n2 - 1) ** 2 / (n2 + 1) ** 3 * np.log((n - 1) / (n + 1))
        - 2 * n**3 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1))
        + 8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) ** 2) * np.log(n)
    )


def inside(index: float) -> float:
    """Reflectance of diffuse light from within: all beyond the critical angle, 1 − (1 − ρ) / n².

    D. B. Judd 1942, "Fresnel reflection of diffusely incident light", J. Res. NBS 29: 0.596 for an index of 1.5.
    """
    return 1 - (1 - diffuse(index)) / index**2


@dataclass(frozen=True)
class Surface:
    """Reflectance of what comes from outside, and of diffuse light from inside, both in [0, 1)."""

    outside: float = 0.0
    inside: float = 0.0

    def __post_init__(self) -> None:
        for value in (self.outside, self.inside):
            if not 0 <= value < 1:
                raise OptionError(f"a surface that reflects {value}", hint="give numbers from 0 to below 1")

    def seen(self, beneath: ArrayLike) -> Array:
        """Reflectance (…) from outside, of what has reflectance (…) ``beneath`` the surface (10.10)."""
        beneath = np.asarray(beneath, dtype=float)
        through = (1 - self.outside) * (1 - self.inside)
        return self.outside + through * beneath / (1 - self.inside * beneath)

    def beneath(self, seen: ArrayLike) -> Array:
        """Back: (10.10) solved for the reflectance beneath. Below 0 where less is seen than the surface throws back."""
        rest = np.asarray(seen, dtype=float) - self.outside
        return rest / ((1 - self.outside) * (1 - self.inside) + self.inside * rest)


NONE = Surface()
"""Vehicle and air alike, or reflectances that are meant without it."""


def perpendicular(index: float) -> Surface:
    """Light falls on the surface perpendicularly."""
    return Surface(fresnel(index), inside(index))


def overcast(index: float) -> Surface:
    """Light falls on the surface from everywhere."""
    return Surface(diffuse(index), inside(index))


INCIDENT = {"perpendicular": perpendicular, "diffuse": overcast}
"""How light falls, by name."""


def _index(index: float) -> float:
    if not (np.isfinite(index) and index >= 1):
        raise OptionError(f"index of refraction {index}", hint="give 1 or more: 1.5 is linseed oil")
    return index
