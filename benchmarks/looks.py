"""Regions of colours under other lights, and cubes with looks, for docs/looks.md and
its pictures.
"""

import tempfile
from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, Row
from benchmarks.browser import SETTLE, SHIFT, browser
from benchmarks.materials import LARGE, SPLITS, other_halves
from uplift.colorimetry.delta_e import delta_e_rgb, lab
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import display_sensors, light
from uplift.extras.colour.srgb import to_display_codes
from uplift.extras.looks.lab_errors import lab_errors, mahalanobis
from uplift.extras.looks.metamer_bounds import bounds
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.marks import patches
from uplift.extras.pages.panels import Panel, draw
from uplift.extras.pages.plots import plot_bounds
from uplift.extras.report.look_page import page
from uplift.lookup.cube import Cube
from uplift.samples import sample_path

LIGHTS = ("A", "FL11", "HP1", "LED-RGB1")
LIKELY_LIGHTS = ("FL11", "A", "HP1")
"""Lights of the share of held-out materials."""
DRAWN = ((0x8A, 0x2A, 0x20), (0x5F, 0x7F, 0x9F))
"""Encoded colours of the pictures, between entries."""
WINDOW = (1440, 1400)
SCALE = 0.85
CHOICE = (("ArrowLeft", 6), ("ArrowDown", 2))
"""Keys that are pressed for the screenshot, with Shift, and how often: 30 less a*, 10
less b* under FL11.
"""
DIM = 32
DAYLIGHT = "D65"
COLUMNS = 3
"""Lights of a look in the picture, with daylight."""
search = partial(bounds, divisions=3)
"""As ``uplift lab bounds`` for one colour."""


@cache
def stored_cube() -> Cube:
    """Read the cube whose answers have bounds."""
    return uplift.load(CUBES / "moments-16-macbeth.uplift")


def likely() -> Iterator[Row]:
    """Yield the share of held-out materials in the likely region."""
    for name in LARGE:
        pairs = list(other_halves(name, dim=DIM, coefficients=9))
        for lamp in map(light, LIKELY_LIGHTS):
            inside = []
            for cube, task in pairs:
                errors = lab_errors(cube.data, lamp)
                answers = cube.reflectance(task.rgb)
                measured, answered = (
                    lab(spectra @ lamp.xyz.T, lamp.white)[:, 1:]
                    for spectra in (task.queried, answers)
                )
                covariance = errors.covariance(task.rgb)[:, 1:, 1:]
                distance = mahalanobis(covariance, measured - answered)
                inside.extend(distance <= errors.likely_radius)
            about = {"atlas": name, "light": lamp.name}
            yield {
                **about,
                "materials": len(inside) // SPLITS,
                "inside": np.mean(inside),
            }


def regions() -> None:
    """Draw the regions of two colours."""
    colours = stored_cube().decode(DRAWN)
    drawn = [search(stored_cube(), colours, light(name)) for name in LIGHTS[:3]]
    plot_bounds(stored_cube(), [drawn], DOCS / "looks" / "regions.png", force=True)


def screenshot() -> None:
    """Choose a colour on the page of looks and take a screenshot."""
    colours = stored_cube().decode(DRAWN[:1])
    drawn = [search(stored_cube(), colours, light(name)) for name in LIGHTS]
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        path = Path(folder) / "page.html"
        path.write_text(page(stored_cube(), drawn), encoding="utf-8")
        tab.window(*WINDOW)
        tab.open(path)
        tab.evaluate("document.getElementById('region-1').focus()")
        for key, times in CHOICE:
            for _ in range(times):
                tab.key(key, SHIFT)
        tab.evaluate(f"document.activeElement.blur(), {SETTLE}")
        (DOCS / "looks" / "page.jpg").write_bytes(tab.screenshot(scale=SCALE))


def looks() -> Iterator[Row]:
    """Yield how far a cube without looks and one with those of ``uplift samples`` are
    from each look under each of its lights; draw the colours of both.
    """
    plain = uplift.build("macbeth", dim=DIM)
    looked = uplift.build("macbeth", dim=DIM, looks=sample_path("looks.toml"))
    panels: list[Panel | None] = []
    for look in looked.data.provenance["looks"]:
        wishes = {goal["light"]: np.array(goal["wish"]) for goal in look["lights"]}
        lights = (DAYLIGHT, *wishes)
        spectra = np.stack([cube.reflectance(look["rgb"]) for cube in (plain, looked)])
        for lamp, screen in zip(
            lights, display_sensors(lights, plain.observer), strict=True
        ):
            rgb = screen.rgb(spectra)
            codes = to_display_codes(rgb[None], SRGB) / 255
            panels.append(Panel([patches(codes)], f"{look['name']} under {lamp}"))
            if lamp in wishes:
                without, with_look = delta_e_rgb(screen, rgb, wishes[lamp])
                about = {"look": look["name"], "light": lamp}
                yield {**about, "without": without, "with_look": with_look}
        panels.extend([None] * (COLUMNS - len(lights)))
    figure = draw(panels, COLUMNS, (1.7, 0.8))
    write_figure(figure, DOCS / "looks" / "two-cubes.png", force=True)


QUESTIONS = {
    "likely": likely,
    "regions": regions,
    "screenshot": screenshot,
    "looks": looks,
}
