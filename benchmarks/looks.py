"""Bounds of the ColorChecker under other lights, and cubes with looks, for
docs/looks.md and its pictures.
"""

import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, MACBETH, Row, mitsuba_scenes
from benchmarks.browser import SETTLE, SHIFT, browser
from benchmarks.checker import photo
from benchmarks.materials import LARGE, SPLITS, other_halves
from uplift.atlas import read_atlas
from uplift.colorimetry import Light, delta_e_rgb, lab
from uplift.colorimetry.likely_errors import mahalanobis
from uplift.colorimetry.observer import display_sensors, light, sensor
from uplift.common.arrays import Array
from uplift.extras.looks.lab_errors import lab_errors
from uplift.extras.looks.metamer_bounds import Bounds, bounds
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.pages.plots import plot_bounds
from uplift.extras.report.look_page import page
from uplift.lab.runner import spectra_of
from uplift.lab.timing import time_call
from uplift.lookup import Cube
from uplift.samples import sample_path

LIGHTS = ("A", "FL11", "HP1", "LED-RGB1")
LIKELY_LIGHTS = ("FL11", "A", "HP1")
"""Lights of the share of held-out materials."""
DRAWN = ((0x8A, 0x2A, 0x20), (0x5F, 0x7F, 0x9F))
"""Encoded colours of the pictures, between entries."""
MANY = 1000
"""Colours that are timed."""
RUNS = 3
WINDOW = (1440, 1400)
SCALE = 0.85
CHOICE = (("ArrowLeft", 6), ("ArrowDown", 2))
"""Keys that are pressed for the screenshot, with Shift, and how often: 30 less a*, 10
less b* under FL11.
"""
LOOKS_ATLAS = "macbeth"
DIM = 32
PIXELS = 220
"""Pixels along each side of the picture of a ball."""
SPP = 256


# --- bounds ---


@cache
def stored_cube() -> Cube:
    """Read the cube whose answers have bounds."""
    return uplift.load(CUBES / "moments-16-macbeth.uplift")


@cache
def patches() -> tuple[tuple[str, ...], Array]:
    """Return the names of the patches, and their linear RGB (24, 3)."""
    atlas = read_atlas(MACBETH)
    srgb = stored_cube().data.sensor
    return atlas.names, srgb.rgb(spectra_of(atlas, srgb))


def search(colours: Array, lamp: Light, divisions: int = 3) -> Bounds:
    """Search the bounds of linear RGB (n, 3) under a light."""
    return bounds(stored_cube(), colours, lamp, divisions=divisions)


def patch_bounds() -> Iterator[Row]:
    """Yield the largest ΔE00 and the share of all object colours of each patch."""
    names, rgb = patches()
    for lamp in map(light, LIGHTS):
        found = search(rgb, lamp)
        columns = names, found.largest.delta_e_2000, found.share
        for name, largest, share in zip(*columns, strict=True):
            about = {"name": name, "light": lamp.name}
            yield {**about, "largest": largest, "share": share}


def denser_search() -> Iterator[Row]:
    """Yield the cost of many colours, and how much more a search from 16 times as many
    directions finds.
    """
    _, rgb = patches()
    many = np.random.default_rng(1).uniform(size=(MANY, 3))
    for lamp in map(light, LIGHTS):
        coarse = search(rgb, lamp)
        fine = search(rgb, lamp, divisions=4)
        more = fine.largest.delta_e_2000 - coarse.largest.delta_e_2000
        timing = time_call(lambda lamp=lamp: bounds(stored_cube(), many, lamp), RUNS)
        yield {
            "light": lamp.name,
            "seconds": timing.cpu,
            "missed": {"mean": np.maximum(more, 0).mean(), "max": more.max()},
            "volume": (coarse.volumes.volume / fine.volumes.volume).mean(),
        }


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
                inside.append(distance <= errors.likely_radius)
            all_inside = np.concatenate(inside)
            yield {
                "atlas": name,
                "light": lamp.name,
                "materials": len(all_inside) // SPLITS,
                "inside": all_inside.mean(),
            }


