"""Palettes: lights and materials designed for the colours that they must produce together (docs/palette.md)."""

from __future__ import annotations

from uplift.design.palette.atlas_export import designed_atlas, write_designed
from uplift.design.palette.design import Design, design
from uplift.design.palette.factor import FactorModel, factor_model
from uplift.design.palette.linear import LinearModel
from uplift.design.palette.matrix import Matrix, matrix
from uplift.design.palette.palette import ColourGoal, MinDifference, Palette, SpectrumSpec
from uplift.design.palette.plots import plot_matrix, plot_spectra
from uplift.design.palette.spec import read_palette
from uplift.design.palette.standard import standard_model
from uplift.design.palette.unmet_goals import Relaxation, UnmetGoal, unmet_goals

__all__ = [
    "ColourGoal",
    "Design",
    "FactorModel",
    "LinearModel",
    "Matrix",
    "MinDifference",
    "Palette",
    "Relaxation",
    "SpectrumSpec",
    "UnmetGoal",
    "design",
    "designed_atlas",
    "factor_model",
    "matrix",
    "plot_matrix",
    "plot_spectra",
    "read_palette",
    "standard_model",
    "unmet_goals",
    "write_designed",
]
