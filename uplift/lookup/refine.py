"""Move spectra to exact colours: multipliers by minimum-norm steps, mixtures by a
convex problem. Needs numpy only.

Spectra are columns here, so that all arithmetic runs along contiguous memory. In
minimum-norm steps (`uplift.models.minimum_norm`) a spectrum is evaluated once; later
steps add its changes, which need no arc tangents of large numbers.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from uplift.colorimetry.object_colours import toward_grey
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Indices, Values, blocks
from uplift.cube.data import CubeData
from uplift.models.arithmetic import blocked_matmul_columns
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.minimum_norm import (
    ForwardMap,
    forward_map,
    minimum_norm_step,
    solve_damped,
)
from uplift.models.model import Model

TOLERANCE = 1e-8
"""Residual, max |linear RGB|, at which a colour is exact."""
MAX_STEPS = 24
FIRST_DAMPING = 1e-2
"""μ after a rejected full step; nearly all colours need one or two full steps and no
damping.
"""
PULLED = 1e-11
"""Residual, of scaled RGB, at which the convex problem ends: so small that spectra do
not depend on the steps.
"""
MAX_PULLS = 100
"""Steps of the convex problem; most colours need four, few more than 20."""
MIN_CURVATURE = 0.01
"""Least ratio of the curvatures after and before a step."""
REACH = 2.0
"""Longest step of a linear part x of the convex problem, relative to 1 + |x|. Where
spectra are nearly flat at 0 and 1, Newton's step may be longer by powers of ten.
"""
LEAST = 3e-4
"""Distance from 0 and 1 to which mixtures that are moved are clipped, so that programs
in single precision follow.
"""
SLOPE = 0.03
"""Growth of the distance with the residual."""
MOST = 1e-2
"""Largest distance."""
STEEP = 100.0
"""Largest distance over the residual: mixtures that nearly have their colours hardly
change.
"""
BLOCK_COLUMNS = 1024
"""Spectra processed at a time: their temporary arrays fit into the cache."""


def refine_to_rgb(data: CubeData, model: Model, start: Array, rgb: Array) -> Array:
    """Move multipliers ``start`` (n, C) of a model to linear RGB (n, 3), to the sensor
    and threshold of a cube.

    Colours that do not converge are tried again, from their start and from grey, with
    unrealisable ones replaced by realisable ones of less chroma (`within_solid`).
    Results that come no nearer to these are not taken.
    """
    forward = forward_map(model, data.sensor.wavelengths, data.sensor.matrix)
    multipliers = np.array(start.T, order="C")
    target = np.array(rgb.T, order="C")
    distance = _descend(forward, multipliers, target)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size:
        goal = within_solid(data, rgb[failed])
        grey = np.zeros((model.count, failed.size))
        for again in (np.array(start[failed].T, order="C"), grey):
            left = forward.residual(multipliers[:, failed].T, goal)
            after = _descend(forward, again, np.array(goal.T, order="C"))
            better = after < np.abs(left).max(axis=1)
            multipliers[:, failed[better]] = again[:, better]
    return multipliers.T


class PullState(NamedTuple):
    """Where the convex problem stands for n mixtures, which are columns; a pytree for
    JAX.
    """

    solution: Any
    """(3, n) y."""
    residual: Any
    """(3, n) of scaled RGB."""
    gram: Any
    """(6, n) W diag(S') Kᵀ, the lower triangle."""
    length: Any
    """(n,) share of Newton's step that is tried next."""


@dataclass(frozen=True, eq=False)
class Pull:
    """The convex problem that moves mixtures to their colours; a pytree for JAX.

    For y (3, n) with W S(x + Kᵀ y) = goal (3, n), from linear parts x (N, n).

    As S increases, this is the minimum of a convex function Φ, whose gradient is the
    negative residual, and Newton's steps (W diag(S') Kᵀ)⁻¹ r, shortened if need be,
    reach it for every colour inside the solid. Arrays are those of numpy or of JAX.
    """

    model: Model
    weights: Any
    """W (3, N) from reflectances to scaled RGB."""
    shapes: Any
    """K (3, N), the curves of the sensor without the power of the light, so that W = K
    diag(power) and W Kᵀ = I.
    """
    scale: Any
    """(3, 3) from linear to scaled RGB."""

    def begin(self, linear: Any, goal: Any) -> PullState:
        """Return the state at y = 0."""
        residual, gram = self._evaluate(linear, goal)
        return PullState(0 * goal, residual, gram, 0 * goal[0] + 1)

    def step(self, linear: Any, goal: Any, state: PullState) -> PullState:
        """Try a step: it is taken unless it goes too far, to where Φ rises more than
        half as steeply as it fell, or where it is much flatter.

        It changes no x by more than `REACH` (1 + |x|).
        """
        solution, residual, gram, length = state
        xp = solution.__array_namespace__()
        g00, g10, g11, g20, g21, g22 = gram
        lower = [[g00], [g10, g11], [g20, g21, g22]]
        step = xp.stack(solve_damped(lower, 0, residual))
        at = linear + self.shapes.T @ solution
        reach = (xp.abs(self.shapes.T @ step) / (1 + xp.abs(at))).max(axis=0)
        share = length / xp.maximum(1, length * reach / REACH)
        step = share * step
        trial = solution + step
        trial_residual, trial_gram = self._evaluate(
            linear + self.shapes.T @ trial, goal
        )
        rise = (trial_residual * step).sum(axis=0)
        good = rise >= -0.5 * (residual * step).sum(axis=0)
        t00, _, t11, _, _, t22 = trial_gram
        good &= t00 + t11 + t22 >= MIN_CURVATURE * (g00 + g11 + g22)
        return PullState(
            xp.where(good, trial, solution),
            xp.where(good, trial_residual, residual),
            xp.where(good, trial_gram, gram),
            xp.where(good, xp.minimum(4 * share, 1), share / 4),
        )

    def _evaluate(self, linear: Any, goal: Any) -> tuple[Any, Any]:
        """Return residual and Gram matrix of linear parts (N, n)."""
        rows, columns = np.tril_indices(3)
        products = self.weights[rows] * self.shapes[columns]
        residual = goal - self.weights @ self.model.to_reflectance(linear)
        return residual, products @ self.model.derivative(linear)


def pull(model: Model, sensor: Sensor) -> Pull:
    """Return the problem of a model and a sensor."""
    if sensor.sensitivities is None:
        shapes = sensor.cmfs @ sensor.xyz_to_rgb.T
    else:
        shapes = sensor.sensitivities / (sensor.sensitivities.T @ sensor.power)
    scale = np.linalg.inv(np.linalg.cholesky(sensor.matrix @ shapes))
    return Pull(model, scale @ sensor.matrix, scale @ shapes.T, scale)


def clearance(residual: Any) -> Any:
    """Return the distance (n,) from 0 and 1 to which mixtures with residuals (3, n) of
    scaled RGB are clipped before they are moved.
    """
    # Near 0 and 1 the linear part is large: the farther it moves, the farther it starts
    # from there.
    xp = residual.__array_namespace__()
    off = xp.abs(residual).max(axis=0)
    return xp.minimum(xp.minimum(LEAST + SLOPE * off, STEEP * off), MOST)


def with_colours(
    data: CubeData, spectra: Values, at_sensor: Array, rgb: Array, wavelengths: Array
) -> Values:
    """Move mixtures to their colours (n, 3), or to realisable ones of less chroma
    (docs/mathematics.md, 9).

    ``spectra`` (n, N) are reflectances in [0, 1] at any wavelengths (N,) in nm,
    ``at_sensor`` (n, M) the same at those of the sensor. They need not be of the model.
    Those that have their colour stay to the last bit.
    """
    model = data.model
    problem = pull(model, data.sensor)
    moved = spectra.copy()
    shapes_at = shapes_between(problem, data.sensor, wavelengths)
    pending = np.flatnonzero(
        np.abs(data.sensor.rgb(at_sensor) - rgb).max(axis=1) > TOLERANCE
    )
    for block in blocks(pending.size, BLOCK_COLUMNS):
        rows = pending[block]
        goal = problem.scale @ within_solid(data, rgb[rows]).T
        least = clearance(goal - problem.weights @ at_sensor[rows].T)
        linear = model.from_reflectance(np.clip(at_sensor[rows].T, least, 1 - least))
        change = _solve(problem, linear, goal)
        start = model.from_reflectance(np.clip(spectra[rows].T, least, 1 - least))
        moved[rows] = model.to_reflectance(start + shapes_at.T @ change).T
    return moved


def shapes_between(problem: Pull, sensor: Sensor, wavelengths: Array) -> Array:
    """Return K (3, N) at wavelengths (N,) in nm, linear between those of the sensor."""
    rows = [np.interp(wavelengths, sensor.wavelengths, row) for row in problem.shapes]
    return np.array(rows)


def _solve(problem: Pull, linear: Array, goal: Array) -> Array:
    """Find y (3, n) from linear parts x (N, n), by steps of the mixtures that need
    them.
    """
    state = problem.begin(linear, goal)
    for _ in range(MAX_PULLS):
        pending = np.flatnonzero(np.abs(state.residual).max(axis=0) > PULLED)
        if not pending.size:
            break
        before = PullState(*(array[..., pending] for array in state))
        after = problem.step(linear[:, pending], goal[:, pending], before)
        for array, values in zip(state, after, strict=True):
            array[..., pending] = values
    return state.solution


def within_solid(data: CubeData, rgb: Array) -> Array:
    """Return the linear RGB (n, 3) to which unrealisable colours are moved; others are
    unchanged.

    Half of the threshold inside the object-colour solid, on the line to the grey of the
    same luminance.
    """
    margin = data.threshold / 2
    return toward_grey(
        data.solid, np.clip(data.sensor.grey(rgb), margin, 1 - margin), rgb, margin
    )


def _descend(forward: ForwardMap, multipliers: Array, target: Array) -> Array:
    """Move multipliers (C, n) in place towards linear RGB (3, n) and return the final
    distances (n,).
    """
    count = target.shape[1]
    descent = _Descent(forward, multipliers, target.copy(), np.zeros(count))
    for block in blocks(count, BLOCK_COLUMNS):
        linear = blocked_matmul_columns(forward.basis, multipliers[:, block])
        # t − r with r = W S(B p); later steps subtract their own change of r.
        reached = forward.model.to_reflectance(linear)
        descent.residual[:, block] -= blocked_matmul_columns(forward.sensor, reached)
        descent.move(block, linear)
    for _ in range(MAX_STEPS - 1):
        pending = np.flatnonzero(np.abs(descent.residual).max(axis=0) > TOLERANCE)
        if not pending.size:
            break
        for block in blocks(pending.size, BLOCK_COLUMNS):
            columns = pending[block]
            linear = blocked_matmul_columns(forward.basis, multipliers[:, columns])
            descent.move(columns, linear)
    return np.abs(descent.residual).max(axis=0)


@dataclass(frozen=True, eq=False)
class _Descent:
    """Multipliers (C, n), their residuals (3, n) and damping (n,), which change in
    place.
    """

    forward: ForwardMap
    multipliers: Array
    residual: Array
    damping: Array

    def move(self, columns: slice | Indices, linear: Array) -> None:
        """Take one step of some columns with linear part (N, k); steps that do not
        reduce the residual are rejected.
        """
        forward = self.forward
        current = self.multipliers[:, columns]
        off = self.residual[:, columns]
        mu = self.damping[columns]
        # Overflowing steps are rejected.
        with np.errstate(over="ignore", invalid="ignore"):
            change = minimum_norm_step(forward, linear, off, mu)
            trial = current + change
            difference = forward.model.reflectance_change(
                linear, blocked_matmul_columns(forward.basis, change)
            )
            trial_off = off - blocked_matmul_columns(forward.sensor, difference)
        # Damped as by Levenberg and Marquardt: μ falls after a step that helped, and
        # rises after one that did not.
        better = (trial_off**2).sum(axis=0) < (off**2).sum(axis=0)
        better &= np.abs(trial).max(axis=0) <= MAX_MULTIPLIER
        self.multipliers[:, columns] = np.where(better, trial, current)
        self.residual[:, columns] = np.where(better, trial_off, off)
        self.damping[columns] = np.where(better, mu / 16, 4 * mu + FIRST_DAMPING)
