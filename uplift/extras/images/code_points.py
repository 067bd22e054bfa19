"""Colour primaries and transfer characteristics by the numbers of ITU-T H.273, which
PNG files state.

Light of 100 cd/m² is 1, as in OpenColorIO, whose curve of PQ and display of HLG (ITU-R
BT.2100, 1000 cd/m²) are used.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, Primaries
from uplift.common.arrays import Array
from uplift.extras.colour.spaces import ImageSpace, OcioSpace
from uplift.extras.colour.srgb import decode

Curve = Callable[[Array], Array]
"""From codes in [0, 1] to linear values."""

PRIMARIES = {
    1: SRGB,
    4: Primaries((0.67, 0.33), (0.21, 0.71), (0.14, 0.08), (0.310, 0.316)),
    5: Primaries((0.64, 0.33), (0.29, 0.60), (0.15, 0.06), SRGB.white),
    6: Primaries((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), SRGB.white),
    7: Primaries((0.630, 0.340), (0.310, 0.595), (0.155, 0.070), SRGB.white),
    9: Primaries((0.708, 0.292), (0.170, 0.797), (0.131, 0.046), SRGB.white),
    11: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), (0.314, 0.351)),
    12: Primaries((0.680, 0.320), (0.265, 0.690), (0.150, 0.060), SRGB.white),
    22: Primaries((0.630, 0.340), (0.295, 0.605), (0.155, 0.077), SRGB.white),
}
"""Colour primaries of table 2, without film and XYZ."""
BT2020 = 9
HLG = 18
PQ_TO_LINEAR = "CURVE - ST-2084_to_LINEAR"
XYZ_TO_HLG = "DISPLAY - CIE-XYZ-D65_to_REC.2100-HLG-1000nit"


def _decode_bt709(codes: Array) -> Array:
    """Invert the transfer function of ITU-R BT.709, which BT.2020 shares."""
    is_line = codes < 0.081
    values = np.where(is_line, codes / 4.5, (np.maximum(codes, 0.081) + 0.099) / 1.099)
    return values ** np.where(is_line, 1, 1 / 0.45)


def power(gamma: float) -> Curve:
    """Return the curve of an exponent."""
    return lambda codes: np.maximum(codes, 0) ** gamma


def _decode_pq(codes: Array) -> Array:
    """Decode ITU-R BT.2100 PQ (SMPTE ST 2084) to units of 100 cd/m²."""
    return _built_in(PQ_TO_LINEAR).convert(codes)


def _hlg_to_xyz(codes: Array) -> Array:
    """Decode ITU-R BT.2100 HLG to CIE XYZ in units of 100 cd/m², on a display of 1000
    cd/m².
    """
    return _built_in(XYZ_TO_HLG, is_inverse=True).convert(codes)


def _built_in(name: str, *, is_inverse: bool = False) -> OcioSpace:
    """Return a transform of OpenColorIO."""
    import PyOpenColorIO as ocio  # noqa: N813

    direction = ocio.TRANSFORM_DIR_INVERSE if is_inverse else ocio.TRANSFORM_DIR_FORWARD
    return ocio_space(name, ocio.BuiltinTransform(name, direction))


def ocio_space(name: str, transform: Any) -> OcioSpace:
    """Return the conversion by a transform of OpenColorIO."""
    import PyOpenColorIO as ocio  # noqa: N813

    processor = ocio.Config.CreateRaw().getProcessor(transform)
    return OcioSpace(
        name, False, processor.getOptimizedCPUProcessor(ocio.OPTIMIZATION_LOSSLESS)
    )


TRANSFERS: dict[int, Curve] = {
    **dict.fromkeys((1, 6, 14, 15), _decode_bt709),
    4: power(2.2),
    5: power(2.8),
    8: lambda codes: codes,
    13: decode,
    16: _decode_pq,
    17: lambda codes: power(2.6)(codes) * 52.37 / 48,
}
"""Inverse transfer characteristics of table 3, without HLG, which is not a curve of
each channel.
"""


def find_space(name: str, points: Sequence[int], bits: int) -> ImageSpace | None:
    """Return the space of primaries, transfer, matrix and range of codes of ``bits``
    bits; None if it is not known.
    """
    if len(points) != 4:
        return None
    primaries, transfer, matrix, is_full = points
    gamut = PRIMARIES.get(primaries)
    if gamut is None or matrix != 0:
        return None
    to_full = (lambda codes: codes) if is_full else _widen(bits)
    if transfer == HLG and primaries == BT2020:
        return ImageSpace(
            name,
            gamut,
            lambda codes: _hlg_to_xyz(to_full(codes)),
            mixes_channels=True,
            to_gamut=np.asarray(np.linalg.inv(gamut.rgb_to_xyz)),
        )
    curve = TRANSFERS.get(transfer)
    if curve is None:
        return None
    return ImageSpace(name, gamut, lambda codes: curve(to_full(codes)))


def _widen(bits: int) -> Curve:
    """Return the map from codes of narrow range, 16 to 235 of 8 bits, to [0, 1]. Codes
    below black are black.
    """
    unit = 2.0 ** (bits - 8) / (2**bits - 1)
    return lambda codes: np.maximum((codes - 16 * unit) / (219 * unit), 0)
