"""OpenEXR files of cubes: attributes of the header that identify a cube, and parts of
float channels.
"""

import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import Gamut
from uplift.common.arrays import Floats, StrPath, Values
from uplift.common.errors import OutputError
from uplift.common.files import atomic_write
from uplift.cube.data import CubeData
from uplift.cube.file import digest
from uplift.lattice.point_table import Status

MAX_FLOAT32 = float(np.finfo(np.float32).max)


def attributes(data: CubeData) -> dict[str, Any]:
    """Return attributes of the header: ``uplift.cube`` is the digest of the content,
    ``uplift.model`` the model.
    """
    return {
        "chromaticities": chromaticities(data.sensor),
        "uplift.cube": digest(data),
        "uplift.dim": data.lattice.dim,
        "uplift.model": json.dumps(
            data.model.describe(), sort_keys=True, allow_nan=False
        ),
        "uplift.space": data.sensor.space,
        "uplift.illuminant": data.sensor.illuminant,
        "uplift.observer": data.sensor.observer,
        "uplift.threshold": float(data.threshold),
        "uplift.status": ", ".join(f"{status:d} {status.label}" for status in Status),
    }


def make_part(
    name: str, header: Mapping[str, Any], channels: Mapping[str, Values]
) -> Any:
    """Make an `OpenEXR.Part` of channels (height, width). Raises
    `OutputError` for NaN.
    """
    import OpenEXR

    lossless = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    pixels = {channel: _float32(channel, plane) for channel, plane in channels.items()}
    return OpenEXR.Part({**lossless, **header}, pixels, name)


def write_parts(parts: Iterable[Any], path: StrPath, *, force: bool = False) -> None:
    """Write parts as one file, atomically and reproducibly. Raises `OutputError`.

    The file is opened here, because OpenEXR 3.5 ignores a full disk if it opens the
    file.
    """
    import OpenEXR

    with atomic_write(path, force=force) as temporary, temporary.open("wb") as file:
        OpenEXR.File(list(parts)).write(file)


def _float32(channel: str, plane: Values) -> Floats:
    """Convert to float32. Integers up to 2²⁴ are exact; numbers that are too large
    become the largest float.
    """
    if np.isnan(plane).any():
        raise OutputError(f"channel '{channel}' contains NaN", hint="rebuild the cube")
    return np.ascontiguousarray(
        np.clip(plane, -MAX_FLOAT32, MAX_FLOAT32), dtype=np.float32
    )


def chromaticities(gamut: Gamut) -> tuple[float, ...]:
    """Return x, y of red, green, blue and white, of a sensor under the build
    illuminant, in the order of OpenEXR.
    """
    primaries = np.vstack([np.eye(3), np.ones(3)]) @ gamut.rgb_to_xyz.T
    return tuple(
        map(float, (primaries / primaries.sum(axis=1, keepdims=True))[:, :2].ravel())
    )
