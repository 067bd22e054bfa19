"""Materials that the bands of passes are chosen for, and those that judge them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from uplift.atlas.atlas import Atlas
from uplift.atlas.resampling import on_grid
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.cube.file import digest
from uplift.extras.scene.advice import colour_areas
from uplift.extras.texture.scene_colours import Images
from uplift.fit.families import shipped_library
from uplift.lookup.cube import Cube

SEED = 5
"""Seed of the halves."""
MIN_MATERIALS = 4
"""Fewest materials, half of which judge the choice."""
FEW = 128
"""Materials of a scene below which the library is trained on as well."""


@dataclass(frozen=True, eq=False)
class Materials:
    """Reflectances (M, 81) in two halves that have none in common, and their origin.

    Parameters
    ----------
    training : ndarray, shape (M, 81)
        Reflectances at 380, 385, …, 780 nm that bands are chosen for.
    held_out : ndarray, shape (H, 81)
        Reflectances that state the errors.
    origin : mapping
        ``source``, ``names`` and, for colours of images, ``cube``, as JSON values.
    """

    training: Array
    held_out: Array
    origin: Mapping[str, Any] = field(default_factory=dict)


def halves(reflectances: Array) -> tuple[Array, Array]:
    """Divide reflectances (M, 81) at random, the same way every time."""
    order = np.random.default_rng(SEED).permutation(len(reflectances))
    first = (len(order) + 1) // 2
    return reflectances[order[:first]], reflectances[order[first:]]


def library_materials() -> Materials:
    """Return the shipped families of measured materials, each in halves.

    Returns
    -------
    Materials
    """
    families = shipped_library()
    pairs = [halves(family.measured) for family in families]
    names = [family.name for family in families]
    training = np.concatenate([first for first, _ in pairs])
    held_out = np.concatenate([second for _, second in pairs])
    return Materials(training, held_out, {"source": "library", "names": names})


def scene_materials(
    atlases: Mapping[str, Atlas], images: Images | None, cube: Cube
) -> Materials:
    """Return the materials of a scene: entries of atlases by name, and the spectra that
    a cube has for the colours of images.

    A scene of few materials is trained on together with the library, half of the paths
    over each.

    Parameters
    ----------
    atlases : mapping of str to Atlas
        Atlases by name.
    images : Images or None
        Images of the scene.
    cube : Cube
        Cube in which the colours of images are looked up.

    Returns
    -------
    Materials

    Raises
    ------
    OptionError
        There are fewer than four materials.
    TextureError, ColourError
        An image cannot be read.
    """
    grid = observer.grid()
    parts = [on_grid(atlas, grid) for atlas in atlases.values()]
    names = list(atlases)
    origin: dict[str, Any] = {"source": "scene", "names": names}
    if images is not None:
        colours = colour_areas(images, cube.data.sensor)
        parts.append(cube.reflectance(colours.rgb, grid))
        names += [path.name for path in images.paths]
        origin["cube"] = digest(cube.data)
    reflectances = np.clip(np.concatenate(parts), 0, 1)
    if len(reflectances) < MIN_MATERIALS:
        raise OptionError(
            f"materials must be at least {MIN_MATERIALS}, got {len(reflectances)}",
            hint="add an atlas or an image, or take the library",
        )
    training, held_out = halves(reflectances)
    if len(training) < FEW:
        training = _with_library(training)
    return Materials(training, held_out, origin)


def _with_library(training: Array) -> Array:
    """Append the training half of the library, and repeat the materials until they are
    as many.
    """
    library = library_materials().training
    repeats = -(-len(library) // len(training))
    return np.concatenate([np.tile(training, (repeats, 1)), library])
