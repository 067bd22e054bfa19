"""Spectral uplifting cubes: linear RGB in, measured or plausible reflectance spectra out.

    import uplift

    cube = uplift.build("atlases/macbeth.txt", dim=32)
    cube.save("macbeth.uplift")

    cube = uplift.load("macbeth.uplift")
    cube.reflectance([0.8, 0.2, 0.1], wavelengths=range(380, 781, 5))

Importing this module is light and changes nothing; each name below brings in what it needs when it is used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from uplift.atlas import Atlas, read_atlas, write_atlas
    from uplift.common.errors import UpliftError, UpliftWarning
    from uplift.lookup import Cube, load
    from uplift.pipeline import build

__all__ = [
    "Atlas",
    "Cube",
    "UpliftError",
    "UpliftWarning",
    "build",
    "load",
    "read_atlas",
    "write_atlas",
]

_HOMES = {
    "Cube": "uplift.lookup",
    "Atlas": "uplift.atlas",
    "UpliftError": "uplift.common.errors",
    "UpliftWarning": "uplift.common.errors",
    "build": "uplift.pipeline",
    "load": "uplift.lookup",
    "read_atlas": "uplift.atlas",
    "write_atlas": "uplift.atlas",
}


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version  # a tenth of a query's time

        return version("uplift")
    if name not in _HOMES:
        raise AttributeError(f"module 'uplift' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
