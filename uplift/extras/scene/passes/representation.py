"""Passes of an RGB renderer as a representation: three bands of wavelengths each."""

from functools import cache

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.samples import Representation
from uplift.extras.scene.passes.bands import CHANNELS, PRESETS
from uplift.extras.scene.passes.choice import fit_bands
from uplift.extras.scene.passes.materials import library_materials
from uplift.models.arithmetic import blocked_matmul

LIGHTS = ("D65", "A", "FL2", "FL11", "LED-B3", "HP1")
"""Lights that the matrix to XYZ is fitted to."""
SIZES = (3, 6, 9, 12)
"""Numbers of bands of one to four passes."""


def pass_representations() -> tuple[Representation, ...]:
    """Return the bands of one to four passes."""
    return tuple(map(rgb_passes, SIZES))


def rgb_passes(count: int) -> Representation:
    """Bands in passes of an RGB renderer (RP), with the matrix of `uplift passes` for
    the materials of the library.

    A light is encoded by the linear map for lights that the matrix is not fitted to,
    and its numbers are not negative. Raises `OptionError` for other numbers of bands
    than 3, 6, 9 and 12.
    """
    if count not in SIZES:
        raise OptionError(
            f"number of bands must be 3, 6, 9 or 12, got {count}",
            hint="a pass of an RGB renderer has three",
        )
    weights, projection, to_xyz = _library_passes(count)
    # From 401 samples to the 81 of the bands: interpolation for a reflectance, and
    # its transpose for powers, which are summed.
    stride = samples.TABLE_STRIDE
    hats = samples.hat_functions(observer.grid())
    # Y of equal energy 1 is 1 in this package, and Σ ȳ at 5 nm in that of passes.
    luminance = observer.matching_functions()[:, 1]
    scale = stride * luminance.sum()

    def encode_light(power: Array) -> Array:
        return np.maximum(blocked_matmul(power, hats.T @ projection.T) / scale, 0)

    def encode_surface(reflectance: Array) -> Array:
        return np.clip(blocked_matmul(reflectance[:, ::stride], weights.T), 0, 1)

    return Representation(
        f"RP{count}",
        "passes of RGB",
        encode_light,
        encode_surface,
        lambda light: light @ to_xyz.T,
    )


@cache
def _library_passes(count: int) -> tuple[Array, Array, Array]:
    """Weights (K, 81) of bands, the projection (K, 81) of lights, and the matrix (3, K)
    to XYZ.
    """
    bands = PRESETS[count // CHANNELS]
    fitted = fit_bands(bands, library_materials(), LIGHTS)
    return bands.weights, fitted.light_projection, fitted.to_xyz
