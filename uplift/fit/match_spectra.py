"""Spectra of the model near many given reflectances, in the sense of the objective for atlas entries.

The moments of a detailed reflectance lose its colour under other lights if they are few. One Gauss–Newton step of the
objective of docs/mathematics.md, 6, restores it, and costs microseconds per spectrum.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from uplift.colorimetry.delta_e import lab, lab_jacobian
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.models import Moments
from uplift.models.arithmetic import blocked_matmul
from uplift.models.duality import cosine_basis

LIGHTS_WEIGHT = 0.06
"""Weight of a unit of CIE L*a*b* under a light: twice that of atlas entries, as the spectra are uncertain."""
NODES = 1024
"""Nodes of the integrals from reflectances to moments."""
DAMPING = 1e-4
"""Damping of the step, relative to the mean diagonal of its matrix."""
BLOCK_ROWS = 1 << 9


def match_spectra(model: Moments, wavelengths: Array, reflectances: Array, lights: Sequence[Light]) -> Array:
    """Multipliers (n, C) of spectra near reflectances (n, N) in (0, 1), with nearly their colours under several lights.

    The wavelengths (N,) are evenly spaced over the range of the model.
    """
    start = model.from_storage(blocked_matmul(reflectances, moment_matrix(model, wavelengths)))
    basis = model.basis(wavelengths)
    blocks = (slice(first, first + BLOCK_ROWS) for first in range(0, len(start), BLOCK_ROWS))
    found = [_step(model, basis, lights, start[block], reflectances[block]) for block in blocks]
    return np.concatenate(found) if found else start


def moment_matrix(model: Moments, wavelengths: Array) -> Array:
    """Weights (N, C) that turn reflectances (n, N), linear between the wavelengths, into moments."""
    phase = -np.pi * (np.arange(NODES) + 0.5) / NODES
    at = np.interp(phase, model.phase(wavelengths), np.arange(len(wavelengths)))
    samples = np.stack([np.interp(at, np.arange(len(wavelengths)), row) for row in np.eye(len(wavelengths))])
    # c_j = (1/π) ∫ g(φ) cos jφ dφ by midpoints
    weights = cosine_basis(phase, model.count) / NODES
    weights[:, 1:] /= 2
    return np.asarray(samples @ weights)


def _step(model: Moments, basis: Array, lights: Sequence[Light], multipliers: Array, goal: Array) -> Array:
    """Take a Gauss–Newton step of the objective; spectra that it would not bring nearer stay."""
    matrices, whites = np.concatenate([light.xyz for light in lights]), np.stack([light.white for light in lights])
    colours = (matrices.T[:, :, None] * basis[:, None, :]).reshape(len(basis), -1)
    squares = (basis[:, :, None] * basis[:, None, :]).reshape(len(basis), -1) / len(basis)

    def xyz(spectra: Array) -> Array:
        return (spectra @ matrices.T).reshape(len(spectra), -1, 3)

    def differences(x: Array) -> tuple[Array, Array]:
        """Differences of the spectra (n, N), and weighted ones of their colours (n, 3 L)."""
        spectra = model.to_reflectance(x)
        difference = lab(xyz(spectra), whites) - lab(xyz(goal), whites)
        return spectra - goal, LIGHTS_WEIGHT * difference.reshape(len(x), -1)

    # With g = S(B p), minimise mean (g − goal)² + Σ |w ΔL*a*b*|²: p − (JᵀJ + μ I)⁻¹ Jᵀ r.
    count = multipliers.shape[1]
    x = multipliers @ basis.T
    difference, colour_difference = differences(x)
    slope = model.derivative(x)
    to_lab = LIGHTS_WEIGHT * lab_jacobian(xyz(model.to_reflectance(x)), whites)
    change = (slope @ colours).reshape(len(x), -1, 3, count)
    change = (to_lab @ change).reshape(len(x), -1, count)
    # JᵀJ of the spectra is Σ_λ S′(x)² b bᵀ / N; that of the colours is the product of their changes.
    matrix = ((slope * slope) @ squares).reshape(-1, count, count) + change.mT @ change
    damping = DAMPING * np.trace(matrix, axis1=1, axis2=2) / count
    matrix[:, np.arange(count), np.arange(count)] += damping[:, None]
    gradient = (difference * slope) @ basis / len(basis)
    gradient += (colour_difference[:, None, :] @ change)[:, 0]
    trial = multipliers - np.linalg.solve(matrix, gradient[..., None])[..., 0]
    before, after = (
        (spectra**2).mean(axis=1) + (lit**2).sum(axis=1)
        for spectra, lit in ((difference, colour_difference), differences(trial @ basis.T))
    )
    return np.where((after < before)[:, None], trial, multipliers)
