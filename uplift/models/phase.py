"""The phase of a wavelength: where it lies on the mirrored half circle [−π, 0] (docs/mathematics.md, 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError


def _even(wavelengths: Array) -> Array:
    return wavelengths


def _vision(wavelengths: Array) -> Array:
    """Antiderivative of the density that hero-wavelength renderers sample by, 1/cosh²(0.0072 (λ − 538)).

    Radziszewski, Boryczko & Alda 2009, "An improved technique for full spectral rendering".
    """
    return np.tanh(0.0072 * (wavelengths - 538.0))


WARPS: dict[str, Callable[[Array], Array]] = {"none": _even, "vision": _vision}
"""Increasing functions of the wavelength; ``vision`` gives more of the circle to where the eye sees best."""


@dataclass(frozen=True)
class Phase:
    """The map from [start, end] nm onto [−π, 0]; outside, wavelengths take the phase of the nearer end."""

    start: float = 380.0
    end: float = 780.0
    warp: str = "none"

    def __post_init__(self) -> None:
        if self.warp not in WARPS:
            raise OptionError(f"unknown warp '{self.warp}'", hint=f"use one of {', '.join(WARPS)}")
        if not 0 < self.start < self.end < np.inf:
            raise OptionError(f"a phase cannot run from {self.start} to {self.end} nm")

    def __call__(self, wavelengths: ArrayLike) -> Array:
        """Phases (N,) in [−π, 0] of wavelengths (N,) in nm."""
        warp = WARPS[self.warp]
        low, high = warp(np.array([self.start, self.end]))
        inside = np.clip(np.asarray(wavelengths, dtype=float), self.start, self.end)
        return np.pi * (warp(inside) - low) / (high - low) - np.pi
