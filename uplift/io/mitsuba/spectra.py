"""Spectrum models in Dr.Jit, for single rays and for wavefronts (docs/mathematics.md, sections 2 and 3)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.models import Model, Moments, Sigmoid
from uplift.models.phase import WARPS

ARCTAN = (
    0.49999966,
    -0.318291775,
    0.249550106,
    -0.207882832,
    0.16639951,
    -0.10996833,
    0.048598712,
    -0.010096807,
)
"""arccos(c) / (π √(1 − c²)) on [0, 1] as a polynomial of c, lowered by its error to keep reflectances in [0, 1]."""


def blend(model: Model, multipliers: Sequence[Any], weights: Sequence[Any], wavelengths: Any) -> Any:
    """Return the weighted sum of spectra at ``wavelengths``, a Mitsuba spectrum; each has C multipliers."""
    import drjit as dr

    first, *functions = basis(model, wavelengths)
    total = dr.zeros(type(wavelengths))
    for each, weight in zip(multipliers, weights, strict=True):
        linear = first * each[0]
        for order, function in enumerate(functions, start=1):
            linear = dr.fma(function, each[order], linear)
        total = dr.fma(weight, squash(model, linear), total)
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
    twice = 2 * dr.cos(_phase(model, wavelengths))
    functions = [one, twice, dr.fma(twice, twice, -2)]
    while len(functions) < model.count:
        functions.append(dr.fma(twice, functions[-1], -functions[-2]))
    return functions


def squash(model: Model, linear: Any) -> Any:
    """Return the reflectance of a linear part x.

    The arc tangent is x c f(c) with c = 1 / √(1 + x²), its cosine, and f a polynomial. This needs no division, no
    branch and no range reduction. Reflectances differ by less than 1e-6.
    """
    import drjit as dr

    cosine = dr.rsqrt(dr.fma(linear, linear, 1))
    sine = linear * cosine
    if isinstance(model, Sigmoid):
        return dr.fma(sine, 0.5, 0.5)
    series = dr.fma(cosine, ARCTAN[-1], ARCTAN[-2])
    for coefficient in ARCTAN[-3::-1]:
        series = dr.fma(series, cosine, coefficient)
    return dr.fma(series, sine, 0.5)


def phase_range(model: Moments) -> Array:
    """Return the warped start and end (2,) of a model's phase."""
    return WARPS[model.phase.warp](np.array([model.phase.start, model.phase.end]))


def _phase(model: Moments, wavelengths: Any) -> Any:
    import drjit as dr

    low, high = phase_range(model).tolist()
    clipped = dr.clip(wavelengths, model.phase.start, model.phase.end)
    warped = dr.tanh(0.0072 * (clipped - 538)) if model.phase.warp == "vision" else clipped
    return dr.pi * (warped - low) / (high - low) - dr.pi
