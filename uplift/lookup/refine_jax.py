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

from uplift.common.arrays import Array
from uplift.cube.data import CubeData
from uplift.lookup.refine import (
    MAX_PULLS,
    PULLED,
    Pull,
    PullState,
    clearance,
    pull,
    shapes_between,
)
from uplift.models.minimum_norm import solve_damped
from uplift.models.model import Model

CHUNK = 512
"""Colours that are moved together. Chunks without any that need it are skipped."""
FACETS = 128
"""Facets of the object-colour solid that are tested at a time."""
LEAST_ROOM = 1e-9
"""Room, in linear RGB, between a grey and a facet that is rounding."""
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

    cells: jax.Array
    """(dim³,) where nodes have not their own colours."""
    problem: Pull
    shapes: jax.Array
    """(3, N) directions of the problem at the wavelengths of the cube of arrays."""
    facets: jax.Array
    """(B, FACETS, 4) normals of the object-colour solid, and half its width along each,
    around a grey of 1/2.
    """
    luminance: jax.Array
    """(3,) weights of linear RGB."""
    margin: jax.Array
    """Distance by which goals are inside the solid."""
    first: int
    """Column of the values of nodes at which those at wavelengths of the sensor
    begin.
    """


def make_moves(
    data: CubeData, wavelengths: Array, first: int, dtype: DTypeLike
) -> Moves:
    """Make the arrays, in numpy, of a cube with inexact cells, for wavelengths (N,) in
    nm.
    """
    solid = data.solid
    half = len(solid.normals) // 2  # the others are opposite ones
    width = (solid.offsets[:half] + solid.offsets[half:]) / 2
    facets = np.column_stack([solid.normals[:half], width])
    facets = np.pad(facets, ((0, -half % FACETS), (0, 0)), mode="edge")
    problem = pull(data.model, data.sensor)
    arrays: dict[str, Any] = {
        "cells": data.inexact_cells,
        "shapes": shapes_between(problem, data.sensor, wavelengths),
        "facets": facets.reshape(-1, FACETS, 4),
        "luminance": data.sensor.rgb_to_xyz[1],
        "margin": np.array(data.threshold / 2),
    }
    moves = Moves(problem=problem, first=first, **arrays)
    return jax.tree.map(partial(_as_type, dtype), moves)


def _as_type(dtype: DTypeLike, array: Any) -> Any:
    return array if array.dtype == bool else array.astype(dtype)


def move(
    moves: Moves, values: jax.Array, rgb: jax.Array, cells: jax.Array
) -> jax.Array:
    """Return spectra (n, N) that in some of the ``cells`` (n,) are moved to their
    colours (n, 3), or to realisable ones of less chroma.

    ``values`` (n, K) are mixtures at the wavelengths of the spectra and at those of the
    sensor. NaN stays.
    """
    width = moves.shapes.shape[1]
    inexact = moves.cells[cells] & ~jnp.isnan(values[:, 0])

    def chunk(arrays: tuple[jax.Array, jax.Array, jax.Array]) -> jax.Array:
        values, _, rows = arrays
        return lax.cond(
            rows.any(), lambda: _moved(moves, *arrays), lambda: values[:, :width]
        )

    count = len(values)
    if count <= CHUNK:
        return chunk((values, rgb, inexact))
    # Those that are moved come first, so that other chunks are skipped.
    order = jnp.argsort(~inexact, stable=True)
    padded = jnp.pad(order, (0, -count % CHUNK)).reshape(-1, CHUNK)
    chunks = jax.tree.map(lambda array: array[padded], (values, rgb, inexact))
    return lax.map(chunk, chunks).reshape(-1, width)[jnp.argsort(order)]


def _moved(
    moves: Moves, values: jax.Array, rgb: jax.Array, rows: jax.Array
) -> jax.Array:
    """Return the spectra (n, N) of a chunk, some ``rows`` (n,) of which are moved."""
    mixed = values[:, : moves.shapes.shape[1]]
    # Grey has its colour: of rows that stay, no derivative is infinite.
    values = jnp.where(rows[:, None], values, 0.5).T
    rgb = jnp.where(rows[:, None], rgb, 0.5)
    problem = moves.problem
    model = problem.model
    at_sensor = values[moves.first :]
    goal = problem.scale @ _within_solid(moves, rgb).T
    least = clearance(goal - problem.weights @ at_sensor)
    least = jnp.maximum(least, 4 * _rounding(least))
    linear = model.from_reflectance(jnp.clip(at_sensor, least, 1 - least))
    change = lax.custom_root(
        lambda y: (
            goal - problem.weights @ _reflectance(model, linear + problem.shapes.T @ y)
        ),
        jnp.zeros_like(goal),
        lambda _, __: _solve(problem, linear, goal),
        _solve_tangent,
    )
    start = jnp.clip(values[: len(mixed.T)], least, 1 - least)
    start = model.from_reflectance(start)
    moved = _reflectance(model, start + moves.shapes.T @ change)
    return jnp.where(rows[:, None], moved.T, mixed)


