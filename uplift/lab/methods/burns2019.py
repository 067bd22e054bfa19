"""Chromatic adaptation by reconstructed reflectances: the spectrum of a colour is
positive, and the slope of its logarithm has the least squares.

Burns 2019, "Chromatic adaptation transform by spectral reconstruction", Color Research
& Application 44(5). Domain: colours above 0. Range: positive reflectances, not limited
to 1.
"""

import numpy as np

from uplift.common.arrays import Array, blocks
from uplift.lab.method import Method, PreparedMethod, interpolated, ours
from uplift.lab.runner import Task

STEPS = 20
"""Newton steps: after them, measured colours within sRGB are met up to rounding."""
LONGEST = 1.0
"""Largest change of a logarithm in a step; longer steps may diverge."""
DARKEST = 1e-6
"""Least reflectance of the greys to start from."""
BLOCK = 1 << 8
"""Colours that are solved at a time."""


def reconstruct(matrix: Array, goal: Array) -> Array:
    """Reconstruct reflectances (n, N) of responses (n, 3) of a matrix (3, N)."""
    spectra = np.empty((len(goal), matrix.shape[1]))
    for block in blocks(len(goal), BLOCK):
        spectra[block] = _solve(matrix, goal[block])
    return spectra


def _solve(matrix: Array, goal: Array) -> Array:
    """Solve for some of the reflectances.

    The conditions of the least squares with multipliers λ, 2 Dᵀ D z + e^z Mᵀ λ = 0 and
    M e^z = goal, are solved for z = log ρ by Newton's method.
    """
    count = matrix.shape[1]
    slopes = np.diff(np.eye(count), axis=0)
    roughness = 2 * slopes.T @ slopes
    grey = goal.mean(axis=1, keepdims=True) / matrix.sum(axis=1).mean()
    logs = np.repeat(np.log(np.maximum(grey, DARKEST)), count, axis=1)
    multipliers = np.zeros((len(goal), 3))
    system = np.zeros((len(goal), count + 3, count + 3))
    diagonal = np.arange(count)
    for _ in range(STEPS):
        spectra = np.exp(logs)
        scaled = spectra[:, None] * matrix
        pull = np.einsum("ncw,nc->nw", scaled, multipliers)
        system[:, :count, :count] = roughness
        system[:, diagonal, diagonal] += pull
        system[:, :count, count:] = scaled.mT
        system[:, count:, :count] = scaled
        left = np.concatenate(
            [logs @ roughness + pull, spectra @ matrix.T - goal], axis=1
        )
        step = np.linalg.solve(system, left[..., None])[..., 0]
        longest = np.abs(step[:, :count]).max(axis=1, keepdims=True)
        step /= np.maximum(longest / LONGEST, 1)
        logs = logs - step[:, :count]
        multipliers = multipliers - step[:, count:]
    return np.exp(logs)


def prepare(task: Task) -> PreparedMethod:
    """Solve for reflectances."""
    sensor = task.sensor
    matrix = sensor.light.xyz

    def spectra(rgb: Array) -> Array:
        return reconstruct(matrix, sensor.xyz(rgb))

    return interpolated(spectra, task, matrix.nbytes)


METHODS = (
    Method(
        method="burns2019",
        title="Burns 2019",
        source=(
            "Burns, Chromatic adaptation transform by spectral reconstruction, Color "
            "Research & Application 44(5), 2019"
        ),
        prepare=prepare,
        reference_sensor=ours,
        claimed_range=(0, 1000),
        note="our solver; reflectances may exceed 1",
    ),
)
