"""Cubes with looks, and a scene of two cubes, for docs/looks.md and its picture."""

import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks import DOCS, Row, record
from benchmarks.checker import constant_light, start_mitsuba, xyz_film
from uplift.colorimetry import delta_e_rgb
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import display_sensors, sensor
from uplift.colorimetry.srgb import hex_codes, to_display_codes
from uplift.common.arrays import Array
from uplift.lookup import Cube
from uplift.samples import sample_path
from uplift.viz.figure import figure_text, new_figure, show_image, write_png

ATLAS, DIM = "macbeth", 32
IMPOSSIBLE = (("#4060a0", "A", "#5060a0"), ("#8a2a20", "A", "#8a4020"), ("#40a060", "A", "#50a050"))
PIXELS, SPP = 220, 256


def main() -> None:
    """Measure, draw and store."""
    plain = uplift.build(ATLAS, dim=DIM)
    looked = uplift.build(ATLAS, dim=DIM, looks=sample_path("looks.toml"))
    record(
        "look-cubes",
        atlas=ATLAS,
        dim=DIM,
        looks=list(looks(plain, looked)),
        entries=len(plain.data.atlas.rgb),
        impossible=[impossible(*each) for each in IMPOSSIBLE],
        scene=render(plain, looked),
    )


def looks(plain: Cube, looked: Cube) -> Iterator[Row]:
    """Yield wish, answer and distances of each look under each of its lights."""
    for look in looked.data.provenance["looks"]:
        for each in look["lights"]:
            (screen,) = display_sensors([each["light"]], plain.observer)
            wish = np.array(each["wish"])
            before, after = (screen.rgb(cube.reflectance(look["rgb"])) for cube in (plain, looked))
            codes = dict(
                zip(("colour", "wish", "before"), hex_codes(np.array([look["rgb"], wish, before])), strict=True)
            )
            distances = {"without": delta_e_rgb(screen, before, wish), "with_look": delta_e_rgb(screen, after, wish)}
            yield {"look": look["name"], "light": each["light"], **codes, **distances}


def impossible(rgb: str, light: str, wish: str) -> Row:
    """Return an impossible wish with the nearest colour."""
    cube = uplift.build(dim=2, looks=uplift.Look(rgb, {light: wish}))
    (found,) = cube.data.provenance["looks"][0]["lights"]
    answer = hex_codes(np.array([found["answer"]]))[0]
    return {**found, "colour": rgb, "wish": wish, "answer": answer}


def render(plain: Cube, looked: Cube) -> Row:
    """Render two balls of one RGB, of two cubes, under daylight and under the light of a look, and draw them."""
    version, look = start_mitsuba(), looked.data.provenance["looks"][0]
    lamps, found = ("D65", look["lights"][0]["light"]), {}
    figure = new_figure(4.5, 4.3)
    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(folder, f"{stem}.uplift")) for stem in ("plain", "looks")]
        for cube, path in zip((plain, looked), paths, strict=True):
            cube.save(path)
        for axes, lamp in zip(figure.subplots(2, 1), lamps, strict=True):
            here = sensor(illuminant=lamp)
            image = balls(paths, look["rgb"], lamp) @ here.xyz_to_rgb.T
            middle = slice(PIXELS // 2 - 12, PIXELS // 2 + 12)
            patches = [half[middle, middle].mean(axis=(0, 1)) for half in np.split(image, 2, axis=1)]
            found[lamp] = {"delta_e": delta_e_rgb(here, *patches)}
            show_image(axes, to_display_codes(image, SRGB).astype(np.uint8), interpolation="nearest")
            axes.set_ylabel(figure_text(lamp), fontsize=11)
    write_png(figure, DOCS / "look-cubes" / "two-cubes.png", force=True)
    return {"mitsuba": version, "look": look["name"], "lights": found}


def balls(cubes: Sequence[str], rgb: Sequence[float], lamp: str) -> Array:
    """Return XYZ (height, width, 3) of two balls on the ground, left and right, each of its cube."""
    import mitsuba as mi

    transform = mi.ScalarTransform4f

    def diffuse(**reflectance: Any) -> Row:
        return {"type": "diffuse", "reflectance": reflectance}

    def ball(cube: str, x: float) -> Row:
        paint = diffuse(type="uplift", cube=cube, rgb=list(rgb))
        return {"type": "sphere", "center": [x, 1, 0], "radius": 1.0, "bsdf": paint}

    ground = transform().rotate([1, 0, 0], -90).scale([30, 30, 1])
    view = transform().look_at(origin=[0, 1.2, 12], target=[0, 0.55, 0], up=[0, 1, 0])
    film = xyz_film(2 * PIXELS, PIXELS)
    scene = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 4},
        "sky": constant_light(lamp),
        "ground": {"type": "rectangle", "to_world": ground, "bsdf": diffuse(type="uniform", value=0.5)},
        "left": ball(cubes[0], -1.35),
        "right": ball(cubes[1], 1.35),
        "camera": {"type": "perspective", "fov": 28, "fov_axis": "x", "to_world": view, "film": film},
    }
    return np.array(mi.render(mi.load_dict(scene), spp=SPP, seed=0), dtype=float)
