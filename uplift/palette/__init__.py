"""Palettes: lights and materials designed for the colours that they shall make (docs/palette.md)."""

from __future__ import annotations

from uplift.palette.design import Design, design
from uplift.palette.factor import FactorModel, factor_model
from uplift.palette.linear import LinearModel
from uplift.palette.matrix import Matrix, matrix
from uplift.palette.misses import Miss, misses
from uplift.palette.palette import Palette
from uplift.palette.pictures import plot_matrix, plot_spectra
from uplift.palette.spec import read_palette
from uplift.palette.standard import standard_model
from uplift.palette.written import designed_atlas, write_designed

__all__ = [
    "Design",
    "FactorModel",
    "LinearModel",
    "Matrix",
    "Miss",
    "Palette",
    "design",
    "designed_atlas",
    "factor_model",
    "matrix",
    "misses",
    "plot_matrix",
    "plot_spectra",
    "read_palette",
    "standard_model",
    "write_designed",
]
