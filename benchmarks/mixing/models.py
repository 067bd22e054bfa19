"""Criteria of mixing models, and reflectance of surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.design.mixing import layers, mixers
from uplift.design.mixing.criteria import CRITERIA, evaluate
from uplift.lookup import Cube

INDICES = (1.33, 1.48, 1.5, 1.66)
"""Water, light oil, glass and linseed oil, heavy oil."""


def criteria(cube: Cube) -> dict[str, Any]:
    """Evaluate every mixer by every criterion of section 10.4."""
    atlas = cube.data.atlas.rgb
    coloured = atlas[np.ptp(atlas, axis=1) > 0.1 * atlas.max(axis=1)]
    rows = []
    for mixer in mixers(cube):
        values = evaluate(mixer, cube.data.sensor, coloured)
        verdicts = [
            {"obeys": value <= criterion.limit, "value": value + 0.0}
            for criterion, value in zip(CRITERIA, values, strict=True)
        ]
        rows.append({"mixer": mixer.title, "verdicts": verdicts})
    titles = [{"title": one.title, "measure": one.measure, "limit": one.limit} for one in CRITERIA]
    return {"patches": len(coloured), "criteria_titles": titles, "criteria": rows}


def surfaces() -> dict[str, Any]:
    """Tabulate the reflectance of surfaces."""
    return {"surfaces": [surface_record(index) for index in INDICES]}


def surface_record(index: float) -> dict[str, float]:
    """Return the reflectance at normal incidence (9.3), for diffuse light (10.9), and for diffuse light from inside."""
    return {
        "index": index,
        "perpendicular": float(layers.fresnel_reflectance(index)),
        "diffuse": float(layers.diffuse_reflectance(index)),
        "internal": float(layers.internal_reflectance(index)),
    }
