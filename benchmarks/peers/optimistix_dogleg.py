"""``vmap`` of optimistix's Dogleg over many nodes: a general solver on the same JAX."""

from __future__ import annotations

import time
from importlib.metadata import version

import jax
import jax.numpy as jnp
import numpy as np
import optimistix

from benchmarks.peers import task
from benchmarks.peers.row import Peer, judge_multipliers
from uplift.common.arrays import Array
from uplift.fit.base import learn_base
from uplift.fit.problem import Problem
from uplift.models import Moments

COUNT = 9
POINTS = 1024
STEPS = 256
TOLERANCE = 1e-6
"""Of the step and the change of the residuals, relative and absolute; that of the residual of this package."""


def optimistix_dogleg(runs: int) -> list[Peer]:
    """Time the fit of multipliers, every node from the prior, as this package starts; compilation is separate."""
    model, sensor, target = Moments(COUNT), task.sensor(), task.some(POINTS)
    basis, weights = model.basis(sensor.wavelengths), sensor.matrix
    starts = learn_base(Problem(sensor, model))[0](target)
    solver = optimistix.Dogleg(rtol=TOLERANCE, atol=TOLERANCE)

    def residual(multipliers: jax.Array, rgb: jax.Array) -> jax.Array:
        return weights @ model.squash(basis @ multipliers) - rgb

    def one(rgb: jax.Array, start: jax.Array) -> jax.Array:
        return optimistix.least_squares(residual, solver, start, args=rgb, max_steps=STEPS, throw=False).value

    with jax.enable_x64(True):
        begin = time.process_time()
        compiled = jax.jit(jax.vmap(one)).lower(jnp.asarray(target), jnp.asarray(starts)).compile()
        seconds = time.process_time() - begin

        def solve() -> Array:
            return np.asarray(compiled(jnp.asarray(target), jnp.asarray(starts)))

        solution, cpu = task.measured(solve, POINTS, runs)
    answer = judge_multipliers(model, solution, sensor, target, least=0.99)
    notes = f"in p, from the prior; all points go on until the last has arrived; compilation, {seconds:.1f} s, is apart"
    tool = f"optimistix {version('optimistix')} Dogleg, `vmap`"
    return [Peer(tool, "moments", COUNT, POINTS, cpu, answer, notes)]
