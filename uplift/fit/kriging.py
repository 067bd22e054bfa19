"""Kriging of the deviation of atlas entries from a base predictor over CIE L*a*b* (docs/mathematics.md, 7).

Rasmussen & Williams 2006, "Gaussian processes for machine learning", eq. 2.25, and eq. 5.12 for leave-one-out.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights, lab, lab_jacobian
from uplift.common.arrays import Array, blocks
from uplift.fit.problem import Problem
from uplift.models.arithmetic import distances

REACH = 12.0
"""ΔE*ab within which a deviation that belongs to one entry alone fades away."""
JITTER = 1e-3
"""Relative variance of noise: entries of the same colour and different spectra are averaged."""
BLOCK_NUMBERS, BLOCK_ROWS = 1 << 20, 1 << 13
"""Numbers and rows of the kernel matrix that are held at a time, at most."""
LENGTHS = (6.0, 12.0, 24.0, 48.0)
NUGGETS = (0.01, 0.03, 0.1, 0.3, 1.0, 2.0)
DOUBT = 0.25
"""Entries' worth of the preference for `DEFAULT`, per squared doubling of the length or quadrupling of the nugget."""
MIN_ENTRIES = 8
"""Entries needed to learn a kernel."""
INVISIBLE = 1e-3
"""ΔE00 below which errors do not matter."""
MAX_ENTRIES = 200
"""Entries that are used: the kernel changes little with more, and its cost grows with their cube."""


@dataclass(frozen=True)
class Kernel:
    """Covariance of the deviations of two colours: exp(−d / length) + nugget · (1 − d / 12)⁴ (1 + 4 d / 12), d = ΔE*ab.

    The first term is common to the materials of an atlas. The second, the nugget, belongs to one entry: kriging keeps
    it at the colour of the entry and near it, and averages it elsewhere. It is the function of Wendland 1995,
    "Piecewise polynomial, positive definite and compactly supported radial functions of minimal degree".
    """

    length: Any
    nugget: Any

    def __call__(self, distance: Any) -> Any:
        """Evaluate the covariance at ΔE*ab, an array of numpy or JAX."""
        xp = distance.__array_namespace__()
        relative = xp.minimum(distance / REACH, 1.0)
        fade = (1 - relative) ** 2
        return xp.exp(distance / -self.length) + self.nugget * fade * fade * (1 + 4 * relative)


DEFAULT = Kernel(length=12.0, nugget=0.3)
"""Kernel of atlases that are too small to learn one."""


@dataclass(frozen=True, eq=False)
class Kriging:
    """Interpolated deviation d(x) = k(x)ᵀ w, from the L*a*b* (E, 3) and weights (E, C) of the entries."""

    locations: Array
    weights: Array
    kernel: Kernel

    def __call__(self, lab: Array) -> Array:
        """Deviation (n, C) at L*a*b* (n, 3)."""
        return kernel_sums(lab, self.locations, self.weights, self.kernel)[0]


def krige(locations: Array, deviations: Array, kernel: Kernel) -> tuple[Kriging, Array]:
    """Fit the kriging of deviations (E, C) at L*a*b* (E, 3); with it, return its leave-one-out errors (E, C)."""
    # w = (K + 10⁻³ I)⁻¹ D, and the error of entry i without itself is w_i / [(K + 10⁻³ I)⁻¹]_ii.
    precision = np.linalg.inv(kernel(distances(locations, locations)) + JITTER * np.eye(len(locations)))
    weights = precision @ deviations
    return Kriging(locations, weights, kernel), weights / np.diag(precision)[:, None]


def kernel_sums(lab: Array, locations: Array, columns: Array, kernel: Kernel) -> tuple[Array, Array]:
    """Sums (n, K) of the entries' columns (E, K) weighted by the kernel at L*a*b* (n, 3), and its maximum (n,)."""
    rows = max(min(BLOCK_NUMBERS // max(len(locations), 1), BLOCK_ROWS), 1)
    sums, nearest = np.empty((len(lab), columns.shape[1])), np.empty(len(lab))
    with jax.enable_x64(True):
        for block in blocks(len(lab), rows):
            count = block.stop - block.start
            some = lab[block] if count == rows else np.resize(lab[block], (rows, 3))  # one shape is compiled
            arrays = _kernel_block(kernel.length, kernel.nugget, some, locations, columns)
            sums[block], nearest[block] = (np.asarray(array)[:count] for array in arrays)
    return sums, nearest


@jax.jit
def _kernel_block(
    length: float, nugget: float, lab: jax.Array, locations: jax.Array, columns: jax.Array
) -> tuple[jax.Array, jax.Array]:
    squared = ((lab[:, None] - locations[None]) ** 2).sum(axis=-1)
    weights = Kernel(length, nugget)(jnp.sqrt(squared))
    return weights @ columns, weights.max(axis=1)


def learn_kernel(locations: Array, deviations: Array, visible: Array) -> Kernel:
    """Choose the kernel with the least mean visible error of left-out entries; few entries lean towards `DEFAULT`.

    The entries have L*a*b* (E, 3) and deviations (E, C), whose `visible_change` is (E, L, 3, C).
    """
    if len(locations) < MIN_ENTRIES:
        return DEFAULT
    rows = np.linspace(0, len(locations) - 1, min(len(locations), MAX_ENTRIES)).astype(np.int64)

    def loss(kernel: Kernel) -> float:
        # Visible leave-one-out error, and the surprise at a kernel that is not the default
        _, errors = krige(locations[rows], deviations[rows], kernel)
        changes = np.linalg.norm(np.einsum("elkc,ec->elk", visible[rows], errors), axis=-1)
        doublings = np.log2(kernel.length / DEFAULT.length)
        quadruplings = np.log2(kernel.nugget / DEFAULT.nugget) / 2
        surprise = float(doublings**2 + quadruplings**2)
        return float(np.log(changes.mean() + INVISIBLE)) + DOUBT / len(rows) * surprise

    return min((Kernel(*pair) for pair in product(LENGTHS, NUGGETS)), key=loss)


def visible_change(problem: Problem, measured: Array) -> Array:
    """Derivative (E, L, 3, C) of the colours of reflectances (E, N) under L lights by coefficients, in units of ΔE00.

    Lightness, chroma and hue difference change once the colour of the build is exact again. Moments are linear in the
    spectrum, which they determine up to its roughest parts: their basis approximates the change of the spectrum.
    """
    basis, sensor = problem.forward.basis, problem.forward.sensor @ problem.forward.basis
    # Of changes of the coefficients, only the part remains that a smooth change of the same colour does not undo:
    # I − M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ J with J = W B.
    smooth = sensor.T / problem.model.metric_diagonal()[:, None]
    metameric = np.eye(problem.model.count) - smooth @ np.linalg.solve(sensor @ smooth, sensor)
    changes = []
    for light in problem.lights:
        xyz = measured @ light.xyz.T
        to_delta_e = delta_e_2000_weights(lab(xyz, light.white)) @ lab_jacobian(xyz, light.white)
        changes.append(to_delta_e @ (light.xyz @ basis @ metameric))
    return np.stack(changes, axis=1)
