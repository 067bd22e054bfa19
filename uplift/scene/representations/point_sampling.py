"""Point sampling (PS, filtered PF): values at evenly spaced wavelengths, the ends included, linear between them.

Kment 2011, 5.4 and 6.1. Where the text leaves a choice open: XYZ is the integral of what linear interpolation makes
of the samples, not a sum over colour-matching functions sampled likewise; with the sum, the errors at 8, 16 and 32
points do not fall fourfold from one to the next, as those of table 6.1 do.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.scene.representations.dense import TABLE_STRIDE, hat_functions, wavelengths, xyz_weights
from uplift.scene.representations.filters import Filter, conversion
from uplift.scene.representations.samples import SampleRepresentation

FAMILY, FILTERED = "point sampling", "point sampling, filtered"
MITCHELL, SPACINGS = (-0.4, 1.0), 4


def sample_points(count: int) -> Array:
    """(count,) nm, evenly spaced from end to end."""
    return np.linspace(observer.START, observer.END, count)


def point_samples(count: int) -> SampleRepresentation:
    """``count`` samples of the spectra as they are."""
    places = sample_points(count)
    return SampleRepresentation(
        f"PS{count}", FAMILY, hats_of_dense(places), hat_functions(places) @ xyz_weights()
    )


def filtered_point_samples(count: int, low_pass: Filter) -> SampleRepresentation:
    """``count`` samples of spectra that a low-pass filter has been over (`filters`)."""
    encoder = np.zeros((len(wavelengths()), count))
    encoder[::TABLE_STRIDE] = conversion(low_pass, count).T
    return SampleRepresentation(
        f"PS{count} {low_pass.name}", FILTERED, encoder, hat_functions(sample_points(count)) @ xyz_weights()
    )


def mitchell_point_samples(count: int) -> SampleRepresentation:
    """``count`` samples after Mitchell's filter as table A.2 has it at its best, b = −0.4 and c = 1.

    There it is as wide as four spacings of its 16 points, which for a cubic filter is the usual; so it is here for
    any count.
    """
    spacing = (len(observer.grid()) - 1) / (count - 1)
    found = filtered_point_samples(
        count, Filter("mitchell", 2 * round((SPACINGS * spacing - 1) / 2) + 1, MITCHELL)
    )
    return replace(found, name=f"PF{count}")


def hats_of_dense(places: Array) -> Array:
    """(401, n) what takes dense spectra to their values at ``places`` (n,) nm, linear between samples."""
    near = 1 - np.abs(wavelengths()[:, None] - places)
    return np.asarray(np.maximum(near, 0))
