"""Bounds of the ColorChecker under other lights, and cubes with looks, for
docs/looks.md and its pictures.

Largest ΔE00 and share of each colour, the cost of many colours, how much more a search
from 16 times as many directions finds, the share of held-out materials in the likely
region, and a screenshot of the page. Cubes with looks, and a scene of two cubes.
"""

import tempfile
from collections.abc import Iterator, Sequence
from itertools import chain, starmap
from pathlib import Path

import numpy as np

import uplift
from benchmarks import CUBES, DOCS, MACBETH, Row, mitsuba_scenes, record
from benchmarks.browser import SETTLE, SHIFT, browser
from benchmarks.checker import photo
from benchmarks.materials import LARGE, SPLITS, other_halves
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import delta_e_rgb, lab
from uplift.colorimetry.likely_errors import mahalanobis
from uplift.colorimetry.observer import display_sensors, light, sensor
from uplift.common.arrays import Array
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.looks.lab_errors import lab_errors
from uplift.extras.looks.metamer_bounds import Bounds, bounds
from uplift.extras.pages.figure import write_figure
from uplift.extras.pages.panels import Axis, Panel, draw
from uplift.extras.pages.plots import plot_bounds
from uplift.extras.report.look_page import page
from uplift.lab.timing import time_calls
from uplift.lookup import Cube, load
from uplift.samples import sample_path

CUBE = CUBES / "moments-16-macbeth.uplift"
LIGHTS = ("A", "FL11", "HP1", "LED-RGB1")
PICTURE = DOCS / "looks" / "regions.png"
DRAWN = ((0x8A, 0x2A, 0x20), (0x5F, 0x7F, 0x9F))
"""Encoded colours of the picture, between entries."""
MANY = 1000
"""Colours that are timed."""
RUNS = 3
LIKELY_LIGHTS = ("FL11", "A", "HP1")
"""Lights of the share of held-out materials."""
SCREENSHOT = DOCS / "looks" / "page.jpg"
WINDOW = (1440, 1400)
SCALE = 0.85
CHOICE = (("region-1", "ArrowLeft", 6), ("region-1", "ArrowDown", 2))
"""Keys that are pressed for the screenshot, with Shift, and how often: 30 less a*, 10
less b* under FL11.
"""
LOOKS_ATLAS = "macbeth"
DIM = 32
IMPOSSIBLE = (
    ("#4060a0", "A", "#5060a0"),
    ("#8a2a20", "A", "#8a4020"),
    ("#40a060", "A", "#50a050"),
)
TWO_CUBES = DOCS / "look-cubes" / "two-cubes.png"
PIXELS = 220
"""Pixels along each side of the picture of a ball."""
SPP = 256


def main() -> None:
    """Measure and store."""
    cube = load(CUBE)
    atlas = read_atlas(MACBETH)
    srgb = cube.data.sensor
    rgb = srgb.rgb(resample(atlas, srgb.wavelengths).values)
    drawn = srgb.decode(DRAWN)
    lights = [light(name, srgb.observer, *srgb.range) for name in LIGHTS]

    def search(colours: Array) -> list[Bounds]:
        return [bounds(cube, colours, lamp, divisions=3) for lamp in lights]

    by_light = dict(zip(LIGHTS, search(rgb), strict=True))
    plot_bounds(cube, [search(drawn)[:3]], PICTURE, force=True)
    screenshot(cube, search(drawn[:1]))
    colours = []
    for row, name in enumerate(atlas.names):
        largest = {key: b.largest.delta_e_2000[row] for key, b in by_light.items()}
        share = {key: b.share[row] for key, b in by_light.items()}
        colours.append({"name": name, "largest": largest, "share": share})
    record(
        "looks",
        lights=LIGHTS,
        colours=colours,
        methods=[method(cube, rgb, coarse) for coarse in by_light.values()],
        many=MANY,
        runs=RUNS,
        likely=chain.from_iterable(map(likely, LARGE)),
        splits=SPLITS,
    )
    look_cubes()


def method(cube: Cube, rgb: Array, coarse: Bounds) -> Row:
    """Return the cost and the errors of the search under a light."""
    fine = bounds(cube, rgb, coarse.light, divisions=4)
    more = fine.largest.delta_e_2000 - coarse.largest.delta_e_2000
    many = np.random.default_rng(1).uniform(size=(MANY, 3))
    _, times = time_calls(lambda: bounds(cube, many, coarse.light), RUNS)
    return {
        "light": coarse.light.name,
        "seconds": times,
        "missed": {"mean": np.maximum(more, 0).mean(), "largest": more.max()},
        "volume": (coarse.volumes.volume / fine.volumes.volume).mean(),
    }


