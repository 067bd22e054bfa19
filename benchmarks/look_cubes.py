"""Cubes with looks, and textures and scenes of several cubes: ``make look-cubes``.

Writes docs/data/look-cubes.json and the picture of docs/look-cubes.
"""

from __future__ import annotations

import tempfile
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import uplift
from benchmarks.record import ROOT, write
from benchmarks.render import scene
from uplift.atlas import on_grid, read_atlas
from uplift.atlas.shipped import shipped_atlases
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import display_sensors, light, sensor
from uplift.colorimetry.srgb import hex_codes, to_display_codes
from uplift.common.arrays import Array
from uplift.fit.looks import MET, LookGoal, design_reflectance, fit_designs
from uplift.fit.problem import Problem
from uplift.io import texture
from uplift.io.texture.image import Window
from uplift.io.texture.writer import OutputPart, open_writer
from uplift.lookup import Cube
from uplift.models import Moments
from uplift.samples import sample_path
from uplift.viz.figure import figure_text, new_figure, write_png

ATLAS, DIM = "macbeth", 32
SETS = (("FL11",), ("A",), ("A", "FL11"), ("A", "FL11", "LED-B3"), ("A", "FL2", "FL11", "LED-B3"))
COUNTS = (17, 9)
MATERIALS = 60
IMPOSSIBLE = (("#4060a0", "A", "#5060a0"), ("#8a2a20", "A", "#8a4020"), ("#40a060", "A", "#50a050"))
SIDE, ROUNDS = 1024, 3
PIXELS, SPP = 220, 256
PICTURE = ROOT / "docs" / "look-cubes" / "two-cubes.png"


