"""CIEDE2000 near a colour as a quadratic form, which least squares can minimise."""

from __future__ import annotations

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, lab_jacobian
from uplift.common.arrays import Array
from uplift.scene.wavelengths.setup import RenderSetup

STEP = 1e-3
"""Length of the finite differences, in units of L*a*b*."""
MIN_EIGENVALUE = 1e-3
"""Lower bound of the eigenvalues of the form; rounding may make them negative."""


def delta_e_factors(setup: RenderSetup) -> Array:
    """Factors T (K, M, 3, 3) of the form at every material and light: |T (XYZ' − XYZ)| ≈ ΔE00 of close colours."""
    jacobian = np.stack([lab_jacobian(xyz, white) for xyz, white in zip(setup.xyz, setup.whites, strict=True)])
    values, vectors = np.linalg.eigh(_quadratic_form(setup.lab))
    root = np.sqrt(np.maximum(values, MIN_EIGENVALUE))[..., None] * np.swapaxes(vectors, -1, -2)
    return np.asarray(root @ jacobian)


def _quadratic_form(lab: Array) -> Array:
    """Matrices G (…, 3, 3) with dᵀ G d ≈ ΔE00² for small differences d of L*a*b* (…, 3)."""
    steps = np.eye(3) * STEP

    def squared(difference: Array) -> Array:
        return (delta_e_2000(lab, lab + difference) / STEP) ** 2

    diagonal = [squared(step) for step in steps]
    form = np.empty((*lab.shape, 3))
    for i in range(3):
        form[..., i, i] = diagonal[i]
        for j in range(i):
            mixed = (squared(steps[i] + steps[j]) - diagonal[i] - diagonal[j]) / 2
            form[..., i, j] = form[..., j, i] = mixed
    return form
