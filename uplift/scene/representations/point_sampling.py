"""Point sampling (PS): values at evenly spaced wavelengths, both ends included, linear in between.

Kment 2011, sections 5.4 and 6.1. A choice that the text leaves open: XYZ is the integral of the linear interpolant, not
a sum over equally sampled colour-matching functions. With the sum, the errors at 8, 16 and 32 points would not decrease
fourfold from one to the next, as those of table 6.1 do.
"""

from __future__ import annotations

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.representations.dense import hat_functions, interpolation_matrix, xyz_weights
from uplift.scene.representations.samples import SampleRepresentation


def sample_points(count: int) -> Array:
    """Evenly spaced wavelengths (count,) in nm from end to end."""
    return np.linspace(observer.START, observer.END, count)


def point_samples(count: int) -> SampleRepresentation:
    """Make the representation by ``count`` samples."""
    points = sample_points(count)
    weights = hat_functions(points) @ xyz_weights()
    return SampleRepresentation(f"PS{count}", "point sampling", interpolation_matrix(points), weights)
