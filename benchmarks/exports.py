"""Differences between exported programs and Python in wide gamuts, for docs/stability.md."""

import numpy as np

import uplift
from benchmarks import MACBETH, Row, record
from benchmarks.performance import CHECKED, MODES, run_header
from uplift.common.arrays import Array
from uplift.lookup import Cube

DIM, VISIBLE = 12, 1e-3
SPACES = ("sRGB", "Display P3", "ITU-R BT.2020", "ACEScg", "ProPhoto RGB", "ACES2065-1")
KINDS = ((9, 9, None), (3, 3, None), (9, 13, MACBETH))
"""Coefficients of nodes and of entries, and the atlas."""


def main() -> None:
    """Measure and store."""
    rows: list[Row] = []
    for space in SPACES:
        for count, entry_count, atlas in KINDS:
            cube = uplift.build(atlas, space=space, dim=DIM, coefficients=count, entry_coefficients=entry_count)
            rgb = realisable(cube)
            rows += [
                {"space": space, "coefficients": count, "entries": entry_count if atlas else None, "mode": mode}
                | difference(cube, mode, rgb)
                for mode in MODES
            ]
    record("exports", dim=DIM, colours=CHECKED, visible=VISIBLE, rows=rows)


def realisable(cube: Cube) -> Array:
    """Return random colours (CHECKED, 3), float32, farther inside the solid than the threshold."""
    rgb = np.random.default_rng(0).uniform(0, 1, (4 * CHECKED, 3)).astype(np.float32)
    return rgb[cube.data.solid.signed_distance(rgb.astype(float)) < -cube.data.threshold][:CHECKED]


def difference(cube: Cube, mode: str, rgb: Array) -> Row:
    """Return the largest and mean difference of reflectances of each colour, and the share of visible ones."""
    found, _ = run_header(cube, mode, rgb, 0)
    error = np.abs(found - cube.reflectance(rgb.astype(float), mode=mode)).max(axis=1)
    return {"largest": error.max(), "mean": error.mean(), "visible": (error > VISIBLE).mean()}
