"""Palettes: lights and materials designed for the colours that they shall make (docs/palette.md)."""

from __future__ import annotations

from uplift.palette.factor import FactorModel, factor_model
from uplift.palette.standard import standard_model

__all__ = ["FactorModel", "factor_model", "standard_model"]
