"""Palettes: lights and materials designed for the colours that they must produce together (docs/palette.md)."""

from __future__ import annotations

from uplift.design.palette.colours import illuminant
from uplift.design.palette.design import Design, Matrix, UnmetGoal, design, matrix, unmet_goals, write_designed
from uplift.design.palette.factor import FactorModel, factor_model, standard_model
from uplift.design.palette.palette import ColourGoal, MinDifference, Palette, SpectrumSpec
from uplift.design.palette.plots import plot_matrix, plot_spectra
from uplift.design.palette.spec import read_palette

__all__ = [
    "ColourGoal",
    "Design",
    "FactorModel",
    "Matrix",
    "MinDifference",
    "Palette",
    "SpectrumSpec",
    "UnmetGoal",
    "design",
    "factor_model",
    "illuminant",
    "matrix",
    "plot_matrix",
    "plot_spectra",
    "read_palette",
    "standard_model",
    "unmet_goals",
    "write_designed",
]
