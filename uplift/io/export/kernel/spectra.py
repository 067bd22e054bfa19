"""Evaluation of spectra from multipliers, for every model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        STRIDE,
        WIDTH,
        Basis,
        Block,
        Coefficients,
        Float,
        Int,
        Row,
        empty,
        unroll,
    )
    from uplift.io.export.kernel.moments import deviation


def polynomial(values: Row, basis: Basis, w: Int) -> Float:
    """Sum of multipliers times basis."""
    even: Float = values[0] * basis[w] + values[2] * basis[2 * WIDTH + w]
    odd: Float = values[1] * basis[WIDTH + w]
    for k in unroll(3, COUNT):
        if k % 2 == 0:
            even += values[k] * basis[k * WIDTH + w]
        if k % 2 == 1:
            odd += values[k] * basis[k * WIDTH + w]
    return even + odd


def add_spectrum(values: Row, weight: Float, basis: Basis, total: Block) -> None:
    """Add ``weight`` times the deviation from 1/2 of the spectrum of the multipliers in a row."""
    for w in range(WIDTH):
        total[w] += deviation(weight, polynomial(values, basis, w))


def evaluate_block(multipliers: Coefficients, basis: Basis, total: Block) -> None:
    """Evaluate the spectrum of multipliers."""
    values: Row = empty(STRIDE)
    for k in unroll(0, COUNT):
        values[k] = multipliers[k]
    for w in range(WIDTH):
        total[w] = 0.5 + deviation(1.0, polynomial(values, basis, w))
