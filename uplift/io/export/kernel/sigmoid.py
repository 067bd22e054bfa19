"""Spectra of the sigmoid model in single precision, as in `uplift.models.sigmoid`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        END,
        START,
        WIDTH,
        Basis,
        Block,
        Bool,
        Coefficients,
        Float,
        sqrt,
    )


def squash(x: Float) -> Float:
    """1/2 + x / (2 √(1 + x²))."""
    return 0.5 + 0.5 * x / sqrt(1.0 + x * x)


def tabulate(wavelengths: Block, basis: Basis) -> None:
    """Tabulate x², x, 1 at wavelengths in nm, x scaled from the range to [-1, 1].

    Differences of magnitudes clip wavelengths to the range.
    """
    for w in range(WIDTH):
        x: Float = (2.0 * wavelengths[w] - (START + END)) / (END - START)
        x = 0.5 * (abs(x + 1.0) - abs(x - 1.0))
        basis[w] = x * x
        basis[WIDTH + w] = x
        basis[2 * WIDTH + w] = 1.0


def multipliers_of(coefficients: Coefficients, multipliers: Coefficients) -> Bool:
    """Copy coefficients: they are the multipliers."""
    for k in range(COUNT):
        multipliers[k] = coefficients[k]
    return True
