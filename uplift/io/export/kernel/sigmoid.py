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
        Int,
        number,
        sqrt,
        unroll,
    )


def deviation(weight: Float, x: Float) -> Float:
    """Weighted x / (2 √(1 + x²))."""
    return weight * 0.5 * x / sqrt(1.0 + x * x)


def scaled(wavelength: Float) -> Float:
    """Wavelength scaled from the range to [-1, 1]; differences of magnitudes clip it."""
    x: Float = (2.0 * wavelength - (START + END)) / (END - START)
    return 0.5 * (abs(x + 1.0) - abs(x - 1.0))


def argument(first: Int, wavelength: Float) -> Float:
    """Evaluate the quadratic polynomial of the multipliers from an index in the table."""
    x: Float = scaled(wavelength)
    return (number(first) * x + number(first + 1)) * x + number(first + 2)


def tabulate(wavelengths: Block, basis: Basis) -> None:
    """Tabulate x², x, 1 at wavelengths in nm."""
    for w in range(WIDTH):
        x: Float = scaled(wavelengths[w])
        basis[w] = x * x
        basis[WIDTH + w] = x
        basis[2 * WIDTH + w] = 1.0


def dual(coefficients: Coefficients, multipliers: Coefficients) -> Bool:
    """Copy coefficients: they are the multipliers."""
    for k in unroll(0, COUNT):
        multipliers[k] = coefficients[k]
    return True


def multipliers_of(coefficients: Coefficients, multipliers: Coefficients) -> Bool:
    """Copy coefficients."""
    return dual(coefficients, multipliers)