def regions() -> None:
    """Draw the regions of two colours."""
    colours = stored_cube().decode(DRAWN)
    drawn = [search(colours, light(name)) for name in LIGHTS[:3]]
    plot_bounds(stored_cube(), [drawn], DOCS / "looks" / "regions.png", force=True)


def screenshot() -> None:
    """Choose a colour on the page of looks and take a screenshot."""
    colours = stored_cube().decode(DRAWN[:1])
    drawn = [search(colours, light(name)) for name in LIGHTS]
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


# --- cubes with looks ---


@cache
def look_cubes() -> tuple[Cube, Cube]:
    """Build a cube without looks and one with those of ``uplift samples``."""
    with_looks = uplift.build(LOOKS_ATLAS, dim=DIM, looks=sample_path("looks.toml"))
    return uplift.build(LOOKS_ATLAS, dim=DIM), with_looks


def looks() -> Iterator[Row]:
    """Yield how far cubes are from each look under each of its lights."""
    plain, looked = look_cubes()
    for look in looked.data.provenance["looks"]:
        for goal in look["lights"]:
            (screen,) = display_sensors([goal["light"]], plain.observer)
            wish = np.array(goal["wish"])
            before, after = (
                screen.rgb(cube.reflectance(look["rgb"])) for cube in (plain, looked)
            )
            yield {
                "look": look["name"],
                "light": goal["light"],
                "without": delta_e_rgb(screen, before, wish),
                "with_look": delta_e_rgb(screen, after, wish),
            }


def scene() -> list[Row]:
    """Render balls of one RGB and two cubes under daylight and the light of a look;
    return how far they differ.
    """
    mitsuba_scenes.start_mitsuba()
    (look, *_) = look_cubes()[1].data.provenance["looks"]
    middle = slice(PIXELS // 2 - 12, PIXELS // 2 + 12)
    rows = []
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(folder, f"{stem}.uplift")) for stem in ("plain", "looks")]
        for cube, path in zip(look_cubes(), paths, strict=True):
            cube.save(path)
        for lamp in ("D65", look["lights"][0]["light"]):
            here = sensor(illuminant=lamp)
            described = balls(paths, look["rgb"], lamp)
            image = mitsuba_scenes.render(described, SPP) @ here.xyz_to_rgb.T
            left, right = (
                half[middle, middle].mean(axis=(0, 1))
                for half in np.split(image, 2, axis=1)
            )
            delta_e = delta_e_rgb(here, left, right)
            rows.append({"look": look["name"], "light": lamp, "delta_e": delta_e})
            panels.append(Panel([photo(image)], y=Axis(lamp)))
    path = DOCS / "look-cubes" / "two-cubes.png"
    write_figure(draw(panels, 1, 4.5), path, force=True)
    return rows


def balls(cubes: Sequence[str], rgb: Sequence[float], lamp: str) -> Row:
    """Describe two balls on the ground, left and right."""
    import mitsuba as mi

    transform = mi.ScalarTransform4f

    def ball(cube: str, x: float) -> Row:
        paint = {"type": "uplift", "cube": cube, "rgb": list(rgb)}
        bsdf = mitsuba_scenes.diffuse(paint)
        return {"type": "sphere", "center": [x, 1, 0], "radius": 1.0, "bsdf": bsdf}

    ground = transform().rotate([1, 0, 0], -90).scale([30, 30, 1])
    view = transform().look_at(origin=[0, 1.2, 12], target=[0, 0.55, 0], up=[0, 1, 0])
    return {
        "integrator": {"type": "path", "max_depth": 4},
        "sky": mitsuba_scenes.sky(lamp),
        "ground": {
            "type": "rectangle",
            "to_world": ground,
            "bsdf": mitsuba_scenes.diffuse({"type": "uniform", "value": 0.5}),
        },
        "left": ball(cubes[0], -1.35),
        "right": ball(cubes[1], 1.35),
        "camera": {
            "type": "perspective",
            "fov": 28,
            "fov_axis": "x",
            "to_world": view,
            "film": mitsuba_scenes.film(2 * PIXELS, PIXELS),
        },
    }


QUESTIONS = {
    "bounds": patch_bounds,
    "denser_search": denser_search,
    "likely": likely,
    "regions": regions,
    "screenshot": screenshot,
    "looks": looks,
    "scene": scene,
}
