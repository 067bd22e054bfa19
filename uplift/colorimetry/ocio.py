"""Colour spaces by the names of OpenColorIO: of the configuration in ``$OCIO``, and of the built-in one of ACES."""

from __future__ import annotations

import contextlib
import functools
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import Primaries
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

VARIABLE = "OCIO"
"""Environment variable with the path of a configuration."""
BUILT_IN = "ocio://studio-config-latest"
REFERENCE = "ACES2065-1"
AP0 = Primaries((0.7347, 0.2653), (0.0, 1.0), (0.0001, -0.077), (0.32168, 0.33767))
"""Primaries of the reference (SMPTE ST 2065-1)."""


@dataclass(frozen=True, eq=False)
class OcioSpace:
    """A colour space of a configuration."""

    name: str
    """Its name in the configuration."""
    is_linear: bool
    """Whether its values are linear."""
    processor: Any
    """CPU processor to linear RGB of `AP0`."""

    def to_ap0(self, values: Array) -> Array:
        """Convert values. Shapes: ``values`` (…, 3) → (…, 3)."""
        converted = np.array(values, dtype=np.float32, order="C")
        if converted.size:
            self.processor.applyRGB(converted.reshape(-1, 3))
        return converted.astype(float)


def find_ocio_space(name: str, *, built_in: bool = True) -> OcioSpace | None:
    """Find a colour space by name, alias or role."""
    places = [os.environ.get(VARIABLE, "")] + ([BUILT_IN] if built_in else [])
    for place in filter(None, places):
        config = _configuration(place)
        space = config.getColorSpace(name) if name.isprintable() else None
        if space is not None and not space.isData():
            return _space(config, space, place)
    return None


def ocio_names() -> Iterable[str]:
    """Return the names of the colour spaces of the built-in configuration, for suggestions."""
    return tuple(_configuration(BUILT_IN).getColorSpaceNames())


@functools.lru_cache(maxsize=4)
def _configuration(place: str) -> Any:
    import PyOpenColorIO

    with _usable(place):
        return PyOpenColorIO.Config.CreateFromFile(place)


def _space(config: Any, space: Any, place: str) -> OcioSpace:
    import PyOpenColorIO

    with _usable(place):
        processor = PyOpenColorIO.Config.GetProcessorToBuiltinColorSpace(config, space.getName(), REFERENCE)
        cpu = processor.getOptimizedCPUProcessor(PyOpenColorIO.OPTIMIZATION_LOSSLESS)
    return OcioSpace(space.getName(), space.getEncoding() == "scene-linear", cpu)


@contextlib.contextmanager
def _usable(place: str) -> Iterator[None]:
    """Translate the exceptions of OpenColorIO to `OptionError`."""
    import PyOpenColorIO

    try:
        yield
    except PyOpenColorIO.Exception as error:
        reason = " ".join(str(error).split())
        raise OptionError(
            f"the configuration of OpenColorIO cannot be used: {reason}",
            path=place,
            hint="correct the environment variable OCIO, or unset it to use the built-in configuration",
        ) from error
