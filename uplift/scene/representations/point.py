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
from uplift.scene.representations.dense import TABLE, hats, observed, wavelengths
from uplift.scene.representations.filters import Filter, conversion
from uplift.scene.representations.samples import Samples

FAMILY, FILTERED = "point sampling", "point sampling, filtered"
MITCHELL, SPACINGS = (-0.4, 1.0), 4


def points(count: int) -> Array:
    """(count,) nm, evenly spaced from end to end."""
    return np.linspace(observer.START, observer.END, count)


def point(count: int) -> Samples:
    """``count`` samples of the spectra as they are."""
    places = points(count)
    return Samples(f"PS{count}", FAMILY, hats_of_dense(places), hats(places) @ observed())


def filtered(count: int, low_pass: Filter) -> Samples:
    """``count`` samples of spectra that a low-pass filter has been over (`filters`)."""
    encoder = np.zeros((len(wavelengths()), count))
    encoder[::TABLE] = conversion(low_pass, count).T
    return Samples(f"PS{count} {low_pass.name}", FILTERED, encoder, hats(points(count)) @ observed())


def prefiltered(count: int) -> Samples:
    """``count`` samples after Mitchell's filter as table A.2 has it at its best, b = −0.4 and c = 1.

    There it is as wide as four spacings of its 16 points, which for a cubic filter is the usual; so it is here for
    any count.
    """
    spacing = (len(observer.grid()) - 1) / (count - 1)
    found = filtered(count, Filter("mitchell", 2 * round((SPACINGS * spacing - 1) / 2) + 1, MITCHELL))
    return replace(found, name=f"PF{count}")


def hats_of_dense(places: Array) -> Array:
    """(401, n) what takes dense spectra to their values at ``places`` (n,) nm, linear between samples."""
    near = 1 - np.abs(wavelengths()[:, None] - places)
    return np.asarray(np.maximum(near, 0))
