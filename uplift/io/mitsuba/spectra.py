"""The models in Dr.Jit's arithmetic, of one ray and of whole wavefronts alike (docs/mathematics.md, 2 and 3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.models import Model, Moments, Sigmoid
from uplift.models.phase import WARPS


def mixed(model: Model, multipliers: Sequence[Any], weights: Sequence[Any], wavelengths: Any) -> Any:
    """Reflectance at ``wavelengths``, a spectrum of Mitsuba's: ``weights`` of those with ``multipliers`` of C."""
    import drjit as dr

    parts = basis(model, wavelengths)
    found = dr.zeros(type(wavelengths))
    for some, weight in zip(multipliers, weights, strict=True):
        linear = sum(
            (part * some[order] for order, part in enumerate(parts)), start=dr.zeros(type(wavelengths))
        )
        found += weight * squash(model, linear)
    return found


def basis(model: Model, wavelengths: Any) -> list[Any]:
    """What multipliers are weighted by at ``wavelengths``: C of them."""
    import drjit as dr

    one = dr.ones(type(wavelengths))
    if isinstance(model, Sigmoid):
        middle, half = (model.start + model.end) / 2, (model.end - model.start) / 2
        x = (dr.clip(wavelengths, model.start, model.end) - middle) / half
        return [x * x, x, one]
    assert isinstance(model, Moments)
    cosine = dr.cos(_phase(model, wavelengths))
    waves = [one, cosine]
    for _ in range(2, model.count):
        waves.append(2 * cosine * waves[-1] - waves[-2])
    return [one, *(2 * wave for wave in waves[1:])]


def squash(model: Model, linear: Any) -> Any:
    """Reflectance of the linear part."""
    import drjit as dr

    if isinstance(model, Sigmoid):
        return 0.5 + 0.5 * linear * dr.rsqrt(1 + linear * linear)
    return 0.5 + dr.atan(linear) / dr.pi


def _phase(model: Moments, wavelengths: Any) -> Any:
    import drjit as dr

    phase = model.phase
    low, high = WARPS[phase.warp](np.array([phase.start, phase.end])).tolist()
    inside = dr.clip(wavelengths, phase.start, phase.end)
    warped = dr.tanh(0.0072 * (inside - 538)) if phase.warp == "vision" else inside
    return dr.pi * (warped - low) / (high - low) - dr.pi
