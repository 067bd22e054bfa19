"""How materials of one colour differ: the covariance of their spectra around the answer
of a cube, learnt from materials that were left out (docs/mathematics.md, 7).

The differences e_i between measured and predicted spectra are metameric blacks: under
the light of the cube they have no colour. Relative to the brightness k(x) of their
colour they are alike in dark and bright materials. Around a colour x,

C(x) = k(x)² Eᵀ S(x) E,  S(x) = (Σ w_i z_i z_iᵀ + n₀ S₀) / (Σ w_i + n₀),

with the scores z_i of e_i / k in the principal components E, weights w_i = exp(−ΔE / l)
of materials of near colours, and the mean S₀ of all materials.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from uplift.colorimetry.delta_e import rgb_to_lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, blocks, distances
from uplift.cube.data import CubeData
from uplift.lookup.cube import Cube, load
from uplift.lookup.errors_under_lights import evidence
from uplift.models.brightness import brightness

RANK = 16
"""Principal components; the rest of the variance is below a thousandth."""
LENGTH = 12.0
"""Length l in CIE L*a*b* of the weights."""
PRIOR_COUNT = 2.0
"""Weight n₀ of the mean, in materials."""
FAMILIES_COUNT = 20.0
"""Weight of the known families in the mean, in materials of the atlas: a few entries do
not span how materials differ.
"""
BLOCK_NUMBERS = 1 << 20
"""Numbers of the matrix of weights held at a time."""


@dataclass(frozen=True, eq=False, repr=False)
class Metamers:
    """Differences of M materials from the answers to their colours."""

    sensor: Sensor
    components: Array
    """E (R, N), orthonormal rows."""
    lab: Array
    """(M, 3) CIE L*a*b*."""
    scores: Array
    """z (M, R)."""
    mean: Array
    """S₀ (R, R)."""

    def components_at(self, wavelengths: Array) -> Array:
        """E (R, N) at wavelengths (N,) in nm, linearly interpolated."""
        at = self.sensor.wavelengths
        rows = [np.interp(wavelengths, at, row) for row in self.components]
        return np.array(rows)

    def covariance(self, rgb: Array) -> Array:
        """S (n, R, R) around linear RGB (n, 3) in [0, 1]."""
        lab = rgb_to_lab(self.sensor, rgb)
        result = np.empty((len(rgb), *self.mean.shape))
        for block in blocks(len(rgb), max(BLOCK_NUMBERS // max(len(self.lab), 1), 1)):
            apart = distances(lab[block], self.lab)
            result[block] = self._weighted(apart)
        return result

    def left_out_covariance(self, family: Array | None) -> Array:
        """S (M, R, R) around each material without it, or without its ``family``
        (M,).
        """
        apart = distances(self.lab, self.lab)
        if family is None:
            np.fill_diagonal(apart, np.inf)
        else:
            apart[family[:, None] == family] = np.inf
        return self._weighted(apart)

    def _weighted(self, apart: Array) -> Array:
        """S (n, R, R) where materials are ΔE (n, M) away."""
        weights = np.exp(apart / -LENGTH)
        sums = (weights @ self._products).reshape(-1, *self.mean.shape)
        total = weights.sum(axis=1) + PRIOR_COUNT
        return (sums + PRIOR_COUNT * self.mean) / total[:, None, None]

    @cached_property
    def _products(self) -> Array:
        """z zᵀ of each material, (M, R²)."""
        return (self.scores[:, :, None] * self.scores[:, None, :]).reshape(
            len(self.scores), -1
        )


def learn_metamers(cube: Cube) -> Metamers:
    """Learn how materials of one colour differ; `OptionError` for a cube without
    left-out materials.
    """
    data = cube.data
    known = evidence(data)
    measured = np.asarray(known.measured, dtype=float)
    rgb = np.clip(data.sensor.rgb(measured), 0, 1)
    relative = _relative(data.sensor, measured - known.left_out, rgb)
    products = relative.T @ relative
    count = float(len(relative))
    if known.family is None:
        families = _families(data)
        products += FAMILIES_COUNT * families.T @ families / max(len(families), 1)
        count += FAMILIES_COUNT * bool(len(families))
    mean = products / count
    _, axes = np.linalg.eigh(mean)
    components = np.ascontiguousarray(axes[:, : -RANK - 1 : -1].T)
    return Metamers(
        data.sensor,
        components,
        known.lab,
        relative @ components.T,
        components @ mean @ components.T,
    )


def _relative(sensor: Sensor, differences: Array, rgb: Array) -> Array:
    """Differences (M, N) of spectra around linear RGB (M, 3), relative to brightness.

    Rounding, or another light, has left a colour in them, which is removed.
    """
    colours = differences @ sensor.matrix.T
    blacks = differences - colours @ np.linalg.pinv(sensor.matrix).T
    return blacks / brightness(rgb)


def _families(data: CubeData) -> Array:
    """Differences (M, N) of the families of the packaged cube, relative to brightness,
    without those that a cube was not to know.
    """
    packaged = load().data
    families = packaged.families
    if families is None:
        return np.zeros((0, len(data.sensor.wavelengths)))
    left_out = data.provenance.get("options", {}).get("leave_out", ())
    kept = np.array([name not in left_out for name in families.names])
    rows = kept[families.family]
    differences = np.asarray(families.measured - families.predicted, dtype=float)[rows]
    at = data.sensor.wavelengths
    known_at = packaged.sensor.wavelengths
    resampled = [np.interp(at, known_at, row) for row in differences]
    spectra = np.reshape(resampled, (len(differences), len(at)))
    return _relative(data.sensor, spectra, families.rgb[rows])
