"""Move multipliers to exact colours by minimum-norm steps (`uplift.models.minimum_norm`). Needs numpy only.

Spectra are columns here, so that all arithmetic runs along contiguous memory. A spectrum is evaluated once; later steps
add its changes, which need no arc tangents of large numbers.
"""

import numpy as np

from uplift.colorimetry.solid import solid, toward_grey
from uplift.common.arrays import Array, Indices, Values
from uplift.cube import CubeData
from uplift.models.arithmetic import blocked_matmul, blocked_matmul_columns
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.minimum_norm import ForwardMap, forward_map, minimum_norm_step
from uplift.models.model import Model

TOLERANCE = 1e-8
"""Residual, max |linear RGB|, at which a colour is exact."""
MAX_STEPS = 24
FIRST_DAMPING = 1e-2
"""μ after a rejected full step; nearly all colours need one or two full steps and no damping."""
BLOCK_COLUMNS = 1024
"""Spectra processed at a time: their temporary arrays fit into the cache."""


def refine_to_rgb(data: CubeData, model: Model, start: Array, rgb: Array) -> Array:
    """Move multipliers ``start`` (n, C) of a model to linear RGB (n, 3), to the sensor and threshold of a cube.

    Unrealisable colours are replaced by the nearest realisable ones of less chroma. Colours that do not converge, such
    as those of the sigmoid near white in coarse cells, start again from grey.
    """
    forward = forward_map(model, data.sensor.wavelengths, data.sensor.matrix)
    multipliers, target, distance = _reach(data, forward, np.array(start.T, order="C"), rgb)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size:
        from_grey = np.zeros((len(multipliers), failed.size))
        better = _descend(forward, from_grey, target[:, failed]) < distance[failed]
        multipliers[:, failed[better]] = from_grey[:, better]
    return multipliers.T


def with_colours(data: CubeData, spectra: Values, at_sensor: Array, rgb: Array, wavelengths: Array) -> Values:
    """Move mixtures to their colours (n, 3), or to the nearest realisable ones (docs/mathematics.md, 9).

    ``spectra`` (n, N) are reflectances in [0, 1] at any wavelengths (N,) in nm, ``at_sensor`` (n, M) the same at those
    of the sensor. They need not be of the model: multipliers are added to their linear part. Those that have their
    colour stay to the last bit, and the others change continuously.
    """
    model = data.model
    forward = forward_map(model, data.sensor.wavelengths, data.sensor.matrix)
    # S(S⁻¹(g) + B Δp): the mixture g is the fixed part of the linear part, and steps find Δp.
    linear = model.from_reflectance(np.array(at_sensor.T, order="C"))
    change = _reach(data, forward, np.zeros((model.count, len(rgb))), rgb, linear)[0].T
    moved = model.to_reflectance(model.from_reflectance(spectra) + blocked_matmul(change, model.basis(wavelengths).T))
    return np.where((change != 0).any(axis=1)[:, None], moved, spectra)


def within_solid(data: CubeData, rgb: Array) -> Array:
    """Return the linear RGB (n, 3) to which unrealisable colours are moved; others are unchanged.

    Half of the threshold inside the object-colour solid, on the line to the grey of the same luminance, as
    unrealisable points of the lattice.
    """
    sensor = data.sensor
    return toward_grey(solid(sensor.matrix), sensor.grey(rgb), rgb, data.threshold / 2)


def _reach(
    data: CubeData, forward: ForwardMap, start: Array, rgb: Array, fixed: Array | None = None
) -> tuple[Array, Array, Array]:
    """Move multipliers (C, n) to linear RGB (n, 3); what is not reached may be unrealisable and is moved inside.

    Returns multipliers (C, n), the linear RGB (3, n) that they were moved to, and distances (n,) from it.
    """
    multipliers, target = start.copy(), np.array(rgb.T, order="C")
    distance = _descend(forward, multipliers, target, fixed)
    failed = np.flatnonzero(distance > data.threshold)
    if failed.size and data.inexact_cells is not None:
        # Targets outside the object-colour solid move to its boundary, on their line to grey (9).
        inside = within_solid(data, rgb[failed])
        moved = failed[(inside != rgb[failed]).any(axis=1)]
        target[:, failed] = inside.T
        again = start[:, moved].copy()
        part = None if fixed is None else fixed[:, moved]
        distance[moved] = _descend(forward, again, target[:, moved], part)
        multipliers[:, moved] = again
    return multipliers, target, distance


def _descend(forward: ForwardMap, multipliers: Array, target: Array, fixed: Array | None = None) -> Array:
    """Move multipliers (C, n) in place towards linear RGB (3, n) and return the final distances (n,).

    A fixed linear part (N, n) may be added to that of the multipliers.
    """

    def linear_part(columns: slice | Indices) -> Array:
        linear = blocked_matmul_columns(forward.basis, multipliers[:, columns])
        return linear if fixed is None else linear + fixed[:, columns]

    residual, damping = np.empty_like(target), np.zeros(target.shape[1])
    for first in range(0, target.shape[1], BLOCK_COLUMNS):
        block = slice(first, first + BLOCK_COLUMNS)
        linear = linear_part(block)
        # t − r with r = W S(B p); later steps subtract their own change of r.
        residual[:, block] = target[:, block] - blocked_matmul_columns(
            forward.sensor, forward.model.to_reflectance(linear)
        )
        _move(forward, multipliers, residual, damping, block, linear)
    for _ in range(MAX_STEPS - 1):
        pending = np.flatnonzero(np.abs(residual).max(axis=0) > TOLERANCE)
        if not pending.size:
            break
        for first in range(0, pending.size, BLOCK_COLUMNS):
            columns = pending[first : first + BLOCK_COLUMNS]
            _move(forward, multipliers, residual, damping, columns, linear_part(columns))
    return np.asarray(np.abs(residual).max(axis=0))


def _move(
    forward: ForwardMap,
    multipliers: Array,
    residual: Array,
    damping: Array,
    columns: slice | Indices,
    linear: Array,
) -> None:
    """Take one step of some columns with linear part (N, k); steps that do not reduce the residual are rejected.

    Multipliers (C, n), residual (3, n) and damping (n,) change in place.
    """
    current, off, mu = multipliers[:, columns], residual[:, columns], damping[columns]
    with np.errstate(over="ignore", invalid="ignore"):  # overflowing steps are rejected
        change = minimum_norm_step(forward, linear, off, mu)
        trial = current + change
        difference = forward.model.reflectance_change(linear, blocked_matmul_columns(forward.basis, change))
        trial_off = off - blocked_matmul_columns(forward.sensor, difference)
    # Damped as by Levenberg and Marquardt: μ falls after a step that helped, and rises after one that did not.
    better = (trial_off**2).sum(axis=0) < (off**2).sum(axis=0)
    better &= np.abs(trial).max(axis=0) <= MAX_MULTIPLIER
    multipliers[:, columns] = np.where(better, trial, current)
    residual[:, columns] = np.where(better, trial_off, off)
    damping[columns] = np.where(better, mu / 16, 4 * mu + FIRST_DAMPING)
