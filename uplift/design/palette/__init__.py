"""Palettes: lights and materials designed for the colours that they shall make (docs/palette.md)."""

from __future__ import annotations

from uplift.design.palette.atlas_export import designed_atlas, write_designed
from uplift.design.palette.design import Design, design
from uplift.design.palette.factor import FactorModel, factor_model
from uplift.design.palette.linear import LinearModel
from uplift.design.palette.matrix import Matrix, matrix
from uplift.design.palette.palette import Palette
from uplift.design.palette.plots import plot_matrix, plot_spectra
from uplift.design.palette.spec import read_palette
from uplift.design.palette.standard import standard_model
from uplift.design.palette.unmet_goals import UnmetGoal, unmet_goals

__all__ = [
    "Design",
    "FactorModel",
    "LinearModel",
    "Matrix",
    "Palette",
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
