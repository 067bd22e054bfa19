"""Use of a cube after reading: query it in every mode, summarise it, write it, and read it again."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from uplift.colorimetry.observer import light
from uplift.common.errors import UpliftError
from uplift.lookup import MODES, load, query
from uplift.report.summary import summarise

RGB = np.array([[0.2, 0.3, 0.4], [0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5], [0.9, 0.0, 0.1]])
LIGHT = light("FL11")
WAVELENGTHS = np.array([300.0, 380.0, 555.5, 780.0, 1000.0])


def use_cube(path: Path) -> None:
    """Use the cube at ``path``. Raises `UpliftError` for invalid files, ValueError for invalid answers."""
    cube = load(path)
    for mode in MODES:
        reflectance = cube.reflectance(RGB, WAVELENGTHS, mode)
        if not ((reflectance >= 0) & (reflectance <= 1)).all():
            raise ValueError(f"{mode}: reflectances outside [0, 1]")
    standard_error = cube.standard_error(RGB)
    if standard_error is not None and not np.isfinite(standard_error).all():
        raise ValueError("standard errors that are not finite")
    if cube.data.atlas.left_out is not None:
        errors = cube.standard_error(RGB, LIGHT)
        if errors is not None and not np.isfinite(errors).all():
            raise ValueError("standard errors under a light that are not finite")
    if not all(np.isfinite(result.round_trip).all() for result in query(cube, RGB)):
        raise ValueError("round trips that are not finite")
    json.dumps(summarise(cube.data), allow_nan=False)
    copy = path.with_suffix(".copy")
    try:
        cube.save(copy, force=True)
        load(copy)
    except UpliftError as error:
        raise ValueError("the written cube cannot be read") from error
    finally:
        copy.unlink(missing_ok=True)
