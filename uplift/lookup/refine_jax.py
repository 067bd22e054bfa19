"""`uplift.lookup.refine` in JAX: mixtures are moved to their colours by a convex
problem, whose solution is differentiated as an implicit function.
"""

from dataclasses import dataclass
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from numpy.typing import DTypeLike

from uplift.common.arrays import Array, Mask
from uplift.cube import CubeData
from uplift.lookup.refine import (
    MAX_PULLS,
    PULLED,
    Pull,
    PullState,
    clearance,
    pull,
    shapes_between,
)
from uplift.models import solve_damped

CHUNK = 1024
"""Colours that are moved together. Chunks without any that need it are skipped."""
FACETS = 128
"""Facets of the object-colour solid that are tested at a time."""
ROUNDING = 16
"""Residual, in units of rounding, that counts as solved in single precision."""

jax.tree_util.register_dataclass(
    Pull, ["weights", "shapes", "scale"], meta_fields=["model"]
)


@partial(
    jax.tree_util.register_dataclass,
    data_fields=["cells", "problem", "shapes", "facets", "luminance", "margin"],
    meta_fields=["first"],
)
@dataclass(frozen=True, eq=False)
class Moves:
    """Arrays by which mixtures are moved, a pytree for JAX."""

    cells: Any
    """(dim³,) where nodes have not their own colours."""
    problem: Pull
    shapes: Any
    """(3, N) directions of the problem at the wavelengths of the cube of arrays."""
    facets: Any
    """(B, FACETS, 4) normals of the object-colour solid, and half its width along each,
    around a grey of 1/2.
    """
    luminance: Any
    """(3,) weights of linear RGB."""
    margin: Any
    """Distance by which goals are inside the solid."""
    first: int
    """Column of the values of nodes at which those at wavelengths of the sensor
    begin.
    """


def make_moves(
    data: CubeData, cells: Mask, wavelengths: Array, first: int, dtype: DTypeLike
) -> Moves:
    """Make the arrays, in numpy, for wavelengths (N,) in nm; ``cells`` are the inexact
    ones.
    """
    solid = data.solid
    half = len(solid.normals) // 2  # the others are opposite ones
    width = (solid.offsets[:half] + solid.offsets[half:]) / 2
    facets = np.column_stack([solid.normals[:half], width])
    facets = np.pad(facets, ((0, -half % FACETS), (0, 0)))
    problem = pull(data.model, data.sensor)
    moves = Moves(
        cells,
        problem,
        shapes_between(problem, data.sensor, wavelengths),
        facets.reshape(-1, FACETS, 4),
        data.sensor.rgb_to_xyz[1],
        np.array(data.threshold / 2),
        first,
    )
    return jax.tree.map(partial(_as_type, dtype), moves)


def _as_type(dtype: DTypeLike, array: Any) -> Any:
    return array if array.dtype == bool else array.astype(dtype)


def move(moves: Moves, values: jax.Array, rgb: jax.Array, rows: jax.Array) -> jax.Array:
    """Move the spectra (n, N) of some ``rows`` (n,) to their colours (n, 3), or to
    realisable ones of less chroma.

    ``values`` (n, K) are mixtures at the wavelengths of the cube of arrays and at those
    of the sensor.
    """
    width = moves.shapes.shape[1]

    def chunk(values: jax.Array, rgb: jax.Array, rows: jax.Array) -> jax.Array:
        spectra = values[:, :width]
        moved = lax.cond(
            rows.any(), partial(_moved, moves), lambda *_: spectra, values, rgb, rows
        )
        return jnp.where(rows[:, None], moved, spectra)

    if len(rows) <= CHUNK:
        return chunk(values, rgb, rows)
    # Those that are moved come first, so that the other chunks are skipped.
    order = jnp.argsort(~rows, stable=True)
    order = jnp.pad(order, (0, -len(rows) % CHUNK)).reshape(-1, CHUNK)
    moved = lax.map(lambda at: chunk(values[at], rgb[at], rows[at]), order)
    place = jnp.argsort(order.ravel()[: len(rows)])
    return moved.reshape(-1, width)[place]