def likely(name: str) -> Iterator[Row]:
    """Yield the share of held-out materials in the likely region, by light."""
    pairs = other_halves(name, dim=32, coefficients=9)
    for lamp in map(light, LIKELY_LIGHTS):
        distances = []
        radii = []
        for cube, queried in pairs:
            errors = lab_errors(cube.data, lamp)
            measured, answered = (
                lab(spectra @ lamp.xyz.T, lamp.white)[:, 1:]
                for spectra in (queried.measured, cube.reflectance(queried.rgb))
            )
            covariance = errors.covariance(queried.rgb)[:, 1:, 1:]
            distances.append(mahalanobis(covariance, measured - answered))
            radii.append(np.full(len(measured), errors.likely_radius))
        distance = np.concatenate(distances)
        radius = np.concatenate(radii)
        yield {
            "atlas": name,
            "light": lamp.name,
            "materials": len(distance) // SPLITS,
            "inside": (distance <= radius).mean(),
            "radius": [radius.min(), radius.max()],
        }


def screenshot(cube: Cube, drawn: list[Bounds]) -> None:
    """Choose a colour on the page and take a screenshot."""
    with tempfile.TemporaryDirectory() as folder, browser() as tab:
        path = Path(folder) / "page.html"
        path.write_text(page(cube, drawn), encoding="utf-8")
        tab.window(*WINDOW)
        tab.open(path)
        for region, key, times in CHOICE:
            tab.evaluate(f"document.getElementById('{region}').focus()")
            for _ in range(times):
                tab.key(key, SHIFT)
        tab.evaluate(f"document.activeElement.blur(), {SETTLE}")
        SCREENSHOT.write_bytes(tab.screenshot(scale=SCALE))


def look_cubes() -> None:
    """Measure cubes with looks, draw a scene of two cubes, and store both."""
    plain = uplift.build(LOOKS_ATLAS, dim=DIM)
    looked = uplift.build(LOOKS_ATLAS, dim=DIM, looks=sample_path("looks.toml"))
    record(
        "looks",
        "look-cubes",
        atlas=LOOKS_ATLAS,
        dim=DIM,
        looks=looks(plain, looked),
        entries=len(plain.data.atlas.rgb),
        impossible=starmap(impossible, IMPOSSIBLE),
        scene=render(plain, looked),
    )


def looks(plain: Cube, looked: Cube) -> Iterator[Row]:
    """Yield wish, answer and distances of each look under each of its lights."""
    for look in looked.data.provenance["looks"]:
        for goal in look["lights"]:
            (screen,) = display_sensors([goal["light"]], plain.observer)
            wish = np.array(goal["wish"])
            before, after = (
                screen.rgb(cube.reflectance(look["rgb"])) for cube in (plain, looked)
            )
            codes = hex_codes(np.array([look["rgb"], wish, before]))
            yield {
                "look": look["name"],
                "light": goal["light"],
                "colour": codes[0],
                "wish": codes[1],
                "before": codes[2],
                "without": delta_e_rgb(screen, before, wish),
                "with_look": delta_e_rgb(screen, after, wish),
            }


def impossible(rgb: str, light: str, wish: str) -> Row:
    """Return an impossible wish with the nearest colour."""
    cube = uplift.build(dim=2, looks=uplift.Look(rgb, {light: wish}))
    (nearest,) = cube.data.provenance["looks"][0]["lights"]
    answer = hex_codes(np.array([nearest["answer"]]))[0]
    return {**nearest, "colour": rgb, "wish": wish, "answer": answer}


def render(plain: Cube, looked: Cube) -> Row:
    """Render balls of one RGB and two cubes under daylight and the light of a look."""
    version = mitsuba_scenes.start_mitsuba()
    look = looked.data.provenance["looks"][0]
    lamps = ("D65", look["lights"][0]["light"])
    lights = {}
    panels = []
    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(folder, f"{stem}.uplift")) for stem in ("plain", "looks")]
        for cube, path in zip((plain, looked), paths, strict=True):
            cube.save(path)
        for lamp in lamps:
            here = sensor(illuminant=lamp)
            scene = balls(paths, look["rgb"], lamp)
            image = mitsuba_scenes.render(scene, SPP) @ here.xyz_to_rgb.T
            middle = slice(PIXELS // 2 - 12, PIXELS // 2 + 12)
            patches = [
                half[middle, middle].mean(axis=(0, 1))
                for half in np.split(image, 2, axis=1)
            ]
            lights[lamp] = {"delta_e": delta_e_rgb(here, *patches)}
            panels.append(Panel([photo(image)], y=Axis(lamp)))
    write_figure(draw(panels, 1, 4.5), TWO_CUBES, force=True)
    return {"mitsuba": version, "look": look["name"], "lights": lights}


def balls(cubes: Sequence[str], rgb: Sequence[float], lamp: str) -> Row:
    """Describe two balls on the ground, left and right."""
    import mitsuba as mi

    transform = mi.ScalarTransform4f

    def ball(cube: str, x: float) -> Row:
        paint = {"type": "uplift", "cube": cube, "rgb": list(rgb)}
        bsdf = mitsuba_scenes.diffuse(paint)
        return {"type": "sphere", "center": [x, 1, 0], "radius": 1.0, "bsdf": bsdf}

    view = transform().look_at(origin=[0, 1.2, 12], target=[0, 0.55, 0], up=[0, 1, 0])
    return {
        "integrator": {"type": "path", "max_depth": 4},
        "sky": mitsuba_scenes.sky(lamp),
        "ground": {
            "type": "rectangle",
            "to_world": transform().rotate([1, 0, 0], -90).scale([30, 30, 1]),
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
