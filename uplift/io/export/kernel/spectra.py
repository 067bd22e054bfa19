"""Evaluation of spectra from multipliers, for every model."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from uplift.io.export.kernel.intrinsics import (
        COUNT,
        WIDTH,
        Basis,
        Block,
        Coefficients,
        Float,
        Row,
        unroll,
    )
    from uplift.io.export.kernel.moments import squash


def add_spectrum(values: Row, weight: Float, basis: Basis, total: Block) -> None:
    """Add ``weight`` times the spectrum of the multipliers in a row."""
    for w in range(WIDTH):
        x: Float = 0.0
        for k in unroll(0, COUNT):
            x += values[k] * basis[k * WIDTH + w]
        total[w] += weight * squash(x)


def evaluate_block(multipliers: Coefficients, basis: Basis, total: Block) -> None:
    """Evaluate the spectrum of multipliers."""
    for w in range(WIDTH):
        x: Float = 0.0
        for k in unroll(0, COUNT):
            x += multipliers[k] * basis[k * WIDTH + w]
        total[w] = squash(x)
