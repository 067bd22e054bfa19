"""Evenly spaced wavelengths, as renderers use them: point sampled, or prefiltered."""

from __future__ import annotations

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.wavelengths.sampling import Sampling
from uplift.scene.wavelengths.setup import RenderSetup, interp_curves

START, END = 400.0, 700.0
"""Range in nm for which even spacing has the least error with few wavelengths."""


def midpoints(count: int, start: float = START, end: float = END) -> Array:
    """Midpoints (count,) of equal parts of ``start`` to ``end`` nm."""
    return start + (np.arange(count) + 0.5) * (end - start) / count


def uniform(setup: RenderSetup, count: int) -> Sampling:
    """Point sample the lights and the colour-matching functions at even spacing; whites balanced."""
    nm = midpoints(count)
    weights = interp_curves(nm, setup.wavelengths, setup.cmfs.T).T
    return Sampling(nm, weights, setup.lights, setup.sampled_powers(nm)).balanced()


def prefiltered_uniform(setup: RenderSetup, count: int) -> Sampling:
    """Prefilter the lights and the colour-matching functions at even spacing: `prefiltered` at `midpoints`."""
    return prefiltered(setup, midpoints(count))


def prefiltered(setup: RenderSetup, wavelengths: Array) -> Sampling:
    """Distribute lights and colour-matching functions over wavelengths (n,) nm by the weights of linear interpolation.

    Power outside the first and the last wavelength counts for these. The Y of white is exact.
    """
    hats = interp_curves(setup.wavelengths, wavelengths, np.eye(len(wavelengths)))
    powers = setup.powers @ hats.T / hats.sum(axis=1)
    lit = hats @ (setup.powers.sum(axis=0)[:, None] * setup.cmfs)
    weights = lit / np.maximum(powers.sum(axis=0), np.finfo(float).tiny)[:, None]
    return Sampling(wavelengths, weights, setup.lights, powers).balanced()
