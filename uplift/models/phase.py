"""The map from wavelength to phase on the mirrored half circle [−π, 0] (docs/mathematics.md, 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.common.arrays import Array
from uplift.common.errors import OptionError


def _identity(wavelengths: Array) -> Array:
    return wavelengths


def _vision(wavelengths: Array) -> Array:
    """Antiderivative of the density that hero-wavelength renderers sample by, 1/cosh²(0.0072 (λ − 538)).

    Radziszewski, Boryczko & Alda 2009, "An improved technique for full spectral rendering".
    """
    return np.tanh(0.0072 * (wavelengths - 538.0))


WARPS: dict[str, Callable[[Array], Array]] = {"none": _identity, "vision": _vision}
"""Increasing functions of the wavelength; ``vision`` gives more phase to wavelengths of high luminous efficiency."""


@dataclass(frozen=True)
class Phase:
    """Map from [start, end] nm to [−π, 0]; wavelengths outside take the phase of the nearer end.

    Parameters
    ----------
    start, end : float
        Range in nm.
    warp : {"none", "vision"}
        Increasing function applied to the wavelength before the linear map.

    Raises
    ------
    OptionError
        The warp is unknown or the range is empty.
    """

    start: float = 380.0
    end: float = 780.0
    warp: str = "none"

    def __post_init__(self) -> None:
        if self.warp not in WARPS:
            raise OptionError(f"unknown warp '{self.warp}'", code="unknown-warp", hint=f"use one of {', '.join(WARPS)}")
        if not 0 < self.start < self.end < np.inf:
            raise OptionError(
                f"a phase needs 0 < start < end < inf, got start {self.start} and end {self.end}",
                code="invalid-phase-range",
            )

    def __call__(self, wavelengths: ArrayLike) -> Array:
        """Convert wavelengths (N,) in nm to phases (N,) in [−π, 0]."""
        warp = WARPS[self.warp]
        low, high = warp(np.array([self.start, self.end]))
        inside = np.clip(np.asarray(wavelengths, dtype=float), self.start, self.end)
        return np.pi * (warp(inside) - low) / (high - low) - np.pi
