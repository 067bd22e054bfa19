"""What representations are asked to hold: measured reflectances, and the lights that they meet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from uplift.atlas import Atlas, merge, on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import lab
from uplift.colorimetry.lights import KMENT_LIGHTS
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError
from uplift.scene.representations.dense import STEP, wavelengths, xyz_weights

GIVEN = "given"
"""The set of lights that a user names."""
FEW = 40
"""Surfaces of a quick comparison."""


@dataclass(frozen=True, eq=False)
class LightSet:
    """Lights by name: relative powers (K, 401) of luminance 1."""

    name: str
    lights: tuple[str, ...]
    powers: Array

    @property
    def title(self) -> str:
        return f"{self.name} lights ({', '.join(self.lights)})"

    @cached_property
    def whites(self) -> Array:
        """(K, 3) XYZ of the lights."""
        return self.powers @ xyz_weights()

    def lab(self, xyz: Array) -> Array:
        """L*a*b* (K, E, 3) of XYZ (K, E, 3), each light's against its own white."""
        return lab(xyz / self.whites[:, None], np.ones(3))


@dataclass(frozen=True, eq=False)
class Scene:
    """Surfaces (E, 401) by name, and sets of lights that they are seen under."""

    names: tuple[str, ...]
    surfaces: Array
    sets: tuple[LightSet, ...]

    @property
    def powers(self) -> Array:
        """(L, 401) of all lights."""
        return np.concatenate([part.powers for part in self.sets])

    def reference(self, part: LightSet) -> Array:
        """L*a*b* (K, E, 3) of every surface under every light of a set, from the dense products."""
        return part.lab((part.powers[:, None] * self.surfaces) @ xyz_weights())

    def thinned(self, most: int = FEW) -> Scene:
        """The same with ``most`` surfaces at most, evenly from all."""
        kept = np.unique(np.linspace(0, len(self.names) - 1, most).round().astype(np.intp))
        return replace(self, names=tuple(self.names[row] for row in kept), surfaces=self.surfaces[kept])


def scene(atlases: Mapping[str, Atlas], lights: Sequence[str] = ()) -> Scene:
    """Every entry of the atlases, under ``lights`` or, without any, under the two sets of the thesis.

    Raises
    ------
    AtlasError : no entries, or two of one name.
    UnknownNameError : a light that there is no table of.
    """
    spectra = merge(atlases.values())
    if not spectra.entries:
        raise AtlasError("no entries to compare with", hint="name an atlas that holds reflectances")
    named = {GIVEN: tuple(dict.fromkeys(lights))} if lights else KMENT_LIGHTS
    sets = tuple(LightSet(name, members, _powers(members)) for name, members in named.items())
    return Scene(spectra.names, on_grid(spectra, wavelengths()), sets)


def _powers(names: Sequence[str]) -> Array:
    powers = np.stack([observer.illuminant_spd(name, step=STEP) for name in names])
    return np.asarray(powers / (powers @ xyz_weights()[:, 1:2]))
