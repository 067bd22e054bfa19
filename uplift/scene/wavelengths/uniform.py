"""Evenly spaced wavelengths, as renderers take them: read off, or averaged over bins."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.wavelengths.sampling import Sampling
from uplift.scene.wavelengths.setup import RenderSetup, interp_curves

FROM, TO = 400.0, 700.0
"""Where even spacing does best for few wavelengths: beyond, the eye sees little (nm)."""


def midpoints(count: int, start: float = FROM, end: float = TO) -> Array:
    """(count,) the middles of equal parts of ``start`` to ``end`` nm."""
    return start + (np.arange(count) + 0.5) * (end - start) / count


def uniform(setting: RenderSetup, count: int) -> Sampling:
    """Evenly spaced, lights and matching functions read off at the wavelengths; whites balanced."""
    nm = midpoints(count)
    weights = interp_curves(nm, setting.wavelengths, setting.cmfs.T).T
    return Sampling(nm, weights, setting.lights, setting.sampled_powers(nm)).balanced()


def prefiltered_uniform(setting: RenderSetup, count: int) -> Sampling:
    """Evenly spaced, lights and matching functions prefiltered: `prefiltered` at `midpoints`."""
    return prefiltered(setting, midpoints(count))


def prefiltered(setting: RenderSetup, wavelengths: Array) -> Sampling:
    """Lights and matching functions spread onto wavelengths (n,) nm as linear interpolation between them has it.

    What lies beyond the first and the last goes to these. The whites are exact in Y.
    """
    hats = np.stack([np.interp(setting.wavelengths, wavelengths, row) for row in np.eye(len(wavelengths))])
    powers = setting.powers @ hats.T / hats.sum(axis=1)
    lit = hats @ (setting.powers.sum(axis=0)[:, None] * setting.cmfs)
    weights = lit / np.maximum(powers.sum(axis=0), np.finfo(float).tiny)[:, None]
    return Sampling(wavelengths, weights, setting.lights, powers).balanced()
