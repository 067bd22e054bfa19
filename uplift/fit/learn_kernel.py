"""Learn the kernel of the kriging from the atlas, by leave-one-out (docs/mathematics.md, 7).

Errors are judged by their visible part: the change of colour under the lights of the build, once the solver has made
the colour exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights, lab, lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.fit.kriging import Kernel, leave_one_out
from uplift.models import Model
from uplift.models.minimum_norm import ForwardMap

LENGTHS = (6.0, 12.0, 24.0, 48.0)
NUGGETS = (0.01, 0.03, 0.1, 0.3, 1.0, 2.0)
DEFAULT = Kernel(length=12.0, nugget=0.3)
"""Kernel of atlases that are too small to learn one."""
DOUBT = 0.25
"""Entries' worth of the preference for `DEFAULT`, per squared doubling of the length or quadrupling of the nugget."""
MIN_ENTRIES = 8
"""Entries needed to learn a kernel."""
INVISIBLE = 1e-3
"""ΔE00 below which errors do not matter."""
MAX_ENTRIES = 200
"""Entries that are used: the kernel changes little with more, and its cost grows with their cube."""


def learn_kernel(locations: Array, deviations: Array, visible: Array) -> Kernel:
    """Choose the kernel with the least mean visible error of left-out entries.

    Parameters
    ----------
    locations : ndarray, shape (E, 3)
        CIE L*a*b* of the entries.
    deviations : ndarray, shape (E, C)
        Deviation of their coefficients from the base.
    visible : ndarray, shape (E, L, 3, C)
        Change of the colour of each entry under L lights by its coefficients; see `visible_change`.

    Returns
    -------
    Kernel
        The best candidate. Few entries lean towards `DEFAULT`.
    """
    from scipy.spatial.distance import cdist

    if len(locations) < MIN_ENTRIES:
        return DEFAULT
    rows = np.linspace(0, len(locations) - 1, min(len(locations), MAX_ENTRIES)).astype(np.int64)
    distance, deviations, visible = cdist(locations[rows], locations[rows]), deviations[rows], visible[rows]

    def loss(kernel: Kernel) -> float:
        _, errors = leave_one_out(kernel(distance), deviations)
        changes = np.linalg.norm(np.einsum("elkc,ec->elk", visible, errors), axis=-1)
        return float(np.log(changes.mean() + INVISIBLE)) + DOUBT / len(rows) * _surprise(kernel)

    return min((Kernel(*each) for each in product(LENGTHS, NUGGETS)), key=loss)


def _surprise(kernel: Kernel) -> float:
    doublings = np.log2(kernel.length / DEFAULT.length)
    quadruplings = np.log2(kernel.nugget / DEFAULT.nugget) / 2
    return float(doublings**2 + quadruplings**2)


def visible_change(model: Model, forward: ForwardMap, lights: Sequence[Light], measured: Array) -> Array:
    """Compute how changed coefficients change colours under lights, once the colour of the build is exact again.

    Moments are linear in the spectrum, which they determine up to its roughest parts: their basis approximates the
    change of the spectrum.

    Parameters
    ----------
    model : Model
        Spectrum model.
    forward : ForwardMap
        Map from multipliers to the RGB of the sensor.
    lights : sequence of Light
        L lights.
    measured : ndarray, shape (E, N)
        Reflectances, at the wavelengths of ``forward`` and of the lights.

    Returns
    -------
    ndarray, shape (E, L, 3, C)
        Derivative of lightness, chroma and hue difference in units of ΔE00.
    """
    basis, sensor = forward.basis, forward.sensor @ forward.basis
    smooth = sensor.T / model.roughness()[:, None]
    metameric = np.eye(model.count) - smooth @ np.linalg.solve(sensor @ smooth, sensor)
    changes = []
    for light in lights:
        xyz = measured @ light.xyz.T
        to_delta_e = delta_e_2000_weights(lab(xyz, light.white)) @ lab_jacobian(xyz, light.white)
        changes.append(to_delta_e @ (light.xyz @ basis @ metameric))
    return np.stack(changes, axis=1)
