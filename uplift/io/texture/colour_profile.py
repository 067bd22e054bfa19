"""Colour space that an image file states: colorInteropID or chromaticities of OpenEXR, PNG code points, or ICC.

OpenColorIO reads matrix profiles, as displays have them, with their primaries and tone curves. Profiles of grey images,
and those with lookup tables, are not used.
"""

import contextlib
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.colorimetry.spaces import ImageSpace, OcioSpace, find_ocio_space
from uplift.colorimetry.srgb import decode
from uplift.common.arrays import Array
from uplift.common.errors import OptionError

Curve = Callable[[Array], Array]
"""From codes in [0, 1] to linear values."""

H273_PRIMARIES = {
    1: SRGB,
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    11: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.314, 0.351)),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
}
"""Colour primaries of ITU-T H.273, table 2, that PNG files name: sRGB, Rec. 2020, DCI-P3 and Display P3."""
NOT_STATED = ("", "unknown")
"""Values of colorInteropID that name no space."""
ROUNDING = 1e-6
"""Largest step back of a curve by single precision."""


def _decode_bt709(codes: Array) -> Array:
    """Invert the transfer function of ITU-R BT.709, which BT.2020 shares."""
    return np.where(codes < 0.081, codes / 4.5, (np.maximum(codes, 0.081) + 0.099) / 1.099) ** np.where(
        codes < 0.081, 1, 1 / 0.45
    )


def _power(gamma: float) -> Curve:
    return lambda codes: np.maximum(codes, 0) ** gamma


H273_TRANSFERS: dict[int, Curve] = {
    **dict.fromkeys((1, 6, 14, 15), _decode_bt709),
    4: _power(2.2),
    5: _power(2.8),
    8: lambda codes: codes,
    13: decode,
    17: lambda codes: _power(2.6)(codes) * 52.37 / 48,
}
"""Inverse transfer characteristics of ITU-T H.273, table 3, without those of high dynamic range."""


@dataclass(frozen=True, eq=False)
class Profile:
    """Statement of an image file about its colour space; ``space`` is None if it cannot be used."""

    name: str
    space: ImageSpace | None


def read_profile(spec: Any) -> Profile | None:
    """Return the profile in an `OpenImageIO.ImageSpec`, None if the file states no colour space."""
    interop = str(spec.get_string_attribute("colorInteropID"))
    if interop not in NOT_STATED:
        # A name of the Color Interop Forum, which the configuration of OpenColorIO has as alias.
        found = None
        with contextlib.suppress(OptionError):
            found = find_ocio_space(interop)
        return Profile(interop, None if found is None else found.as_image_space())
    if (chromaticities := spec.getattribute("chromaticities")) is not None:
        primaries = _primaries(chromaticities)
        name = "chromaticities"
        return Profile(name, None if primaries is None else ImageSpace(name, primaries))
    if (points := spec.getattribute("CICP")) is not None:
        return _by_code_points(points)
    if (data := spec.getattribute("ICCProfile")) is not None:
        name = spec.get_string_attribute("ICCProfile:profile_description") or "an ICC profile without a name"
        is_bytes = isinstance(data, np.ndarray) and data.dtype == np.uint8
        return Profile(name, _icc_space(name, data.tobytes()) if is_bytes else None)
    return None


def _by_code_points(points: Any) -> Profile:
    pair = points[:2] if isinstance(points, tuple) and len(points) > 1 else (0, 0)
    name = f"CICP {pair[0]}, {pair[1]}"
    primaries, transfer = H273_PRIMARIES.get(pair[0]), H273_TRANSFERS.get(pair[1])
    return Profile(name, None if primaries is None or transfer is None else ImageSpace(name, primaries, transfer))


def _primaries(numbers: Any) -> Primaries | None:
    """Return primaries; None for impossible ones, and for values of another type, as an attribute may have any."""
    try:
        return Primaries.of([float(number) for number in numbers])
    except (OptionError, TypeError, ValueError):
        return None


def _icc_space(name: str, data: bytes) -> ImageSpace | None:
    """Return the space of a matrix profile by OpenColorIO; None for others, and for damaged ones."""
    import PyOpenColorIO as ocio  # noqa: N813

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "image.icc"
        path.write_bytes(data)
        transform = ocio.FileTransform(str(path), direction=ocio.TRANSFORM_DIR_INVERSE)
        try:
            processor = ocio.Config.CreateRaw().getProcessor(transform)
        except ocio.Exception:
            return None
    to_xyz = OcioSpace(name, False, processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS))
    corners = to_xyz.convert(np.vstack([np.eye(3), np.ones(3)]))
    gamut = _primaries((corners / corners.sum(axis=1, keepdims=True))[:, :2].ravel())
    if gamut is None:
        return None
    to_linear = np.linalg.inv(to_xyz.matrix).T
    values = to_xyz.convert(np.linspace([0.0] * 3, [1.0] * 3, 256)) @ to_linear
    is_plausible = np.isfinite(values).all() and (np.diff(values, axis=0) >= -ROUNDING).all()
    return ImageSpace(name, gamut, lambda codes: to_xyz.convert(codes) @ to_linear) if is_plausible else None
