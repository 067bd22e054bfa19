"""Point sampling after a low-pass filter (PF). Kment 2011, sections 4.4, 4.5 and 6.3."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from uplift.colorimetry import observer
from uplift.scene.representations.dense import TABLE_STRIDE, hat_functions, wavelengths, xyz_weights
from uplift.scene.representations.filters import Filter, resampling_matrix
from uplift.scene.representations.point_sampling import sample_points
from uplift.scene.representations.samples import SampleRepresentation

MITCHELL_B, MITCHELL_C = -0.4, 1.0
"""Parameters of the best Mitchell filter in table A.2."""
FILTER_SPACINGS = 4
"""Width of that filter in spacings of its 16 points, which is the usual width of cubic filters."""


def filtered_point_samples(count: int, low_pass: Filter) -> SampleRepresentation:
    """Make the representation by ``count`` samples of spectra that pass through a filter."""
    encoder = np.zeros((len(wavelengths()), count))
    encoder[::TABLE_STRIDE] = resampling_matrix(low_pass, count).T
    weights = hat_functions(sample_points(count)) @ xyz_weights()
    return SampleRepresentation(f"PS{count} {low_pass.name}", "point sampling, filtered", encoder, weights)


def mitchell_point_samples(count: int) -> SampleRepresentation:
    """Make the representation with the best Mitchell filter of table A.2, `FILTER_SPACINGS` wide for any count."""
    spacing = (len(observer.grid()) - 1) / (count - 1)
    extent = 2 * round((FILTER_SPACINGS * spacing - 1) / 2) + 1
    low_pass = Filter("mitchell", extent, (MITCHELL_B, MITCHELL_C))
    return replace(filtered_point_samples(count, low_pass), name=f"PF{count}")
