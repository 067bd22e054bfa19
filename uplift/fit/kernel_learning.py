"""The kernel of an atlas, and the trust in it, from its left-out entries
(docs/mathematics.md, 7).
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000_weights, lab, lab_jacobian
from uplift.common.arrays import Array
from uplift.fit.kriging import (
    DEFAULT,
    METRIC,
    REACH,
    Kernel,
    Kriging,
    average_close,
    krige_points,
)
from uplift.fit.neighbours import nearest_other
from uplift.fit.problem import Problem

LENGTHS = (6.0, 12.0, 24.0, 48.0, 96.0, 192.0)
NOISES = (0.01, 0.03, 0.1, 0.3, 1.0, 3.0)
"""Kernels that are tried."""
MIN_REACH = 1.0
"""Least reach of an entry: several may have one colour."""
DOUBT = 0.5
"""Entries' worth of the preference for `DEFAULT`, per squared doubling of the length or
quadrupling of the noise.
"""
MIN_ENTRIES = 8
"""Entries needed to learn a kernel."""
MEDIAN_STEPS = 3
"""Steps towards the median."""
DOUBTFUL = 0.2
"""Share of the mean error that is added to each error."""
INVISIBLE = 1e-3
"""ΔE00 below which errors do not matter."""
TRUSTS = np.arange(10, 21) / 20
"""Values of the trust that are tried."""
TRUST_ENTRIES = 50
"""Entries needed to learn the trust."""
TRUST = 0.85
"""Trust in atlases that are too small to learn it."""


def learn_kriging(
    lab: Array, deviations: Array, visible: Array, trust: float | None = None
) -> tuple[Kriging, Array]:
    """Return the kriging with the least mean visible error of left-out entries, and its
    errors, as `krige` does.

    The entries have L*a*b* (E, 3) and deviations (E, C), whose `visible_change` is (E,
    L, 3, C). Few entries lean towards `DEFAULT`. The ``trust`` is learnt as well if it
    is not given.
    """
    points = average_close(lab * METRIC, deviations)
    default = DEFAULT._replace(reach=entry_reach(lab))
    if len(lab) < MIN_ENTRIES:
        kriging, errors = krige_points(points, deviations, default)
        return replace(kriging, trust=TRUST if trust is None else trust), errors

    def changes(errors: Array) -> Array:
        change = np.linalg.norm(np.einsum("elkc,ec->elk", visible, errors), axis=-1)
        return change.mean(axis=1) + INVISIBLE

    def loss(kernel: Kernel) -> float:
        # Visible leave-one-out error, and the surprise at a kernel that is not the
        # default
        doublings = np.log2(kernel.length / default.length)
        quadruplings = np.log2(kernel.noise / default.noise) / 2
        surprise = DOUBT / len(lab) * (doublings**2 + quadruplings**2)
        error = changes(krige_points(points, deviations, kernel)[1]).mean()
        return float(np.log(error) + surprise)

    # Entries vary as they deviate: weights 1 / v of squares |e|² with v = |e| minimise
    # the sum of |e|, a median.
    kernel = _descend(default, loss)
    kriging, errors = krige_points(points, deviations, kernel)
    for _ in range(MEDIAN_STEPS):
        missed = changes(errors)
        missed += DOUBTFUL * missed.mean()
        variances = missed / np.exp(np.log(missed).mean())
        kriging, errors = krige_points(points, deviations, kernel, variances)
    if trust is None:
        trust = _learn_trust(deviations, errors, changes)
    return replace(kriging, trust=trust), deviations - trust * (deviations - errors)


def entry_reach(lab: Array) -> float:
    """Return the `Kernel.reach` of entries at L*a*b* (E, 3): an entry speaks for what
    is nearer to it than to the next one.
    """
    if not len(lab):
        return REACH
    spacing = float(np.median(nearest_other(lab * METRIC)))
    return min(max(spacing, MIN_REACH), REACH)


def _descend(kernel: Kernel, loss: Callable[[Kernel], float]) -> Kernel:
    """Return the kernel of least loss among its neighbours, by steps from one to the
    next.
    """

    @cache
    def loss_at(place: tuple[int, int]) -> float:
        return loss(at(place))

    def at(place: tuple[int, int]) -> Kernel:
        length, noise = place
        return kernel._replace(length=LENGTHS[length], noise=NOISES[noise])

    best = LENGTHS.index(kernel.length), NOISES.index(kernel.noise)
    place = None
    while place != best:
        place = best
        lengths = range(max(place[0] - 1, 0), min(place[0] + 2, len(LENGTHS)))
        noises = range(max(place[1] - 1, 0), min(place[1] + 2, len(NOISES)))
        best = min((place, *product(lengths, noises)), key=loss_at)
    return at(best)


def _learn_trust(
    deviations: Array, errors: Array, changes: Callable[[Array], Array]
) -> float:
    """Return the least trust whose visible error of left-out entries is within one
    standard error of the least: materials of another kind are the better answered.

    Breiman, Friedman, Olshen & Stone 1984, "Classification and regression trees",
    section 3.4.3.
    """
    count = len(deviations)
    if count < TRUST_ENTRIES:
        return TRUST
    expected = deviations - errors
    losses = np.stack([changes(deviations - trust * expected) for trust in TRUSTS])
    means = losses.mean(axis=1)
    best = means.argmin()
    enough = means <= means[best] + losses[best].std() / np.sqrt(count)
    return float(TRUSTS[enough.argmax()])


def visible_change(problem: Problem, measured: Array) -> Array:
    """Derivative (E, L, 3, C) of the colours of reflectances (E, N) under L lights by
    coefficients, in units of ΔE00.

    Lightness, chroma and hue difference change once the colour of the build is exact
    again. Moments are linear in the spectrum, which they determine up to its roughest
    parts: their basis approximates the change of the spectrum.
    """
    basis = problem.forward.basis
    sensor = problem.forward.sensor @ problem.forward.basis
    # Of changes of the coefficients, only the part remains that a smooth change of the
    # same colour does not undo: I − M⁻¹ Jᵀ (J M⁻¹ Jᵀ)⁻¹ J with J = W B.
    smooth = sensor.T / problem.model.metric_diagonal()[:, None]
    metameric = np.eye(problem.model.count) - smooth @ np.linalg.solve(
        sensor @ smooth, sensor
    )
    changes = []
    for light in problem.lights:
        xyz = measured @ light.xyz.T
        to_delta_e = delta_e_2000_weights(lab(xyz, light.white)) @ lab_jacobian(
            xyz, light.white
        )
        changes.append(to_delta_e @ (light.xyz @ basis @ metameric))
    return np.stack(changes, axis=1)