def _rounding(array: jax.Array) -> float:
    return float(np.finfo(array.dtype).eps)


@partial(jax.custom_jvp, nondiff_argnums=(0,))
def _reflectance(model: Model, linear: jax.Array) -> jax.Array:
    # Derivatives by the model take less memory than those of each operation.
    return model.to_reflectance(linear)


@_reflectance.defjvp
def _(model: Model, primals: Any, tangents: Any) -> tuple[jax.Array, jax.Array]:
    (linear,), (change,) = primals, tangents
    return _reflectance(model, linear), model.derivative(linear) * change


def _solve(problem: Pull, linear: jax.Array, goal: jax.Array) -> jax.Array:
    """Find y (3, n) from linear parts x (N, n)."""
    tolerance = max(PULLED, ROUNDING * _rounding(goal))

    def pending(state: PullState) -> jax.Array:
        # Next to the solution, rounding refuses steps: what it hides is tolerated.
        off = jnp.abs(state.residual).max(axis=0)
        return off * state.length > tolerance

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
    first, second, third = (-column for column in columns)
    lower = [
        [first[0]],
        [first[1], second[1]],
        [first[2], second[2], third[2]],
    ]
    return -jnp.stack(solve_damped(lower, 0, right, _rounding(right) / 8))


def _within_solid(moves: Moves, rgb: jax.Array) -> jax.Array:
    """Return the goals of linear RGB (n, 3), as `uplift.lookup.refine.within_solid`."""
    margin = moves.margin
    grey = jnp.clip(rgb @ moves.luminance, margin, 1 - margin)[:, None]
    chroma = rgb - grey
    # The facet is found among all. The fraction is differentiated by it alone.
    facet = lax.stop_gradient(_nearest_facet(moves.facets, grey, 2 * chroma))
    normal = facet[:, :3]
    along = ((grey - 0.5) * normal).sum(axis=1)
    speed = (2 * chroma * normal).sum(axis=1)
    fraction = 1 / jnp.maximum(_ratio(along, speed, facet[:, 3]), 1)
    inward = margin / jnp.maximum(jnp.abs(chroma).max(axis=1), margin)
    reach = (2 * fraction - inward)[:, None]
    return jnp.where(reach < 1, grey + jnp.maximum(reach, 0) * chroma, rgb)


def _nearest_facet(facets: jax.Array, grey: jax.Array, ray: jax.Array) -> jax.Array:
    """Return the facets (n, 4) at which rays (n, 3) from grey (n, 1) leave the
    solid.
    """

    def compare(
        best: tuple[jax.Array, jax.Array], turn: tuple[jax.Array, jax.Array]
    ) -> tuple[tuple[jax.Array, jax.Array], None]:
        number, block = turn
        normals = block[:, :3].T
        along = (grey - 0.5) * normals.sum(axis=0)
        ratio = _ratio(along, ray @ normals, block[:, 3]).max(axis=1)
        closer = ratio > best[0]
        numbers = jnp.where(closer, number, best[1])
        return (jnp.where(closer, ratio, best[0]), numbers), None

    turns = (jnp.arange(len(facets), dtype=jnp.int32), facets)
    none = (0 * ray[:, 0], jnp.zeros(len(ray), jnp.int32))
    (_, number), _ = lax.scan(compare, none, turns)
    # Only in the block of each ray is the facet itself looked for, which is slow.
    block = facets[number]
    normals = block[:, :, :3]
    along = (grey - 0.5) * normals.sum(axis=2)
    speed = (normals @ ray[:, :, None])[:, :, 0]
    nearest = _ratio(along, speed, block[:, :, 3]).argmax(axis=1)
    return jnp.take_along_axis(block, nearest[:, None, None], axis=1)[:, 0]


def _ratio(along: jax.Array, speed: jax.Array, width: jax.Array) -> jax.Array:
    """Return speed over room of facets and their opposites, by the places of greys
    along their normals.
    """
    room = width - jnp.where(speed > 0, along, -along)
    return jnp.abs(speed) / jnp.maximum(room, LEAST_ROOM)
