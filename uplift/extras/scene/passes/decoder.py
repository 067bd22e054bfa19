"""Decoding of the numbers of a pixel in all passes: a matrix to linear RGB or XYZ."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.camera import CAMERA
from uplift.colorimetry.gamut import conversion
from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT, Illuminant
from uplift.common.arrays import Array, Floats, Values
from uplift.common.errors import OptionError
from uplift.extras.colour.spaces import find_space
from uplift.extras.images import exr
from uplift.extras.images.counts import Counts
from uplift.extras.images.reader import NOT_FINITE, REPLACED
from uplift.extras.scene.passes.light_images import CLAMPED, NEGATIVE
from uplift.extras.scene.passes.passes import Passes
from uplift.extras.scene.passes.textures import ATTRIBUTE, pass_mark

XYZ = "XYZ"
"""Name of the space of undecoded tristimulus values."""
LARGEST = float(np.finfo(np.float32).max) / 1e6
"""Largest number of a pixel, whose decoded values are finite."""


@dataclass(frozen=True, eq=False)
class Decoder:
    """Matrix from the numbers of a pixel to a space, made by `decoder`.

    Parameters
    ----------
    passes : Passes
        The passes.
    matrix : ndarray, shape (3, K)
        Matrix to linear RGB or XYZ.
    channels : tuple of str
        Names of the three results.
    header : dict
        Attributes that describe them.
    """

    passes: Passes
    matrix: Array
    channels: tuple[str, ...]
    header: dict[str, Any]

    def decode(self, numbers: Values) -> tuple[Floats, Counts]:
        """Decode the numbers of pixels.

        Parameters
        ----------
        numbers : ndarray, shape (…, K)
            Numbers of all passes. Negative ones and NaN count, and become 0.

        Returns
        -------
        tuple of ndarray, shape (…, 3), and Counts
            Decoded pixels, 32-bit floats, and how many were changed.
        """
        values = np.asarray(numbers, dtype=np.float32)
        finite = np.isfinite(values)
        negative = (values < 0).any(axis=-1) & finite.all(axis=-1)
        counts = Counts(values[..., 0].size)
        counts += Counts.of(NOT_FINITE, (~finite).any(axis=-1).sum(), REPLACED)
        counts += Counts.of(NEGATIVE, negative.sum(), CLAMPED)
        usable = np.clip(np.nan_to_num(values, nan=0.0), 0, LARGEST)
        return (usable @ self.matrix.T).astype(np.float32), counts


def decoder(
    passes: Passes,
    *,
    space: str = "sRGB",
    light: str | None = None,
    white: Illuminant | None = None,
) -> Decoder:
    """Make the decoder of passes.

    Parameters
    ----------
    passes : Passes
        The passes.
    space : str
        Name of a linear RGB space, ``"XYZ"``, or ``"camera"`` for the raw values of the
        camera of the passes.
    light : str, optional
        The only light of the scene, whose matrix is used. By default that of all
        lights.
    white : str or Lamp, optional
        The light whose white becomes (1, 1, 1). By default colours are those under the
        lights themselves, and D65 is white. XYZ are not changed.

    Returns
    -------
    Decoder

    Raises
    ------
    OptionError
        The space is not linear RGB, or the passes have no camera.
    UnknownNameError
        The space or a light is unknown.
    """
    if space == CAMERA:
        return _camera_decoder(passes)
    to_xyz = passes.to_xyz if light is None else passes.light(light).to_xyz
    stated = {"space": space} | ({} if light is None else {"light": light})
    if space == XYZ:
        return _decoder(passes, to_xyz, "XYZ", stated)
    target = find_space(space)
    if target.floats_are_codes or target.to_gamut is not None:
        raise OptionError(
            f"space must be linear RGB or XYZ, got '{target.name}'",
            hint="name a linear space, such as sRGB or ACEScg",
        )
    screen = observer.sensor(illuminant=white or DEFAULT_ILLUMINANT)
    stated |= {} if white is None else {"white": screen.illuminant}
    # White is (1, 1, 1) in both spaces.
    to_space = conversion(observer.sensor(), target.gamut)
    matrix = to_space @ screen.xyz_to_rgb @ to_xyz
    chromaticities = exr.chromaticities(target.gamut)
    return _decoder(passes, matrix, "RGB", stated, chromaticities=chromaticities)


def _camera_decoder(passes: Passes) -> Decoder:
    if passes.camera is None:
        raise OptionError(
            "the passes have no camera",
            hint="choose them with a camera",
        )
    stated = {"space": CAMERA, "camera": passes.camera.name}
    return _decoder(passes, passes.camera.matrix, "RGB", stated)


def _decoder(
    passes: Passes,
    matrix: Array,
    channels: str,
    stated: Mapping[str, str],
    **attributes: Any,
) -> Decoder:
    """Make a decoder whose header states how it was made."""
    header = {
        ATTRIBUTE: pass_mark(passes, passes.count),
        "uplift.texture": json.dumps({"as": "decoded passes", **stated}),
        **attributes,
    }
    return Decoder(passes, matrix, tuple(channels), header)
