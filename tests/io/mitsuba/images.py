"""Small OpenEXR files."""

from __future__ import annotations

import numpy as np


def write_image(path, rgb):
    """Write linear RGB (h, w, 3)."""
    write_channels(path, dict(zip("RGB", np.moveaxis(rgb, -1, 0), strict=True)))


def write_channels(path, channels, **attributes):
    """Write float channels (h, w) by name, with attributes of the header."""
    import OpenEXR

    pixels = {name: np.ascontiguousarray(plane, dtype=np.float32) for name, plane in channels.items()}
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage, **attributes}
    OpenEXR.File(header, pixels).write(str(path))
