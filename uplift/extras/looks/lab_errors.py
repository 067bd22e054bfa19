"""Likely differences in CIE L*a*b* between a material and the answer to its RGB."""

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.delta_e import lab, rgb_to_lab
from uplift.colorimetry.likely_errors import (
    ExpectedError,
    learn_radii,
)
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.lookup.errors_under_lights import Evidence, evidence

LIKELY = 0.95
"""Share of the materials like the entries of the atlas whose a* and b* lie in the
likely region.
"""
NORMAL_RADIUS = float(np.sqrt(-2 * np.log1p(-LIKELY)))
"""Mahalanobis distance that this share of pairs of normal variables stays within."""


@dataclass(frozen=True, eq=False, repr=False)
class LabErrors:
    """Differences in CIE L*a*b* between measurements and answers under a light."""

    data: CubeData
    expected: ExpectedError
    """Products (9) of the components of the differences."""
    likely_radius: float
    """Mahalanobis distance in a* and b* that `LIKELY` of the materials like the atlas
    stay within. Normal: 2.45.
    """

    def covariance(self, rgb: Array) -> Array:
        """Expected covariances (n, 3, 3) around the answers at linear RGB (n, 3), also
        outside [0, 1].

        Positive semidefinite; [:, 1:, 1:] is that of a* and b*.
        """
        expected = self.expected(rgb_to_lab(self.data.sensor, np.clip(rgb, 0, 1)))
        hits = self.data.outside_boxes.find(rgb)
        expected[hits.rows] *= (
            hits.lattice_weight[:, None] ** 2
        )  # the share of the answer that no entry gives
        return (self.expected.scale**2 * (expected + self.expected.floor)).reshape(
            -1, 3, 3
        )


def lab_errors(data: CubeData, light: Light) -> LabErrors:
    """Learn the covariances in CIE L*a*b* under a light; `OptionError` without left-out
    entries.
    """
    return lab_errors_from(data, light, evidence(data))


def lab_errors_from(data: CubeData, light: Light, known: Evidence) -> LabErrors:
    """Learn the covariances in CIE L*a*b* under a light from evidence."""
    measured_lab = lab(known.measured @ light.xyz.T, light.white)
    differences = [
        measured_lab - lab(answer @ light.xyz.T, light.white)
        for answer in (known.left_out, known.kept)
    ]
    # Products (E, 9) of the components
    left_out_products, kept_products = (
        (change[:, :, None] * change[:, None, :]).reshape(-1, 9)
        for change in differences
    )
    expected = known.expected_error(light, (left_out_products, kept_products))
    # d² = eᵀ Σ⁻¹ e of each entry, by the covariance Σ that the other entries let expect
    covariance = expected.scale**2 * expected.left_out.reshape(-1, 3, 3)
    distances = mahalanobis(covariance[:, 1:, 1:], differences[0][:, 1:])
    (radius,) = learn_radii(distances, [(LIKELY, NORMAL_RADIUS)], components=2)
    return LabErrors(data, expected, radius)


def mahalanobis(covariance: Array, difference: Array) -> Array:
    """Mahalanobis distances (n,) of differences (n, d) by covariances (n, d, d), which
    may be singular.
    """
    values, axes = np.linalg.eigh(covariance)
    along = np.einsum("nij,ni->nj", axes, difference)
    return np.sqrt((along**2 / np.maximum(values, np.finfo(float).tiny)).sum(axis=1))
