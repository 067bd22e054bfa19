"""CIEDE2000 near a colour: a quadratic form, so that least squares can mind it."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab_jacobian
from uplift.common.arrays import Array
from uplift.scene.wavelengths.setup import RenderSetup

NEAR = 1e-3
"""Length of the differences that are tried, in units of L*a*b*."""
LEAST = 1e-3
"""No direction of L*a*b* counts less than this, squared: rounding may turn it negative."""


def delta_e_factors(setting: RenderSetup) -> Array:
    """(K, M, 3, 3) T for every material under every light: |T (XYZ' − XYZ)| is ΔE00 of colours close together."""
    slope = np.stack(
        [lab_jacobian(xyz, white) for xyz, white in zip(setting.xyz, setting.whites, strict=True)]
    )
    values, vectors = np.linalg.eigh(_form(setting.lab))
    root = np.sqrt(np.maximum(values, LEAST))[..., None] * np.swapaxes(vectors, -1, -2)
    return np.asarray(root @ slope)


def _form(lab: Array) -> Array:
    """(…, 3, 3) G with dᵀ G d = ΔE00² for small differences d of L*a*b* (…, 3)."""
    step = np.eye(3) * NEAR

    def squared(difference: Array) -> Array:
        return (delta_e_2000(lab, lab + difference) / NEAR) ** 2

    alone = [squared(d) for d in step]
    form = np.empty((*lab.shape, 3))
    for i in range(3):
        form[..., i, i] = alone[i]
        for j in range(i):
            form[..., i, j] = form[..., j, i] = (squared(step[i] + step[j]) - alone[i] - alone[j]) / 2
    return form
