"""Spectrum models in Dr.Jit, for single rays and for wavefronts (docs/mathematics.md, sections 2 and 3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.models import Model, Moments, Sigmoid
from uplift.models.phase import WARPS


def blend(model: Model, multipliers: Sequence[Any], weights: Sequence[Any], wavelengths: Any) -> Any:
    """Return the weighted sum of spectra at ``wavelengths``, a Mitsuba spectrum; each has C multipliers."""
    import drjit as dr

    functions = basis(model, wavelengths)
    total = dr.zeros(type(wavelengths))
    for each, weight in zip(multipliers, weights, strict=True):
        linear = sum(
            (function * each[order] for order, function in enumerate(functions)),
            start=dr.zeros(type(wavelengths)),
        )
        total += weight * squash(model, linear)
    return total


def basis(model: Model, wavelengths: Any) -> list[Any]:
    """Return the C basis functions of the linear part at ``wavelengths``."""
    import drjit as dr

    one = dr.ones(type(wavelengths))
    if isinstance(model, Sigmoid):
        middle, half = (model.start + model.end) / 2, (model.end - model.start) / 2
        x = (dr.clip(wavelengths, model.start, model.end) - middle) / half
        return [x * x, x, one]
    assert isinstance(model, Moments)
    cosine = dr.cos(_phase(model, wavelengths))
    cosines = [one, cosine]
    for _ in range(2, model.count):
        cosines.append(2 * cosine * cosines[-1] - cosines[-2])
    return [one, *(2 * each for each in cosines[1:])]


def squash(model: Model, linear: Any) -> Any:
    """Return the reflectance of a linear part."""
    import drjit as dr

    if isinstance(model, Sigmoid):
        return 0.5 + 0.5 * linear * dr.rsqrt(1 + linear * linear)
    return 0.5 + dr.atan(linear) / dr.pi


def _phase(model: Moments, wavelengths: Any) -> Any:
    import drjit as dr

    phase = model.phase
    low, high = WARPS[phase.warp](np.array([phase.start, phase.end])).tolist()
    clipped = dr.clip(wavelengths, phase.start, phase.end)
    warped = dr.tanh(0.0072 * (clipped - 538)) if phase.warp == "vision" else clipped
    return dr.pi * (warped - low) / (high - low) - dr.pi
