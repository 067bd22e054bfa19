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

from typing import Any

import lazy_loader

from uplift.common.extensions import register

_public_name, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

register("cameras", "files", "uplift.extras.colour.camera_file:read_camera")
register("errors", "limits", "uplift.extras.looks.metamer_bounds:limit_errors")
register("formats", "measurements", "uplift.extras.formats:FORMATS")
register(
    "growth", "coarse-to-fine", "uplift.extras.thesis.growth_coarse:grow_coarse_to_fine"
)
register(
    "growth",
    "neighbours",
    "uplift.extras.thesis.growth_neighbours:grow_from_neighbours",
)
register("solver", "stock", "uplift.extras.thesis.stock_solvers:as_method")
register("looks", "targets", "uplift.extras.looks.targets:targets_of")
register("spaces", "of OpenColorIO", "uplift.extras.colour.spaces:look_up_space")
register("scene", "images", "uplift.extras.texture.scene_colours:as_images")


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from uplift.common.version import version

        return version()
    return _public_name(name)
