"""Spectrum models, one a file, behind the interface of `uplift.models.model.Model`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from uplift.models.model import Model, evaluate, reflectance
from uplift.models.moments import Moments
from uplift.models.phase import Phase
from uplift.models.sigmoid import Sigmoid

__all__ = ["Model", "Moments", "Phase", "Sigmoid", "evaluate", "from_description", "reflectance"]


def from_description(description: Mapping[str, Any]) -> Model:
    """The model that ``Model.describe`` described. Raises KeyError or TypeError for anything else."""
    rest = {key: value for key, value in description.items() if key != "name"}
    if description["name"] == Sigmoid.name:
        return Sigmoid(**rest)
    if description["name"] == Moments.name:
        return Moments(count=rest["count"], phase=Phase(**rest["phase"]))
    raise KeyError(description["name"])
