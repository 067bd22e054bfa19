"""Criteria of mixing models, and reflectance of surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.design.mixing import surface
from uplift.design.mixing.criteria import CRITERIA, CriterionResult, evaluate
from uplift.design.mixing.mixers import mixers
from uplift.lookup import Cube

INDICES = (1.33, 1.48, 1.5, 1.66)
"""Water, light oil, glass and linseed oil, heavy oil."""


def criteria(cube: Cube) -> dict[str, Any]:
    """Evaluate every mixer by every criterion of section 10.4."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    rows = []
    for mixer in mixers(cube):
        verdicts = evaluate(mixer, cube.data.sensor, coloured)
        rows.append({"mixer": mixer.title, "verdicts": [verdict_record(verdict) for verdict in verdicts]})
    titles = [{"title": one.title, "measure": one.measure, "limit": one.limit} for one in CRITERIA]
    return {"patches": len(coloured), "criteria_titles": titles, "criteria": rows}


def verdict_record(verdict: CriterionResult) -> dict[str, Any]:
    """Return whether a criterion holds, and the measured value."""
    return {"obeys": bool(verdict.passed), "value": float(verdict.value) + 0.0}


def surfaces() -> dict[str, Any]:
    """Tabulate the reflectance of surfaces."""
    return {"surfaces": [surface_record(index) for index in INDICES]}


def surface_record(index: float) -> dict[str, float]:
    """Return the reflectance at normal incidence (9.3), for diffuse light (10.9), and for diffuse light from inside."""
    return {
        "index": index,
        "perpendicular": float(surface.fresnel_reflectance(index)),
        "diffuse": float(surface.diffuse_reflectance(index)),
        "internal": float(surface.internal_reflectance(index)),
    }
