"""Spectral pictures from an RGB renderer: three bands of wavelengths a pass, and a
matrix that decodes the pictures of all passes (docs/guides/passes.md).

Examples
--------
::

    from uplift.extras.scene import passes

    materials = passes.library_materials()
    chosen = passes.choose(materials, ["D65", "A"], count=2)
    passes.write_passes(chosen, "passes.toml")
"""

from uplift.extras.scene.passes.bands import Bands
from uplift.extras.scene.passes.file import (
    passes_digest,
    read_passes,
    to_toml,
    write_passes,
)
from uplift.extras.scene.passes.materials import (
    Materials,
    library_materials,
    scene_materials,
)
from uplift.extras.scene.passes.passes import (
    Passes,
    PassesLight,
    choose,
    fit_bands,
    scaled_power,
)

__all__ = [
    "Bands",
    "Materials",
    "Passes",
    "PassesLight",
    "choose",
    "fit_bands",
    "library_materials",
    "passes_digest",
    "read_passes",
    "scaled_power",
    "scene_materials",
    "to_toml",
    "write_passes",
]
