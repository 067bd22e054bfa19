"""Test scene of a comparison: measured reflectances under sets of lights."""

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
from uplift.scene.representations.samples import STEP, wavelengths, xyz_weights

NAMED_SET = "given"
"""Name of the set of lights that a user lists."""
QUICK_SURFACES = 40
"""Surfaces of a quick comparison."""


@dataclass(frozen=True, eq=False)
class LightSet:
    """A set of lights.

    Parameters
    ----------
    name : str
        Name of the set.
    lights : tuple of str
        Names of K lights.
    powers : ndarray, shape (K, 401)
        Their relative powers, of luminance 1.
    """

    name: str
    lights: tuple[str, ...]
    powers: Array

    @property
    def title(self) -> str:
        """Return the name of the set with those of its lights."""
        return f"{self.name} lights ({', '.join(self.lights)})"

    @cached_property
    def whites(self) -> Array:
        """Return XYZ of the lights, (K, 3)."""
        return self.powers @ xyz_weights()

    def lab(self, xyz: Array) -> Array:
        """Convert XYZ to L*a*b*, relative to the white of each light.

        Parameters
        ----------
        xyz : ndarray, shape (K, E, 3)
            XYZ of E surfaces under each light.

        Returns
        -------
        ndarray, shape (K, E, 3)
            L*a*b*.
        """
        return lab(xyz / self.whites[:, None], np.ones(3))


@dataclass(frozen=True, eq=False)
class Scene:
    """Surfaces and the sets of lights that illuminate them.

    Parameters
    ----------
    names : tuple of str
        Names of E surfaces.
    surfaces : ndarray, shape (E, 401)
        Their reflectances.
    sets : tuple of LightSet
        Sets of lights.
    """

    names: tuple[str, ...]
    surfaces: Array
    sets: tuple[LightSet, ...]

    @property
    def powers(self) -> Array:
        """Return the powers of all lights, (L, 401)."""
        return np.concatenate([light_set.powers for light_set in self.sets])

    def reference(self, light_set: LightSet) -> Array:
        """Compute the colours of all surfaces from densely sampled products.

        Parameters
        ----------
        light_set : LightSet
            A set of K lights.

        Returns
        -------
        ndarray, shape (K, E, 3)
            L*a*b* of every surface under every light.
        """
        return light_set.lab((light_set.powers[:, None] * self.surfaces) @ xyz_weights())

    def thinned(self, count: int = QUICK_SURFACES) -> Scene:
        """Select at most ``count`` surfaces, evenly spaced.

        Parameters
        ----------
        count : int, default 40
            Largest number of surfaces.

        Returns
        -------
        Scene
            The smaller scene.
        """
        kept = np.unique(np.linspace(0, len(self.names) - 1, count).round().astype(np.intp))
        return replace(self, names=tuple(self.names[row] for row in kept), surfaces=self.surfaces[kept])


def make_scene(atlases: Mapping[str, Atlas], lights: Sequence[str] = ()) -> Scene:
    """Combine the entries of atlases with sets of lights.

    Parameters
    ----------
    atlases : mapping of str to Atlas
        Atlases by name.
    lights : sequence of str, optional
        Names of lights, by default the two sets of Kment 2011, section 5.4.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    AtlasError
        If the atlases have no entries, or two of the same name.
    UnknownNameError
        If a light is not in the tables.
    """
    merged = merge(atlases.values())
    if not merged.entries:
        raise AtlasError("the atlases have no entries", code="no-entries", hint="give an atlas of reflectances")
    named = {NAMED_SET: tuple(dict.fromkeys(lights))} if lights else KMENT_LIGHTS
    sets = tuple(LightSet(name, members, _powers(members)) for name, members in named.items())
    return Scene(merged.names, on_grid(merged, wavelengths()), sets)


def _powers(names: Sequence[str]) -> Array:
    powers = np.stack([observer.illuminant_spd(name, step=STEP) for name in names])
    return np.asarray(powers / (powers @ xyz_weights()[:, 1:2]))