def main() -> None:
    """Measure, draw and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    path = sample_path("looks.toml")
    plain, seconds = timed(lambda: uplift.build(ATLAS, dim=DIM))
    plain, seconds = timed(lambda: uplift.build(ATLAS, dim=DIM))  # nothing is compiled the second time
    looked, with_looks = timed(lambda: uplift.build(ATLAS, dim=DIM, looks=path))
    write(
        "look-cubes",
        "make look-cubes",
        atlas=ATLAS,
        dim=DIM,
        build={"plain": seconds, "looks": with_looks},
        looks=looks(plain, looked),
        entries=entries(plain, looked),
        near=near(plain, looked),
        realisable=[realisable(names) for names in SETS],
        materials=MATERIALS,
        impossible=impossible(),
        masked=masked(plain, looked),
        scene=render(plain, looked),
    )


def timed(function: Any) -> tuple[Any, float]:
    """Return a result and the seconds that it took."""
    begin = time.perf_counter()
    return function(), time.perf_counter() - begin


def looks(plain: Cube, looked: Cube) -> list[dict[str, Any]]:
    """Return wish, answer and distances of each look under each of its lights."""
    rows = []
    for record in looked.data.provenance["looks"]:
        for each in record["lights"]:
            (screen,) = display_sensors([each["light"]], plain.observer)
            wish = np.array(each["wish"])
            before, after = (screen.rgb(cube.reflectance(record["rgb"])) for cube in (plain, looked))
            rows.append(
                {
                    "look": record["name"],
                    "colour": hex_codes(np.array([record["rgb"]]))[0],
                    "light": each["light"],
                    "wish": hex_codes(wish[None])[0],
                    "before": hex_codes(before[None])[0],
                    "without": delta_e_rgb(screen, before, wish),
                    "with_look": delta_e_rgb(screen, after, wish),
                    "by_day": delta_e_rgb(
                        looked.data.sensor,
                        looked.data.sensor.rgb(looked.reflectance(record["rgb"])),
                        record["rgb"],
                    ),
                }
            )
    return rows


def entries(plain: Cube, looked: Cube) -> dict[str, Any]:
    """Return the largest change of a reflectance at the colours of the measured entries."""
    rgb = plain.data.atlas.rgb
    return {
        "count": len(rgb),
        "change": {
            mode: np.abs(looked.reflectance(rgb, mode=mode) - plain.reflectance(rgb, mode=mode)).max()
            for mode in ("spectra", "refined", "moments")
        },
    }


def near(plain: Cube, looked: Cube) -> list[dict[str, float]]:
    """Return how much colours around the looks change under FL11, by their distance in 8-bit codes."""
    (screen,) = display_sensors(["FL11"], plain.observer)
    rng, centres = (
        np.random.default_rng(0),
        plain.encode(looked.data.atlas.rgb[looked.data.atlas.measured_count :]),
    )
    found = []
    for distance in (0, 4, 8, 16, 32, 64):
        steps = rng.normal(size=(200, 1, 3))
        codes = centres + distance * steps / np.linalg.norm(steps, axis=-1, keepdims=True)
        rgb = plain.decode(codes[((codes >= 0) & (codes <= 255)).all(axis=-1)])
        one, other = (screen.rgb(cube.reflectance(rgb)) for cube in (plain, looked))
        found.append({"codes": distance, "delta_e": delta_e_rgb(screen, one, other).mean()})
    return found


def realisable(names: Sequence[str]) -> dict[str, Any]:
    """Return how well looks that state the colours of measured materials are met."""
    lights, cube = [light(name) for name in names], uplift.load()
    here = cube.data.sensor
    measured = np.concatenate([on_grid(read_atlas(each.path), here.wavelengths) for each in shipped_atlases()])
    measured = measured[here.contains(here.rgb(measured))]
    measured = measured[np.random.default_rng(0).choice(len(measured), MATERIALS, replace=False)]
    expected = cube.reflectance(np.clip(here.rgb(measured), 0, 1))
    goals = [LookGoal(here.rgb(each), tuple(lights), np.stack([one.xyz @ each for one in lights])) for each in measured]
    designs, seconds = timed(
        lambda: np.array([design_reflectance(here, *each) for each in zip(goals, expected, strict=True)])
    )
    errors = {}
    for count in COUNTS:
        model = Moments(count, cube.data.model.phase)
        fitted = fit_designs(Problem(here, model, error_light=lights[0]), goals, designs)
        answers = np.asarray(model.squash(fitted.multipliers @ model.basis(here.wavelengths).T))
        worst = [goal.delta_e(answer).max() for goal, answer in zip(goals, answers, strict=True)]
        errors[str(count)] = {
            "median": np.median(worst),
            "max": np.max(worst),
            "met": float(np.mean(np.array(worst) <= MET)),
        }
    return {
        "lights": ", ".join(names),
        "design_ms": 1e3 * seconds / MATERIALS,
        "designs": max(goal.delta_e(each).max() for goal, each in zip(goals, designs, strict=True)),
        "coefficients": errors,
    }


def impossible() -> list[dict[str, Any]]:
    """Return impossible wishes with the nearest colours."""
    found = []
    for rgb, name, wish in IMPOSSIBLE:
        cube = uplift.build(dim=2, looks=uplift.Look(rgb, {name: wish}))
        (record,) = cube.data.provenance["looks"][0]["lights"]
        answer = hex_codes(np.array([record["answer"]]))[0]
        found.append({**record, "colour": rgb, "wish": wish, "answer": answer})
    return found


def masked(plain: Cube, looked: Cube) -> dict[str, Any]:
    """Return the errors of mixed pixels, and the time of a masked texture relative to that of one cube."""
    rng = np.random.default_rng(0)
    rgb, ramp = rng.random((SIDE, SIDE, 3), dtype=np.float32), np.tile(np.linspace(0, 1, SIDE), (SIDE, 1))
    hard, window = (ramp > 0.5).astype(np.float32), Window(0, 0, SIDE, SIDE, (0, 0, SIDE, SIDE), 1.0)
    pixels = texture.Spectrum(tuple(plain.data.sensor.wavelengths[::4]))
    with tempfile.TemporaryDirectory() as name:
        folder, times = Path(name), {}
        for mask in ("soft", "hard"):
            write_exr(folder / f"{mask}.exr", window, ("Y",), {"soft": ramp, "hard": hard}[mask][..., None])
        write_exr(folder / "image.exr", window, ("R", "G", "B"), rgb)
        uplifters = [texture.prepare(cube, pixels, depth="float") for cube in (plain, looked)]
        converters: dict[str, Any] = {"one": uplifters[0]} | {
            mask: texture.prepare_masked(uplifters, folder / f"{mask}.exr") for mask in ("hard", "soft")
        }
        for turn in range(ROUNDS + 1):
            for kind, converter in converters.items():
                done = texture.convert(converter, folder / "image.exr", folder / f"{kind}-out.exr", force=True)
                times.setdefault(kind, []).append(done.seconds if turn else np.inf)
    every = [texture.prepare(cube, depth="float") for cube in (plain, looked)]
    block, weights = rgb[:64], ramp[:64, :, None].astype(np.float32)
    (_, one), _ = every[0].convert(block)
    (_, two), _ = every[1].convert(block)
    mixed = (1 - weights) * one + weights * two
    return {
        "side": SIDE,
        "channels": len(uplifters[0].channels),
        "rgb_error": np.abs(plain.data.sensor.rgb(mixed.astype(float)) - block).max(),
        "range": [mixed.min(), mixed.max()],
        "relative_time": {kind: min(times[kind]) / min(times["one"]) for kind in ("hard", "soft")},
    }


def write_exr(path: Path, window: Window, names: tuple[str, ...], values: Array) -> None:
    """Write floats (height, width, channels)."""
    part = OutputPart("", window, names, ("float",) * len(names), {}, "2026:01:01 00:00:00")
    with open_writer(path, [part]) as writer:
        writer.write_rows(0, values.astype(np.float32))


def render(plain: Cube, looked: Cube) -> dict[str, Any]:
    """Render two balls of one RGB, of two cubes, under daylight and under a sodium lamp, and draw them."""
    import mitsuba

    scene.start()
    record = looked.data.provenance["looks"][0]
    images, found = {}, {}
    with tempfile.TemporaryDirectory() as name:
        paths = [Path(name, f"{stem}.uplift") for stem in ("plain", "looks")]
        for cube, path in zip((plain, looked), paths, strict=True):
            cube.save(path)
        for lamp in ("D65", record["lights"][0]["light"]):
            image = balls(mitsuba, [str(path) for path in paths], record["rgb"], lamp)
            here = sensor(illuminant=lamp)
            images[lamp] = image @ here.xyz_to_rgb.T
            middle, third = PIXELS // 2, PIXELS // 2
            patches = [
                images[lamp][middle - 12 : middle + 12, x - 12 : x + 12].mean(axis=(0, 1))
                for x in (third, PIXELS + third)
            ]
            found[lamp] = {
                "codes": hex_codes(np.array(patches)),
                "delta_e": delta_e_rgb(here, *patches),
            }
    figure = new_figure(4.5, 4.3)
    for axes, (lamp, image) in zip(figure.subplots(2, 1), images.items(), strict=True):
        axes.imshow(to_display_codes(image, SRGB).astype(np.uint8), interpolation="nearest")
        axes.set(xticks=(), yticks=())
        axes.spines[:].set_visible(False)
        axes.set_ylabel(figure_text(lamp), fontsize=11)
    PICTURE.parent.mkdir(exist_ok=True)
    write_png(figure, PICTURE, force=True)
    return {"mitsuba": mitsuba.__version__, "look": record["name"], "lights": found}


def balls(mi: Any, cubes: Sequence[str], rgb: Sequence[float], lamp: str) -> Array:
    """Return XYZ (height, width, 3) of two balls on the ground, left and right, each of its cube."""
    transform = mi.ScalarTransform4f
    view = transform().look_at(origin=[0, 1.2, 12], target=[0, 0.55, 0], up=[0, 1, 0])

    def ball(cube: str, x: float) -> dict[str, Any]:
        reflectance = {"type": "uplift", "cube": cube, "rgb": list(rgb)}
        return {
            "type": "sphere",
            "center": [x, 1, 0],
            "radius": 1.0,
            "bsdf": {"type": "diffuse", "reflectance": reflectance},
        }

    loaded = mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 4},
            "sky": {"type": "constant", "radiance": scene.light_spectrum(lamp)},
            "ground": {
                "type": "rectangle",
                "to_world": transform().rotate([1, 0, 0], -90).scale([30, 30, 1]),
                "bsdf": {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.5}},
            },
            "left": ball(cubes[0], -1.35),
            "right": ball(cubes[1], 1.35),
            "camera": {
                "type": "perspective",
                "fov": 28,
                "fov_axis": "x",
                "to_world": view,
                "film": {
                    "type": "hdrfilm",
                    "width": 2 * PIXELS,
                    "height": PIXELS,
                    "pixel_format": "xyz",
                    "component_format": "float32",
                },
            },
        }
    )
    return np.array(mi.render(loaded, spp=SPP, seed=0), dtype=float)


if __name__ == "__main__":
    main()
