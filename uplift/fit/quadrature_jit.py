"""The integrals from multipliers to stored moments, compiled."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

from uplift.common.arrays import Array
from uplift.fit.batch import batches, replicate, shard
from uplift.models.arctan import arctan
from uplift.models.duality import quadrature

MAX_NODES = 256
"""Larger rules, which few spectra need, are not worth compiling."""


def quadrature_jit(multipliers: Array, synthesis: Array, analysis: Array) -> Array:
    """Compute `uplift.models.duality.quadrature`, several times faster."""
    if len(analysis) > MAX_NODES + 1:
        return quadrature(multipliers, synthesis, analysis)
    moments = np.empty((len(multipliers), analysis.shape[1]))
    with jax.enable_x64(True):
        rule = replicate((synthesis, analysis))
        for rows, padded in batches(np.arange(len(multipliers))):
            moments[rows] = np.asarray(_weighted(shard(multipliers[padded]), *rule))[: len(rows)]
    return moments


@jax.jit
def _weighted(multipliers: jax.Array, synthesis: jax.Array, analysis: jax.Array) -> jax.Array:
    return (0.5 + arctan(multipliers @ synthesis) / jnp.pi) @ analysis