def _moved(
    moves: Moves, values: jax.Array, rgb: jax.Array, rows: jax.Array
) -> jax.Array:
    """Move all spectra; those of other than ``rows`` are any."""
    # Grey is where it should be, so that no derivative of other rows is infinite.
    values, rgb = (jnp.where(rows[:, None], array, 0.5) for array in (values, rgb))
    problem = moves.problem
    model = problem.model
    first = moves.first
    spectra = values[:, : moves.shapes.shape[1]].T
    at_sensor = values[:, first : first + problem.shapes.shape[1]].T
    goal = problem.scale @ _within_solid(moves, rgb).T
    least = clearance(goal - problem.weights @ at_sensor)
    least = jnp.maximum(least, 4 * jnp.finfo(least.dtype).eps)
    linear = model.from_reflectance(jnp.clip(at_sensor, least, 1 - least))
    change = lax.custom_root(
        lambda y: (
            goal - problem.weights @ model.to_reflectance(linear + problem.shapes.T @ y)
        ),
        jnp.zeros_like(goal),
        lambda _, __: _solve(problem, linear, goal),
        _solve_tangent,
    )
    start = model.from_reflectance(jnp.clip(spectra, least, 1 - least))
    return model.to_reflectance(start + moves.shapes.T @ change).T


def _solve(problem: Pull, linear: jax.Array, goal: jax.Array) -> jax.Array:
    """Find y (3, n) from linear parts x (N, n)."""
    tolerance = max(PULLED, ROUNDING * float(jnp.finfo(goal.dtype).eps))

    def pending(state: PullState) -> jax.Array:
        return jnp.abs(state.residual).max(axis=0) > tolerance

    def is_unsolved(carry: tuple[jax.Array, PullState]) -> jax.Array:
        count, state = carry
        return (count < MAX_PULLS) & pending(state).any()

    def step(carry: tuple[jax.Array, PullState]) -> tuple[jax.Array, PullState]:
        count, before = carry
        after = problem.step(linear, goal, before)
        taken = partial(jnp.where, pending(before))
        return count + 1, jax.tree.map(taken, after, before)

    begin = (jnp.int32(0), problem.begin(linear, goal))
    return lax.while_loop(is_unsolved, step, begin)[1].solution


def _solve_tangent(derivative: Any, right: jax.Array) -> jax.Array:
    """Solve the linearised problem, 3 × 3 for each column of (3, n)."""
    unit = jnp.eye(3, dtype=right.dtype)
    columns = [derivative(jnp.broadcast_to(e[:, None], right.shape)) for e in unit]
    # The matrix is −W diag(S') Kᵀ.
    lower = [[-columns[b][a] for b in range(a + 1)] for a in range(3)]
    return -jnp.stack(solve_damped(lower, 0, right))


def _within_solid(moves: Moves, rgb: jax.Array) -> jax.Array:
    """Return the goals of linear RGB (n, 3), as `uplift.lookup.refine.within_solid`."""
    margin = moves.margin
    grey = jnp.clip(rgb @ moves.luminance, margin, 1 - margin)[:, None]
    chroma = rgb - grey
    # The nearest facet is found among all; the fraction is differentiated by it alone.
    facet = lax.stop_gradient(_nearest_facet(moves.facets, grey, chroma))
    normal, half_width = facet[:, :3], facet[:, 3]
    fraction = _ray_fraction(
        ((grey - 0.5) * normal).sum(axis=1), (2 * chroma * normal).sum(axis=1), half_width
    )
    inward = margin / jnp.maximum(jnp.abs(chroma).max(axis=1), margin)
    reach = (2 * fraction - inward)[:, None]
    return jnp.where(reach < 1, grey + jnp.maximum(reach, 0) * chroma, rgb)


def _nearest_facet(facets: jax.Array, grey: jax.Array, chroma: jax.Array) -> jax.Array:
    """Return the facets (n, 4) at which the rays from grey (n, 1) along twice the
    chroma (n, 3) leave the solid.
    """

    def nearer(
        best: tuple[jax.Array, jax.Array], block: jax.Array
    ) -> tuple[tuple[jax.Array, jax.Array], None]:
        normals = block[:, :3].T
        along = (grey - 0.5) * normals.sum(axis=0)
        fraction = _ray_fraction(along, 2 * chroma @ normals, block[:, 3])
        least = fraction.min(axis=1)
        closer = least < best[0]
        facet = jnp.where(closer[:, None], block[fraction.argmin(axis=1)], best[1])
        return (jnp.where(closer, least, best[0]), facet), None

    none = jnp.ones(len(grey), grey.dtype)
    start = (none, jnp.zeros((len(grey), 4), grey.dtype))
    return lax.scan(nearer, start, facets)[0][1]


def _ray_fraction(
    along: jax.Array, speed: jax.Array, half_width: jax.Array
) -> jax.Array:
    """Return the fraction of a ray up to facets, at most 1, by its start and its length
    along their normals.
    """
    room = jnp.maximum(half_width - jnp.where(speed > 0, along, -along), 0)
    speed = jnp.abs(speed)
    reached = speed > room
    return jnp.where(reached, room / jnp.where(reached, speed, 1), 1)
