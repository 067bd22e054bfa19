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

from uplift.extras.scene.passes.bands import CHANNELS, Bands
from uplift.extras.scene.passes.camera import with_camera
from uplift.extras.scene.passes.choice import (
    choose,
    fit_bands,
    path_errors,
    rgb_errors,
)
from uplift.extras.scene.passes.decode import Decoded, decode_pictures
from uplift.extras.scene.passes.decoder import Decoder, decoder
from uplift.extras.scene.passes.file import (
    passes_digest,
    read_passes,
    to_toml,
    write_passes,
)
from uplift.extras.scene.passes.light_images import (
    prepare_light_pass,
    table_projection,
)
from uplift.extras.scene.passes.materials import (
    Materials,
    library_materials,
    scene_materials,
)
from uplift.extras.scene.passes.passes import (
    Passes,
    PassesCamera,
    PassesLight,
    scaled_power,
)
from uplift.extras.scene.passes.presets import PRESETS
from uplift.extras.scene.passes.recipe import (
    RECIPES,
    blender_recipe,
    nuke_recipe,
    plain_recipe,
)
from uplift.extras.scene.passes.settings import PassSettings
from uplift.extras.scene.passes.textures import check_cube, pass_name, prepare_pass

__all__ = [
    "CHANNELS",
    "PRESETS",
    "RECIPES",
    "Bands",
    "Decoded",
    "Decoder",
    "Materials",
    "PassSettings",
    "Passes",
    "PassesCamera",
    "PassesLight",
    "blender_recipe",
    "check_cube",
    "choose",
    "decode_pictures",
    "decoder",
    "fit_bands",
    "library_materials",
    "nuke_recipe",
    "pass_name",
    "passes_digest",
    "path_errors",
    "plain_recipe",
    "prepare_light_pass",
    "prepare_pass",
    "read_passes",
    "rgb_errors",
    "scaled_power",
    "scene_materials",
    "table_projection",
    "to_toml",
    "with_camera",
    "write_passes",
]
