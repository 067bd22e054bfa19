"""What becomes of a cube that was read: it is asked in every mode, described, and written again."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from uplift.common.errors import UpliftError
from uplift.lookup import MODES, load, query
from uplift.report.summary import summary

RGB = np.array([[0.2, 0.3, 0.4], [0, 0, 0], [1, 1, 1], [0.5, 0.5, 0.5], [0.9, 0.0, 0.1]])
AT = np.array([300.0, 380.0, 555.5, 780.0, 1000.0])


def use(path: Path) -> None:
    """Raises `UpliftError` for what is no cube, ValueError for answers that no cube may give."""
    cube = load(path)
    for mode in MODES:
        found = cube.reflectance(RGB, AT, mode)
        if not ((found >= 0) & (found <= 1)).all():
            raise ValueError(f"{mode}: reflectances outside [0, 1]")
    expected = cube.standard_error(RGB)
    if expected is not None and not np.isfinite(expected).all():
        raise ValueError("standard errors without end")
    if not all(np.isfinite(answer.round_trip).all() for answer in query(cube, RGB)):
        raise ValueError("round trips without end")
    json.dumps(summary(cube.data), allow_nan=False)
    again = path.with_suffix(".again")
    try:
        cube.save(again, force=True)
        load(again)
    except UpliftError as error:
        raise ValueError("written, it cannot be read again") from error
    finally:
        again.unlink(missing_ok=True)
