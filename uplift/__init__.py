"""Spectral uplifting cubes: linear RGB in, measured or plausible reflectance spectra
out.

::

    import uplift

    cube = uplift.build("macbeth", dim=32)
    cube.save("macbeth.uplift")

    cube = uplift.load("macbeth.uplift")
    cube.reflectance([0.8, 0.2, 0.1], wavelengths=range(380, 781, 5))

``import uplift`` loads the registry of parts and no other module of the package. The
first use of a name below imports its module; a part that the core does not have, such
as an order of growth, is imported when a build uses it.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from uplift.common.extensions import register

if TYPE_CHECKING:
    from uplift import bulk
    from uplift.atlas.atlas import Atlas, Entry
    from uplift.atlas.sources import read_atlas, write_atlas
    from uplift.common.errors import (
        AtlasError,
        ChartFileError,
        ColourError,
        CubeFileError,
        LookError,
        OptionError,
        OutputError,
        PaintError,
        PaletteError,
        PassesError,
        PlanFileError,
        TextureError,
        UnknownNameError,
        UpliftError,
        UpliftWarning,
    )
    from uplift.extras.emission.build import build_emission
    from uplift.extras.emission.lamps import read_lamp
    from uplift.extras.emission.lookup import EmissionTable, load_emission
    from uplift.extras.looks.look import Look, read_looks
    from uplift.lookup.cube import Cube, load
    from uplift.pipeline.build import build

__all__ = [
    "Atlas",
    "AtlasError",
    "ChartFileError",
    "ColourError",
    "Cube",
    "CubeFileError",
    "EmissionTable",
    "Entry",
    "Look",
    "LookError",
    "OptionError",
    "OutputError",
    "PaintError",
    "PaletteError",
    "PassesError",
    "PlanFileError",
    "TextureError",
    "UnknownNameError",
    "UpliftError",
    "UpliftWarning",
    "build",
    "build_emission",
    "bulk",
    "load",
    "load_emission",
    "read_atlas",
    "read_lamp",
    "read_looks",
    "write_atlas",
]

_EXPORTS = {
    "uplift.atlas": ("Atlas", "Entry", "read_atlas", "write_atlas"),
    "uplift.extras.emission.build": ("build_emission",),
    "uplift.extras.emission.lamps": ("read_lamp",),
    "uplift.extras.emission.lookup": ("EmissionTable", "load_emission"),
    "uplift.lookup": ("Cube", "load"),
    "uplift.pipeline.build": ("build",),
    "uplift.extras.looks.look": ("Look", "read_looks"),
}
_HOMES = dict[str, str]()
for _module, _names in _EXPORTS.items():
    _HOMES |= dict.fromkeys(_names, _module)

register("cameras", "files", "uplift.extras.colour.camera_file:read_camera")
register("errors", "limits", "uplift.extras.looks.metamer_bounds:limit_errors")
register("formats", "measurements", "uplift.extras.formats:FORMATS")
register("growth", "coarse-to-fine", "uplift.extras.thesis:grow_coarse_to_fine")
register("growth", "neighbours", "uplift.extras.thesis:grow_from_neighbours")
register("solver", "stock", "uplift.extras.thesis:as_method")
register("looks", "targets", "uplift.extras.looks.targets:targets_of")
register("spaces", "of OpenColorIO", "uplift.extras.colour.spaces:look_up_space")
register("scene", "images", "uplift.extras.texture.scene_colours:as_images")


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return importlib.import_module("uplift.common.version").version()
    if name == "bulk":
        return importlib.import_module("uplift.bulk")
    if name not in __all__:
        raise AttributeError(f"module 'uplift' has no attribute '{name}'")
    return getattr(
        importlib.import_module(_HOMES.get(name, "uplift.common.errors")), name
    )


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
