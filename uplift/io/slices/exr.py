"""OpenEXR files of a cube: what their headers say, finite 32-bit channels, written whole or not at all."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.sensor import Sensor
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write
from uplift.cube.data import CubeData
from uplift.cube.file import digest
from uplift.lattice import Status

LARGEST = float(np.finfo(np.float32).max)


def attributes(data: CubeData) -> dict[str, Any]:
    """Header attributes that say which cube this is; numbers that are not whole have 32 bits there.

    ``uplift.cube`` is the digest of the cube's content, ``uplift.model`` its model as JSON.
    """
    return {
        "chromaticities": chromaticities(data.sensor),
        "uplift.cube": digest(data),
        "uplift.dim": data.lattice.dim,
        "uplift.model": json.dumps(data.model.describe(), sort_keys=True),
        "uplift.space": data.sensor.space,
        "uplift.illuminant": data.sensor.illuminant,
        "uplift.observer": data.sensor.observer,
        "uplift.threshold": float(data.threshold),
        "uplift.status": ", ".join(f"{status:d} {status.label}" for status in Status),
    }


def part(name: str, header: Mapping[str, Any], channels: Mapping[str, NDArray[Any]]) -> Any:
    """An `OpenEXR.Part` of planes (height, width). Raises `OutputError` for NaN."""
    import OpenEXR

    lossless = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    pixels = {channel: _float32(channel, plane) for channel, plane in channels.items()}
    return OpenEXR.Part({**lossless, **header}, pixels, name)


def write_parts(parts: Iterable[Any], path: str | os.PathLike[str], *, force: bool = False) -> None:
    """Write parts as one file, atomically; same parts, same bytes. Raises `OutputError`.

    The file is opened here: given a name, OpenEXR 3.5 says nothing when its last bytes meet a full disk.
    """
    import OpenEXR

    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        OpenEXR.File(list(parts)).write(file)


def _float32(channel: str, plane: NDArray[Any]) -> NDArray[np.float32]:
    """Whole numbers to 2²⁴ and −1 stay exact; what is too large becomes the largest, not infinite."""
    if np.isnan(plane).any():
        raise OutputError(f"channel '{channel}' holds NaN", hint="rebuild the cube")
    return np.ascontiguousarray(np.clip(plane, -LARGEST, LARGEST), dtype=np.float32)


def chromaticities(sensor: Sensor) -> tuple[float, ...]:
    """x, y of red, green, blue and white under the build illuminant, as OpenEXR orders them."""
    corners = sensor.xyz(np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]))
    return tuple(map(float, (corners / corners.sum(axis=1, keepdims=True))[:, :2].ravel()))
