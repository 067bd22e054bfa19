"""Bounds of the ColorChecker under other lights, for docs/looks.md and its pictures.

Largest ΔE00 and share of each colour, the cost of many colours, how much more a search from 16 times as many directions
finds, the share of held-out materials in the likely region, and a screenshot of the page.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import CUBES, DOCS, MACBETH, record
from benchmarks.browser import SETTLE, SHIFT, browser
from benchmarks.materials import LARGE, SPLITS, other_halves
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import lab
from uplift.colorimetry.expected_error import mahalanobis
from uplift.colorimetry.observer import light
from uplift.common.arrays import Array
from uplift.lab.timing import time_calls
from uplift.lookup import Cube, load
from uplift.lookup.light_errors import NORMAL_RADIUS, lab_errors
from uplift.lookup.metamer_bounds import Bounds, bounds
from uplift.report.look_page import page
from uplift.viz.plots import plot_bounds

ATLAS = MACBETH
CUBE = CUBES / "moments-16-macbeth.uplift"
LIGHTS = ("A", "FL11", "HP1", "LED-RGB1")
PICTURE = DOCS / "looks" / "regions.png"
DRAWN, DRAWN_LIGHTS = ((0x8A, 0x2A, 0x20), (0x5F, 0x7F, 0x9F)), 3
"""Encoded colours of the picture, between entries, and the number of lights."""
PAGE_DIVISIONS, FINE_DIVISIONS = 3, 4
MANY, RUNS = 1000, 3
"""Colours that are timed."""
LIKELY_LIGHTS, COEFFICIENTS = ("FL11", "A", "HP1"), 9
"""Lights of the share of held-out materials, and coefficients of the cubes that do not know them."""
SCREENSHOT, WINDOW, SCALE = DOCS / "looks" / "page.jpg", (1440, 1400), 0.85
CHOICE = (("region-1", "ArrowLeft", 6), ("region-1", "ArrowDown", 2))
"""Keys that are pressed for the screenshot, with Shift, and how often: 30 less a*, 10 less b* under FL11."""


def main() -> None:
    """Measure and store."""
    cube, atlas = load(CUBE), read_atlas(ATLAS)
    sensor = cube.data.sensor
    rgb, drawn = sensor.rgb(resample(atlas, sensor.wavelengths).values), sensor.decode(DRAWN)
    lights = [light(name, sensor.observer, *sensor.range) for name in LIGHTS]

    def search(colours: Array) -> list[Bounds]:
        return [bounds(cube, colours, each, divisions=PAGE_DIVISIONS) for each in lights]

    found = search(rgb)
    plot_bounds(cube, [search(drawn)[:DRAWN_LIGHTS]], PICTURE, force=True)
    screenshot(cube, search(drawn[:1]))
    record(
        "looks",
        lights=LIGHTS,
        colours=[
            {
                "name": name,
                "largest": {each.light.name: each.largest.delta_e_2000[row] for each in found},
                "share": {each.light.name: each.share[row] for each in found},
            }
            for row, name in enumerate(atlas.names)
        ],
        methods=[method(cube, rgb, each) for each in found],
        many=MANY,
        runs=RUNS,
        likely=[row for name in LARGE for row in likely(name)],
        splits=SPLITS,
    )


def method(cube: Cube, rgb: Array, found: Bounds) -> dict[str, Any]:
    """Return the cost and the errors of the search under a light."""
    fine = bounds(cube, rgb, found.light, divisions=FINE_DIVISIONS)
    more = fine.largest.delta_e_2000 - found.largest.delta_e_2000
    many = np.random.default_rng(1).uniform(size=(MANY, 3))
    _, times = time_calls(lambda: bounds(cube, many, found.light), RUNS)
    return {
        "light": found.light.name,
        "seconds": times,
        "missed": {"mean": np.maximum(more, 0).mean(), "largest": more.max()},
        "volume": (found.volumes.volume / fine.volumes.volume).mean(),
    }


def likely(name: str) -> Iterator[dict[str, Any]]:
    """Yield the shares of held-out materials in the likely region and in that of normal errors, by light."""
    pairs = other_halves(name, dim=32, coefficients=COEFFICIENTS)
    for each in map(light, LIKELY_LIGHTS):
        distances, radii = [], []
        for cube, some in pairs:
            errors = lab_errors(cube.data, each)
            measured, answered = (
                lab(spectra @ each.xyz.T, each.white)[:, 1:] for spectra in (some.measured, cube.reflectance(some.rgb))
            )
            distances.append(mahalanobis(errors.covariance(some.rgb)[:, 1:, 1:], measured - answered))
            radii.append(np.full(len(measured), errors.likely_radius))
        distance, radius = np.concatenate(distances), np.concatenate(radii)
        yield {
            "atlas": name,
            "light": each.name,
            "materials": len(distance) // SPLITS,
            "inside": (distance <= radius).mean(),
            "normal": (distance <= NORMAL_RADIUS).mean(),
            "radius": [radius.min(), radius.max()],
        }


def screenshot(cube: Cube, found: list[Bounds]) -> None:
    """Choose a colour on the page and take a screenshot."""
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        path = Path(folder) / "page.html"
        path.write_text(page(cube, found), encoding="utf-8")
        tab.window(*WINDOW)
        tab.open(path)
        for region, key, times in CHOICE:
            tab.evaluate(f"document.getElementById('{region}').focus()")
            for _ in range(times):
                tab.key(key, SHIFT)
        tab.evaluate(f"document.activeElement.blur(), {SETTLE}")
        SCREENSHOT.write_bytes(tab.screenshot(scale=SCALE))
